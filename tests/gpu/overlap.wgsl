// One thread, one pair: its gap, seen from both grains.
#import dem::fixed::{Place, apart, closeness, gap}

struct Pair {
    i: Place,
    j: Place,
}

struct Seen {
    normal: vec3<f32>,
    overlap: f32,
    back: vec3<f32>,
    overlap_back: f32,
    distance: f32,
    closeness: f32,
    unused: vec2<f32>,
}

struct Box {
    length: vec3<i32>,
    unit: f32,
}

@group(0) @binding(0) var<storage, read> inputs: array<Pair>;
@group(0) @binding(1) var<storage, read_write> outputs: array<Seen>;
@group(0) @binding(2) var<uniform> extent: Box;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&inputs) {
        return;
    }
    let i = inputs[id.x].i;
    let j = inputs[id.x].j;
    let reach_hi = i.radius_hi + j.radius_hi;
    let reach_lo = i.radius_lo + j.radius_lo;
    let there = apart(i, j, extent.length);
    let near = closeness(there, reach_hi, reach_lo);
    let ours = gap(there, reach_hi, reach_lo, near, extent.unit);
    let back = apart(j, i, extent.length);
    let theirs = gap(back, reach_hi, reach_lo, closeness(back, reach_hi, reach_lo), extent.unit);
    outputs[id.x] = Seen(ours.normal, ours.overlap, theirs.normal, theirs.overlap, ours.distance, near, vec2<f32>(0.0));
}
