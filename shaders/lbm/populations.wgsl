// The populations in place (Esoteric-Pull). Twin of lbm/src/populations.rs, which says what lies
// where, and of lbm/src/gpu/bindings.rs.

#define_import_path lbm::populations
#import lbm::lattice::{Cell, Pairs}
#import lbm::setting::setting

// One number for each place, population by population: the two slots of each pair, and what
// rests. A binding holds EACH populations: all, an even number of them, or one; there are 1, 2, 3,
// 4, 5, 10 or 19 bindings.
const EACH: u32 = #{EACH}u;
const REST: u32 = 18u;

@group(0) @binding(0) var<storage, read_write> part_a: array<f32>;
#if PARTS > 1
@group(0) @binding(1) var<storage, read_write> part_b: array<f32>;
#endif
#if PARTS > 2
@group(0) @binding(2) var<storage, read_write> part_c: array<f32>;
#endif
#if PARTS > 3
@group(0) @binding(3) var<storage, read_write> part_d: array<f32>;
#endif
#if PARTS > 4
@group(0) @binding(4) var<storage, read_write> part_e: array<f32>;
#endif
#if PARTS > 5
@group(0) @binding(5) var<storage, read_write> part_f: array<f32>;
@group(0) @binding(6) var<storage, read_write> part_g: array<f32>;
@group(0) @binding(7) var<storage, read_write> part_h: array<f32>;
@group(0) @binding(8) var<storage, read_write> part_i: array<f32>;
@group(0) @binding(9) var<storage, read_write> part_j: array<f32>;
#endif
#if PARTS > 10
@group(0) @binding(10) var<storage, read_write> part_k: array<f32>;
@group(0) @binding(11) var<storage, read_write> part_l: array<f32>;
@group(0) @binding(12) var<storage, read_write> part_m: array<f32>;
@group(0) @binding(13) var<storage, read_write> part_n: array<f32>;
@group(0) @binding(14) var<storage, read_write> part_o: array<f32>;
@group(0) @binding(15) var<storage, read_write> part_p: array<f32>;
@group(0) @binding(16) var<storage, read_write> part_q: array<f32>;
@group(0) @binding(17) var<storage, read_write> part_r: array<f32>;
@group(0) @binding(18) var<storage, read_write> part_s: array<f32>;
#endif

fn fetch(part: u32, at: u32) -> f32 {
    switch part {
#if PARTS > 1
        case 1u: { return part_b[at]; }
#endif
#if PARTS > 2
        case 2u: { return part_c[at]; }
#endif
#if PARTS > 3
        case 3u: { return part_d[at]; }
#endif
#if PARTS > 4
        case 4u: { return part_e[at]; }
#endif
#if PARTS > 5
        case 5u: { return part_f[at]; }
        case 6u: { return part_g[at]; }
        case 7u: { return part_h[at]; }
        case 8u: { return part_i[at]; }
        case 9u: { return part_j[at]; }
#endif
#if PARTS > 10
        case 10u: { return part_k[at]; }
        case 11u: { return part_l[at]; }
        case 12u: { return part_m[at]; }
        case 13u: { return part_n[at]; }
        case 14u: { return part_o[at]; }
        case 15u: { return part_p[at]; }
        case 16u: { return part_q[at]; }
        case 17u: { return part_r[at]; }
        case 18u: { return part_s[at]; }
#endif
        default: { return part_a[at]; }
    }
}

fn store(part: u32, at: u32, f: f32) {
    switch part {
#if PARTS > 1
        case 1u: { part_b[at] = f; }
#endif
#if PARTS > 2
        case 2u: { part_c[at] = f; }
#endif
#if PARTS > 3
        case 3u: { part_d[at] = f; }
#endif
#if PARTS > 4
        case 4u: { part_e[at] = f; }
#endif
#if PARTS > 5
        case 5u: { part_f[at] = f; }
        case 6u: { part_g[at] = f; }
        case 7u: { part_h[at] = f; }
        case 8u: { part_i[at] = f; }
        case 9u: { part_j[at] = f; }
#endif
#if PARTS > 10
        case 10u: { part_k[at] = f; }
        case 11u: { part_l[at] = f; }
        case 12u: { part_m[at] = f; }
        case 13u: { part_n[at] = f; }
        case 14u: { part_o[at] = f; }
        case 15u: { part_p[at] = f; }
        case 16u: { part_q[at] = f; }
        case 17u: { part_r[at] = f; }
        case 18u: { part_s[at] = f; }
#endif
        default: { part_a[at] = f; }
    }
}

