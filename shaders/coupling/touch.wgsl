// Grains onto the lattice: cells, lists of the grains of each, in the order of identities. Twin of
// `Touch` in coupling/src/exchange.rs and of `weigh` in coupling/src/water/weigh.rs.
//
// clear       a cell each     no grains yet
// touch_down  a grain each    its cell, its place there, and what it counts
// place_in    a grain each    into the list of its cell, in any order (after a scan of the counts)
// rank        a grain each    to its slot
// loosen      a grain each    drag of loose grains (after bed.wgsl)

#import dem::wide::{Wide, add, opposite, PART}
#import dem::fixed::Place
#import dem::scene::{scene, Motion, Own}
#import dem::control::control
#import dem::search::plan::grid
#import coupling::numbers::{numbers, course, span, renews, thread, cell_at, cell_volume, ball, KEPT}
#import coupling::resistance::resistance

@group(0) @binding(0) var<storage, read> places: array<Place>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
@group(0) @binding(2) var<storage, read> owns: array<Own>;
@group(0) @binding(3) var<storage, read> mean_loads: array<f32>;
@group(0) @binding(4) var<storage, read_write> kept: array<vec4<u32>>;
// Grains of each cell, then the first slot of each.
@group(0) @binding(5) var<storage, read_write> starts: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> filled: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> members: array<u32>;
@group(0) @binding(8) var<storage, read_write> slots: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> slot_rows: array<u32>;
@group(0) @binding(10) var<storage, read_write> slot_ids: array<u32>;
@group(0) @binding(11) var<storage, read_write> slot_drags: array<vec2<f32>>;
// Of a cell: volume of solid, permeability, 1/(β V_p), porosity.
@group(0) @binding(12) var<storage, read> bed: array<vec4<f32>>;

// The least weight: among grains that carry nothing each counts the same.
const LEAST: f32 = 1e-6;

// A cell along an axis, and how far into it.
struct Located {
    cell: u32,
    within: f32,
}

// Edge `k` of `count` cells over `length` units, rounded down.
fn edge(k: u32, length: u32, count: u32) -> i32 {
    return i32(k * (length / count) + k * (length % count) / count);
}

// Exact but for the rounding of `within`.
fn locate(x: Wide, length: u32, count: u32) -> Located {
    let about = f32(x.hi) / (f32(length) / f32(count));
    var k = u32(clamp(about, 0.0, f32(count - 1u)));
    while k > 0u && x.hi < edge(k, length, count) {
        k--;
    }
    while k + 1u < count && x.hi >= edge(k + 1u, length, count) {
        k++;
    }
    let missing = f32(k * (length % count) % count) / f32(count);
    let way = f32(x.hi - edge(k, length, count)) + (f32(x.lo) * PART - missing);
    return Located(k, clamp(way / (f32(length) / f32(count)), 0.0, 1.0));
}

// Weight of a grain with this load and buoyant weight [N].
fn weight(load: f32, buoyant: f32) -> f32 {
    let all = load + buoyant;
    let half = span[0].half;
    if all + half > 0.0 {
        return max(all / (all + half), LEAST);
    }
    return 1.0;
}

@compute @workgroup_size(64)
fn clear(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if cell == 0u {
        // Where nothing is renewed, the scan that follows has one number, which is zero.
        grid.total = select(0u, numbers.count, renews());
    }
    if renews() && cell <= numbers.count {
        atomicStore(&starts[cell], 0u);
        atomicStore(&filled[cell], 0u);
    }
}

@compute @workgroup_size(64)
fn touch_down(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if !renews() || g >= numbers.grains {
        return;
    }
    let row = (control.base & 1u) * numbers.grains + g;
    let place = places[row];
    let x = locate(Wide(place.hi.x, place.lo.x), numbers.lengths.x, numbers.cells.x);
    let y = locate(Wide(place.hi.y, place.lo.y), numbers.lengths.y, numbers.cells.y);
    let up = add(Wide(place.hi.z, place.lo.z), opposite(span[0].bottom));
    let z = locate(up, u32(span[0].bed), numbers.cells.z);
    let cell = cell_at(vec3<u32>(x.cell, y.cell, z.cell));
    let me = motions[row];
    let volume = ball(me.radius);
    let mass = scene.step / owns[g].kick;
    let buoyant = abs(mass - numbers.density * volume) * abs(numbers.gravity);
    let counts = weight(mean_loads[me.id], buoyant);
    let lift = -numbers.density * numbers.gravity * volume;
    kept[KEPT * g] = vec4<u32>(bitcast<vec3<u32>>(vec3<f32>(x.within, y.within, z.within)), cell);
    kept[KEPT * g + 1u] = bitcast<vec4<u32>>(vec4<f32>(counts * volume, 0.0, lift, 1.0 - counts));
    // In a renewal an exchange has just been made, but for the first one.
    kept[KEPT * g + 3u] = vec4<u32>(bitcast<vec3<u32>>(place.hi), 0u);
    kept[KEPT * g + 4u] = vec4<u32>(place.lo, 0u);
    atomicAdd(&starts[cell], 1u);
}

@compute @workgroup_size(64)
fn place_in(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if renews() && g < numbers.grains {
        let cell = kept[KEPT * g].w;
        members[atomicLoad(&starts[cell]) + atomicAdd(&filled[cell], 1u)] = g;
    }
}

@compute @workgroup_size(64)
fn rank(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if !renews() || g >= numbers.grains {
        return;
    }
    let half = (control.base & 1u) * numbers.grains;
    let id = motions[half + g].id;
    let touch = kept[KEPT * g];
    let first = atomicLoad(&starts[touch.w]);
    var slot = first;
    for (var k = first; k < atomicLoad(&starts[touch.w + 1u]); k++) {
        if motions[half + members[k]].id < id {
            slot++;
        }
    }
    let counts = bitcast<f32>(kept[KEPT * g + 1u].x);
    slots[slot] = vec4<f32>(bitcast<vec3<f32>>(touch.xyz), counts);
    slot_rows[slot] = g;
    slot_ids[slot] = id;
    kept[KEPT * g + 2u].w = slot;
}

@compute @workgroup_size(64)
fn loosen(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if !renews() || g >= numbers.grains {
        return;
    }
    let own = bitcast<vec4<f32>>(kept[KEPT * g + 1u]);
    let porosity = bed[kept[KEPT * g].w].w;
    let volume = ball(motions[(control.base & 1u) * numbers.grains + g].radius);
    // ν T of the grain times its mass, were it quite loose.
    let all = course[0].towed * f32(course[0].drag_every) * porosity * porosity * resistance(porosity, 0.0) * volume / (1.0 - porosity);
    let drag = own.w * all;
    let pace = all * owns[g].kick;
    kept[KEPT * g + 1u].y = bitcast<u32>(drag);
    slot_drags[kept[KEPT * g + 2u].w] = vec2<f32>(drag, drag * pace);
}
