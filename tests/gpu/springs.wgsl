// One thread, one contact: the tangential spring over many steps of a small to-and-fro slip.
#import dem::contact::types::{Law, Touch, no_turn, no_memory}
#import dem::contact::law::respond

struct Plan {
    steps: u32,
    begin: u32,     // number of the first step
    period: u32,    // steps of one half of the to and fro
    step: f32,
}

struct Contact {
    normal: vec3<f32>,
    slip: f32,      // m/s, along `across`
    across: vec3<f32>,
    overlap: f32,
    spring: vec3<f32>,
    unused: f32,
}

@group(0) @binding(0) var<storage, read> inputs: array<Contact>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
@group(0) @binding(2) var<uniform> constants: Law;
@group(0) @binding(3) var<uniform> plan: Plan;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&inputs) {
        return;
    }
    let c = inputs[id.x];
    var memory = no_memory();
    memory.spring = c.spring;
    for (var k = plan.begin; k < plan.begin + plan.steps; k++) {
        let forth = (k / plan.period) % 2u == 0u;
        let slip = c.across * select(-c.slip, c.slip, forth);
        let touch = Touch(c.normal, c.overlap, slip, 0.0);
        memory = respond(constants, touch, no_turn(), memory, plan.step).memory;
    }
    outputs[id.x] = vec4<f32>(memory.spring, f32(memory.sliding));
}