fn fetch_rest(place: u32) -> f32 {
    return fetch(REST / EACH, (REST % EACH) * setting.step + place);
}

// Slot `which` (0 or 1) of `pair` at `place`.
fn fetch_one(pair: u32, which: u32, place: u32) -> f32 {
#if EACH == 1
    // The binding of each is known when this is compiled.
    if which == 0u {
        return fetch(2u * pair, place);
    }
    return fetch(2u * pair + 1u, place);
#else
    return fetch(2u * pair / EACH, (2u * pair % EACH + which) * setting.step + place);
#endif
}

fn store_one(pair: u32, which: u32, place: u32, f: f32) {
#if EACH == 1
    if which == 0u {
        store(2u * pair, place, f);
    } else {
        store(2u * pair + 1u, place, f);
    }
#else
    store(2u * pair / EACH, (2u * pair % EACH + which) * setting.step + place, f);
#endif
}

// Three pairs from `pair` on.
fn fetch_three(pair: u32, which: vec3<u32>, place: vec3<u32>) -> vec3<f32> {
    return vec3<f32>(
        fetch_one(pair, which.x, place.x),
        fetch_one(pair + 1u, which.y, place.y),
        fetch_one(pair + 2u, which.z, place.z),
    );
}

fn store_three(pair: u32, which: u32, place: vec3<u32>, f: vec3<f32>) {
    store_one(pair, which, place.x, f.x);
    store_one(pair + 1u, which, place.y, f.y);
    store_one(pair + 2u, which, place.z, f.z);
}

// The place of a cell, and those of its neighbours along the forward directions.
struct Places {
    own: u32,
    axis: vec3<u32>,
    plus: vec3<u32>,
    minus: vec3<u32>,
}

// The place of the first cell of a row.
fn row(y: u32, z: u32) -> u32 {
    return (z * setting.extent.y + y) * setting.stride;
}

// One further along each axis, and one back, around the end of the lattice if there.
fn further(at: vec3<u32>) -> vec3<u32> {
    return select(at + 1u, vec3<u32>(0u), at + 1u == setting.extent);
}

fn back(at: vec3<u32>) -> vec3<u32> {
    return select(at, setting.extent, at == vec3<u32>(0u)) - 1u;
}

fn places(at: vec3<u32>) -> Places {
    let up = further(at);
    let down = back(at);
    let here = row(at.y, at.z);
    let y_up = row(up.y, at.z);
    let z_up = row(at.y, up.z);
    return Places(
        here + at.x,
        vec3<u32>(here + up.x, y_up + at.x, z_up + at.x),
        vec3<u32>(y_up + up.x, z_up + up.x, row(up.y, up.z) + at.x),
        vec3<u32>(row(down.y, at.z) + up.x, row(at.y, down.z) + up.x, row(up.y, down.z) + at.x),
    );
}

// Bits `first` to `first + 2`.
fn bits(mask: u32, first: u32) -> vec3<u32> {
    return (vec3<u32>(mask) >> vec3<u32>(first, first + 1u, first + 2u)) & vec3<u32>(1u);
}

// What arrived at a cell before a step. Links that `closed` names (a bit for each forward
// direction, nine bits on for the backward ones) have a wall half-way: what comes back along
// them is what was emitted, which lies in the other slot.
fn arrived(at: Places, odd: u32, closed: u32) -> Cell {
    let first = vec3<u32>(odd);
    let second = 1u - first;
    let own = vec3<u32>(at.own);
    return Cell(
        fetch_rest(at.own),
        Pairs(
            fetch_three(0u, first ^ bits(closed, 9u), own),
            fetch_three(3u, first ^ bits(closed, 12u), own),
            fetch_three(6u, first ^ bits(closed, 15u), own),
        ),
        Pairs(
            fetch_three(0u, second ^ bits(closed, 0u), at.axis),
            fetch_three(3u, second ^ bits(closed, 3u), at.plus),
            fetch_three(6u, second ^ bits(closed, 6u), at.minus),
        ),
    );
}

// Leave what a cell emits in a step, in the slots in which it found what arrived.
fn leave(at: Places, odd: u32, cell: Cell) {
    store(REST / EACH, (REST % EACH) * setting.step + at.own, cell.rest);
    let own = vec3<u32>(at.own);
    store_three(0u, odd, own, cell.backward.axis);
    store_three(3u, odd, own, cell.backward.plus);
    store_three(6u, odd, own, cell.backward.minus);
    store_three(0u, 1u - odd, at.axis, cell.forward.axis);
    store_three(3u, 1u - odd, at.plus, cell.forward.plus);
    store_three(6u, 1u - odd, at.minus, cell.forward.minus);
}
