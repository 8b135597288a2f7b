// Cells and faces at a renewal. One thread a cell. Twin of coupling/src/water/weigh.rs.
//
// add_up    sums before the filter (wide kernel)
// pores     volume of solid, porosity, permeability, storage, and their extremes
// lay_bed   storage and drag of the lattice
// freeze    what faces weigh
// freeze_drags   Σ γ K of loose grains
// soften    by how much their drag is less than it would be in every step

#import dem::control::control
#ifdef CAVITATION
#import dem::wide::{widen, carry}
#endif
#import coupling::numbers::{numbers, course, span, renews, thread, at_cell, cell_volume}
#import coupling::sums::{at_faces, at_cells}
#import coupling::total::total
#import coupling::resistance::resistance
#ifdef WIDE
#import coupling::smooth::{smoothed, smoothed_cell}
#endif
#import lbm::setting::setting

@group(0) @binding(0) var<storage, read> contents: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> bed: array<vec4<f32>>;
// Bits of least and greatest porosity, permeability and mobility; too little water in a cell;
// vapour in all cells, two words.
@group(0) @binding(2) var<storage, read_write> extremes: array<atomic<u32>>;
// Of the lattice, by place.
@group(0) @binding(3) var<storage, read_write> inverse_storage: array<f32>;
@group(0) @binding(4) var<storage, read_write> half_drag: array<f32>;
@group(0) @binding(5) var<storage, read_write> inverse: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> ease: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> held: array<vec4<f32>>;
#ifdef CAVITATION
@group(0) @binding(10) var<storage, read> vapour: array<f32>;
#endif
#ifdef WIDE
@group(0) @binding(8) var<storage, read_write> rough_sums: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> wall_shares: array<vec2<f32>>;
#endif

#ifdef WIDE
@compute @workgroup_size(64)
fn add_up(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if renews() && cell < numbers.count {
        rough_sums[cell] = at_faces(at_cell(cell));
    }
}

@compute @workgroup_size(64)
fn add_up_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if renews() && cell < numbers.count {
        rough_sums[cell] = vec4<f32>(at_cells(at_cell(cell)), 0.0, 0.0, 0.0);
    }
}
#endif

@compute @workgroup_size(64)
fn pores(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if !renews() || cell >= numbers.count {
        return;
    }
#ifdef WIDE
    let solid = smoothed_cell(at_cell(cell));
#else
    let solid = at_cells(at_cell(cell));
#endif
    let volume = cell_volume();
    let porosity = 1.0 - solid / volume;
    if !(porosity > 0.02) {
        atomicOr(&extremes[6], 1u);
        return;
    }
    // Lattice fluxes are those through whole faces.
    let stretch = course[0].stretch;
    let q = contents[cell].xyz * course[0].speed * vec3<f32>(1.0 / stretch, 1.0 / stretch, 1.0);
    let permeability = numbers.viscosity / resistance(porosity, length(q));
    bed[cell] = vec4<f32>(solid, permeability, 1.0 / (numbers.compressibility * (volume - solid)), porosity);
#ifdef CAVITATION
    // In cells; whole numbers add up in any order.
    let open = widen(vapour[cell] / volume);
    let before = atomicAdd(&extremes[8], open.lo);
    atomicAdd(&extremes[7], bitcast<u32>(open.hi) + carry(before, open.lo));
#endif
    // Positive numbers are in the order of their bits.
    let found = vec3<f32>(porosity, permeability, permeability / porosity);
    for (var k = 0u; k < 3u; k++) {
        atomicMin(&extremes[2u * k], bitcast<u32>(found[k]));
        atomicMax(&extremes[2u * k + 1u], bitcast<u32>(found[k]));
    }
}

@compute @workgroup_size(64)
fn lay_bed(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if !renews() || cell >= numbers.count {
        return;
    }
    let at = at_cell(cell);
    let place = (at.z * setting.extent.y + at.y) * setting.stride + at.x;
    inverse_storage[place] = 1.0 / (bed[cell].w * course[0].storage_unit);
    half_drag[place] = course[0].drag_unit / bed[cell].y;
}

@compute @workgroup_size(64)
fn freeze(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if !renews() || cell >= numbers.count {
        return;
    }
    let at = at_cell(cell);
#ifdef WIDE
    let sums = smoothed(at, 2.0);
    let weight = sums.faces;
#else
    let weight = at_faces(at).xyz;
#endif
    let one = select(vec3<f32>(0.0), 1.0 / weight, weight > vec3<f32>(0.0));
    inverse[cell] = vec4<f32>(one, 0.0);
#ifdef WIDE
    wall_shares[cell] = sums.walls * one.z;
#endif
}

@compute @workgroup_size(64)
fn freeze_drags(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if renews() && cell < numbers.count {
        held[cell] = vec4<f32>(total(at_cell(cell)), 0.0);
    }
}

@compute @workgroup_size(64)
fn soften(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if !renews() || cell >= numbers.count {
        return;
    }
    let at = at_cell(cell);
    let fast = total(at);
    let drag = held[cell].xyz;
    var eased = vec3<f32>(0.0);
    for (var k = 0u; k < 3u; k++) {
        let one = inverse[cell][k];
        if drag[k] > 0.0 && one > 0.0 {
            // Of the velocity between loose grains and the others r would go at the pace that it
            // has now.
            let r = fast[k] / drag[k] + drag[k] * numbers.step * one / numbers.solid_density;
            eased[k] = 1.0 / max(1.0 + 0.5 * r, r);
        }
    }
    if at.z == 0u {
        eased.z = 0.0;
    }
    ease[cell] = vec4<f32>(eased, 0.0);
    held[cell] = vec4<f32>(eased * drag, 0.0);
}
