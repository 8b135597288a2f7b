// The contact law of the scene: the menu, as dem/src/contact/mod.rs is in Rust. One law is
// compiled, under one name. Smooth walls take dem::contact::normal instead.
//
//   (none)   normal force only
//   SLIDES   linear law with friction; with TURNS rolling and twisting resistance
//   LAMMPS   the linear law as LAMMPS computes it; comes with SLIDES

#define_import_path dem::contact::law
#import dem::contact::types::{Law, Touch, Turn, Memory, Response}
#ifdef LAMMPS
#import dem::contact::linear_lammps as chosen
#else
#ifdef SLIDES
#import dem::contact::linear as chosen
#else
#import dem::contact::normal as chosen
#endif
#endif

// Arm of the surface velocity for a grain of `radius` at `overlap`, m.
fn velocity_arm(radius: f32, overlap: f32) -> f32 {
    return chosen::velocity_arm(radius, overlap);
}

// Arm of the tangential force in the torque, m; `wall`: j is a wall.
fn torque_arm(radius: f32, overlap: f32, wall: bool) -> f32 {
    return chosen::torque_arm(radius, overlap, wall);
}

// Forces of a contact after a step of `step` seconds, zero in the first evaluation. `turn` is
// read only where the law turns, `memory.force` and `memory.couple` only with a ledger.
fn respond(law: Law, touch: Touch, turn: Turn, memory: Memory, step: f32) -> Response {
    return chosen::respond(law, touch, turn, memory, step);
}
