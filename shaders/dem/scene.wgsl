// What the step kernels read of a scene, and how its numbers are scaled. Twin:
// dem/src/gpu/scene.rs

#define_import_path dem::scene
#import dem::contact::types::Law

struct Scene {
    law: Law,
    gravity: vec3<f32>,    // m/s^2
    step: f32,             // s
    length: vec3<i32>,     // units; periodic lengths, 0 where the box is open
    unit: f32,             // m
    count: u32,            // grains
    way: f32,              // step / unit: from m/s to units a step
    force_scale: f32,      // 1 / (N of a unit of the force sums)
    energy_scale: f32,     // 1 / (J of a unit of the energy sums)
    drive_velocity: f32,   // m/s; of the driven layer where a velocity is prescribed
    drive_force: f32,      // N; on it where a shear stress is
    drive_kick: f32,       // step / mass of the layer, s/kg
    part: f32,             // m/s; a power of two: part of the velocities' remains
    parts: f32,            // 1 / part
    work_scale: f32,       // 1 / (J of a unit of the sums of the walls' work)
    unused_a: u32,
    unused_b: u32,
    walls: array<WallScene, 6>,
}

// A wall across an axis.
struct WallScene {
    axis: u32,
    side: i32,        // 1: grains lie above it, its normal points up the axis; -1: below
    kick: f32,        // step / mass, s/kg; 0 for a wall that is held or has a velocity
    damping: f32,     // N s/m
    push: f32,        // mean load, N
    amplitude: f32,   // of its modulation, N
    turn_hi: u32,     // turns of the modulation a step, parts of 2^-64 turn
    turn_lo: u32,
    start_hi: u32,    // turns at step zero
    start_lo: u32,
    full: u32,        // 1: the whole law, 0: frictionless
    unused: u32,
}

// Rows of a grain; half of them belong to even steps, half to odd ones.
struct Motion {
    velocity: vec3<f32>, // m/s, half a step behind but for the start's
    radius: f32,         // m
    spin: vec3<f32>,     // rad/s, half a step behind
    id: u32,
}

// What only the grain itself reads.
struct Own {
    kick: f32,   // step / mass, s/kg
    twist: f32,  // step / moment of inertia, s/(kg m^2)
    flags: u32,  // HELD, DRIVEN, STILL; from bit TOUCHES on: touches wall k
    image: u32,  // how often it left the box through its sides, 16 bits signed for x and y
}

const HELD: u32 = 1u;    // no motion along x and y
const DRIVEN: u32 = 2u;  // moves with the driven layer
const STILL: u32 = 4u;   // does not turn
const TOUCHES: u32 = 8u; // the first of the bits of walls

@group(0) @binding(40) var<uniform> scene: Scene;
