// One thread, one contact: the answer of the scene's law, and of the smooth wall's.
#import dem::contact::types::{Law, Touch, Turn, Memory, energies}
#import dem::contact::law as chosen
#import dem::contact::normal as smooth

struct Contact {
    normal: vec3<f32>,
    overlap: f32,
    slip: vec3<f32>,
    separation: f32,
    spin: vec3<f32>,
    reduced_radius: f32,
    spring: vec3<f32>,
    sliding: u32,
    force: vec3<f32>,
    step: f32,
    rolling: vec3<f32>,
    twisting: f32,
    couple: vec3<f32>,
    radius: f32,
}

struct Answer {
    tangential: vec3<f32>,
    normal_force: f32,
    couple: vec3<f32>,
    twisting: f32,
    spring: vec3<f32>,
    sliding: u32,
    rolling: vec3<f32>,
    smooth_viscosity: f32,
    losses: vec3<f32>,
    smooth_force: f32,
    arms: vec3<f32>,
    unused: f32,
    spring_energies: vec2<f32>,
    unused_too: vec2<f32>,
}

@group(0) @binding(0) var<storage, read> inputs: array<Contact>;
@group(0) @binding(1) var<storage, read_write> outputs: array<Answer>;
@group(0) @binding(2) var<uniform> constants: Law;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&inputs) {
        return;
    }
    let c = inputs[id.x];
    let touch = Touch(c.normal, c.overlap, c.slip, c.separation);
    let turn = Turn(c.spin, c.reduced_radius);
    let memory = Memory(c.spring, c.sliding != 0u, c.force, c.rolling, c.twisting, c.couple);
    let r = chosen::respond(constants, touch, turn, memory, c.step);
    let at_wall = smooth::respond(constants, touch, turn, memory, c.step);
    let arms = vec3<f32>(
        chosen::velocity_arm(c.radius, c.overlap),
        chosen::torque_arm(c.radius, c.overlap, false),
        chosen::torque_arm(c.radius, c.overlap, true),
    );
    outputs[id.x] = Answer(
        r.tangential, r.normal_force,
        r.couple, r.memory.twisting,
        r.memory.spring, u32(r.memory.sliding),
        r.memory.rolling, at_wall.viscosity,
        vec3<f32>(r.friction, r.viscosity, r.rolling_loss), at_wall.normal_force,
        arms, 0.0,
        energies(constants, memory), vec2<f32>(0.0),
    );
}
