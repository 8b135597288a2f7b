// The water follows a motion in an exchange: mean velocities of the faces since the last one, and the
// volume that they have brought. One thread a cell, for its lower faces. Twin of `follow` and
// `collect` in coupling/src/faces.rs and cells.rs.
//
// add_up             (wide kernel) sums before the filter
// means              v_f = Σ a_if v_i
// react              what loose grains get from the others and these have to give back
// collect            ∫Q dt of the cells, before a step of the lattice
// collect_and_feel   the same, where there is none, and the pressure that follows
// feel_drained       that after a step of the lattice
// feel_renewed       that of cells which have changed
// look               for who reads: ∫Q dt until now, and the pressure

#import coupling::numbers::{numbers, course, span, step_of, is_made, thread, at_cell, cell_at, next}
#import coupling::total::total
#import coupling::sums::at_faces
#import coupling::walls::{move_walls, wall_velocities}
#import coupling::times::{passed_until, rate_until}
#import coupling::pressure::collected
#import coupling::trend::{feel, feel_anew, felt}

@group(0) @binding(0) var<uniform> tick: u32;
// 1/Σ w V K; zero where there is no grain.
@group(0) @binding(1) var<storage, read> inverse: array<vec4<f32>>;
// Mean velocities [m/s].
@group(0) @binding(2) var<storage, read_write> velocities: array<vec4<f32>>;
// For who reads: ∫Q dt since the last step of the lattice [m^3], and pressure [Pa].
@group(0) @binding(3) var<storage, read_write> looks: array<vec2<f32>>;
// s_f and s_f Σ γ K of loose grains, and what faces give [N].
@group(0) @binding(4) var<storage, read> ease: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> held: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> reactions: array<vec4<f32>>;
#ifdef WIDE
// Sums before the filter.
@group(0) @binding(7) var<storage, read_write> rough_sums: array<vec4<f32>>;
// Shares of the bottom and the top in faces across.
@group(0) @binding(8) var<storage, read> wall_shares: array<vec2<f32>>;

@compute @workgroup_size(64)
fn add_up(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if is_made(tick) && cell < numbers.count {
        rough_sums[cell] = at_faces(at_cell(cell));
    }
}
#endif

@compute @workgroup_size(64)
fn means(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let going = is_made(tick);
    if going {
        move_walls(local, step_of(tick));
    }
    workgroupBarrier();
    let cell = thread(group, groups, local);
    if !going || cell >= numbers.count {
        return;
    }
    let at = at_cell(cell);
    var v = total(at) * inverse[cell].xyz;
    let walls = wall_velocities(rate_until(step_of(tick)));
#ifdef WIDE
    v.z += dot(wall_shares[cell], walls);
#endif
    if at.z == 0u {
        v.z = walls.x;
    }
    velocities[cell] = vec4<f32>(v, 0.0);
}

@compute @workgroup_size(64)
fn react(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if is_made(tick) && cell < numbers.count {
        let given = ease[cell].xyz * total(at_cell(cell));
        reactions[cell] = vec4<f32>(course[0].share * (given - held[cell].xyz * velocities[cell].xyz), 0.0);
    }
}

// Volume that faces have brought to a cell since the last exchange [m^3].
fn brought(cell: u32) -> f32 {
    let step = step_of(tick);
    let at = at_cell(cell);
    let v = velocities[cell].xyz;
    let behind = velocities[cell_at(vec3<u32>(next(at.x, numbers.cells.x), at.yz))].x;
    let beside = velocities[cell_at(vec3<u32>(at.x, next(at.y, numbers.cells.y), at.z))].y;
    var above = wall_velocities(rate_until(step)).y;
    if at.z + 1u < numbers.cells.z {
        above = velocities[cell_at(at + vec3<u32>(0u, 0u, 1u))].z;
    }
    let side = numbers.spacing * span[0].height;
    let floor = numbers.spacing * numbers.spacing;
    let flux = side * ((behind - v.x) + (beside - v.y)) + floor * (above - v.z);
    return passed_until(step).x * flux;
}

@compute @workgroup_size(64)
fn collect(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let going = is_made(tick);
    if going {
        move_walls(local, step_of(tick));
    }
    workgroupBarrier();
    let cell = thread(group, groups, local);
    if going && cell < numbers.count {
        collected[cell] += brought(cell);
    }
}

@compute @workgroup_size(64)
fn collect_and_feel(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let going = is_made(tick);
    if going {
        move_walls(local, step_of(tick));
    }
    workgroupBarrier();
    let cell = thread(group, groups, local);
    if going && cell < numbers.count {
        collected[cell] += brought(cell);
        feel(cell, step_of(tick));
    }
}

@compute @workgroup_size(64)
fn feel_drained(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if is_made(tick) && cell < numbers.count {
        feel(cell, step_of(tick));
    }
}

@compute @workgroup_size(64)
fn feel_renewed(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if is_made(tick) && cell < numbers.count {
        feel_anew(cell);
    }
}

@compute @workgroup_size(64)
fn look(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let going = is_made(tick);
    if going {
        move_walls(local, step_of(tick));
    }
    workgroupBarrier();
    let cell = thread(group, groups, local);
    if going && cell < numbers.count {
        looks[cell] = vec2<f32>(collected[cell] + brought(cell), felt(cell, step_of(tick)));
    }
}
