// From the grains of a cell to the faces around it. A workgroup takes a cell and walks the list of
// its grains, each thread for one of the faces that they reach: 18 of each normal, two along it and
// three along the others. No two workgroups write to the same place, and the list is in the order
// of identities: sums are the same bits in whatever order grains lie or threads come, without
// atomics, scales or overflows. Twin of `scatter` in coupling/src/exchange.rs.
//
// What is scattered is chosen when it is compiled:
//
//   (none)     w V          weights, in a renewal
//   DRAGS      γ            of loose grains
//   PACES      γ ν T
//   DEPOSIT    V            to the 27 cells around
//   MOVES      w V times the mean velocity since the last exchange, in one; the next way begins
//     DRAGS    and γ times that beside
//     LOOKS    for who reads: no way begins
//
// `faces.wgsl` adds up what the cells have left in `shares`.

#import dem::scene::Motion
#ifdef MOVES
#import dem::scene::scene
#import dem::fixed::{Place, displacement}
#import coupling::times::rate_until
#endif
#import coupling::numbers::{numbers, is_made, renews, ball, KEPT}
#import coupling::kernel::{of_cell, of_face, value}
#import dem::control::control

@group(0) @binding(0) var<uniform> tick: u32;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
// First slot of each cell.
@group(0) @binding(2) var<storage, read> starts: array<u32>;
// Of the grain in each slot: where it is in its cell, and w V [m^3].
@group(0) @binding(3) var<storage, read> slots: array<vec4<f32>>;
// Its row.
@group(0) @binding(4) var<storage, read> slot_rows: array<u32>;
// Its γ [N s/m], and γ ν T.
@group(0) @binding(5) var<storage, read> slot_drags: array<vec2<f32>>;
// 54 numbers a cell.
@group(0) @binding(6) var<storage, read_write> shares: array<f32>;
#ifdef MOVES
@group(0) @binding(7) var<storage, read> places: array<Place>;
@group(0) @binding(8) var<storage, read_write> kept: array<vec4<u32>>;

// Mean velocity of the grain of a row since the last exchange [m/s]. Each grain is in one list.
fn velocity_of(g: u32, step: u32) -> vec3<f32> {
    let velocity = found(g, step);
#ifndef LOOKS
    let place = places[(step & 1u) * numbers.grains + g];
    kept[KEPT * g + 3u] = vec4<u32>(bitcast<vec3<u32>>(place.hi), 0u);
    kept[KEPT * g + 4u] = vec4<u32>(place.lo, 0u);
    kept[KEPT * g + 5u] = vec4<u32>(bitcast<vec3<u32>>(velocity), 0u);
#endif
    return velocity;
}

fn found(g: u32, step: u32) -> vec3<f32> {
    let place = places[(step & 1u) * numbers.grains + g];
    let hi = bitcast<vec3<i32>>(kept[KEPT * g + 3u].xyz);
    let lo = kept[KEPT * g + 4u].xyz;
    let way = displacement(place.hi, place.lo, hi, lo, scene.length) * numbers.unit;
    return rate_until(step) * way;
}
#endif

const THREADS: u32 = 64u;
const FACES: u32 = 54u;

var<workgroup> range: vec2<u32>;
var<workgroup> within: array<vec3<f32>, 64>;
var<workgroup> amounts: array<vec3<f32>, 64>;

// Coefficients along x, y and z of what a thread weighs with, and which amount.
struct Node {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
    lane: u32,
}

// The face of normal n / 18: its place along the normal first, then along the other axes.
fn face(n: u32) -> Node {
    let lane = n / 18u;
    let along = of_face(n % 2u);
    let one = of_cell(n % 18u / 2u % 3u);
    let other = of_cell(n % 18u / 6u);
    if lane == 0u {
        return Node(along, one, other, 0u);
    }
    if lane == 1u {
        return Node(one, along, other, 1u);
    }
    return Node(one, other, along, 2u);
}

fn cell(n: u32) -> Node {
    return Node(of_cell(n % 3u), of_cell(n / 3u % 3u), of_cell(n / 9u), 0u);
}

#ifdef MOVES
#ifdef DRAGS
@group(0) @binding(9) var<storage, read_write> drag_shares: array<f32>;
var<workgroup> drags: array<vec3<f32>, 64>;
#endif
#else
// What the grain in `slot` is counted with.
fn amount(slot: u32) -> vec3<f32> {
#ifdef DEPOSIT
    let row = (control.base & 1u) * numbers.grains + slot_rows[slot];
    return vec3<f32>(ball(motions[row].radius));
#else
#ifdef PACES
    let weight = slot_drags[slot].y;
#else
#ifdef DRAGS
    let weight = slot_drags[slot].x;
#else
    let weight = slots[slot].w;
#endif
#endif
    return vec3<f32>(weight);
#endif
}
#endif

@compute @workgroup_size(64)
fn scatter(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let own = group.x + group.y * groups.x;
#ifdef MOVES
    let going = is_made(tick);
#else
    let going = renews();
#endif
    if local == 0u {
        range = vec2<u32>(0u);
        if going && own < numbers.count {
            range = vec2<u32>(starts[own], starts[own + 1u]);
        }
    }
    let slice = workgroupUniformLoad(&range);
#ifdef DEPOSIT
    let nodes = 27u;
    let node = cell(min(local, nodes - 1u));
#else
    let nodes = FACES;
    let node = face(min(local, nodes - 1u));
#endif
    var sum = 0.0;
    var drag = 0.0;
    for (var first = slice.x; first < slice.y; first += THREADS) {
        let slot = first + local;
        if slot < slice.y {
            within[local] = slots[slot].xyz;
#ifdef MOVES
            let velocity = velocity_of(slot_rows[slot], control.base + tick);
            amounts[local] = slots[slot].w * velocity;
#ifdef DRAGS
            drags[local] = slot_drags[slot].x * velocity;
#endif
#else
            amounts[local] = amount(slot);
#endif
        }
        workgroupBarrier();
        for (var k = 0u; k < min(THREADS, slice.y - first); k++) {
            let t = within[k];
            let weight = value(node.x, t.x) * value(node.y, t.y) * value(node.z, t.z);
            sum += weight * amounts[k][node.lane];
#ifdef MOVES
#ifdef DRAGS
            drag += weight * drags[k][node.lane];
#endif
#endif
        }
        workgroupBarrier();
    }
    if going && local < nodes && own < numbers.count {
        shares[FACES * own + local] = sum;
#ifdef MOVES
#ifdef DRAGS
        drag_shares[FACES * own + local] = drag;
#endif
#endif
    }
}
