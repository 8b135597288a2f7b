// One thread, one grain: many drifts by ways that the test can repeat.
#import dem::fixed::drift

struct Start {
    hi: vec3<i32>,
    seed: u32,
    lo: vec3<u32>,
    scale: f32, // a power of two
}

struct End {
    hi: vec3<i32>,
    unused: u32,
    lo: vec3<u32>,
    seed: u32,
    image: vec3<i32>,
    scale: f32,
}

struct Plan {
    length: vec3<i32>,
    steps: u32,
}

@group(0) @binding(0) var<storage, read> inputs: array<Start>;
@group(0) @binding(1) var<storage, read_write> outputs: array<End>;
@group(0) @binding(2) var<uniform> plan: Plan;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&inputs) {
        return;
    }
    let start = inputs[id.x];
    var hi = start.hi;
    var lo = start.lo;
    var seed = start.seed;
    var image = vec3<i32>(0);
    for (var k = 0u; k < plan.steps; k++) {
        var way: vec3<f32>;
        for (var axis = 0; axis < 3; axis++) {
            seed = seed * 1664525u + 1013904223u;
            // Below 2^24, so that the number is exact in f32; more often forward.
            way[axis] = f32((bitcast<i32>(seed) >> 8u) + (1 << 22u)) * start.scale;
        }
        let moved = drift(hi, lo, way, plan.length);
        hi = moved.hi;
        lo = moved.lo;
        image += moved.image;
    }
    outputs[id.x] = End(hi, 0u, lo, seed, image, start.scale);
}
