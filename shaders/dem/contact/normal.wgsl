// The normal part of the linear laws; also the whole law of frictionless grains and walls.
// Twin of dem/src/contact/normal.rs, which carries the formula and its source.

#define_import_path dem::contact::normal
#import dem::contact::types::{Law, Normal, Touch, Turn, Memory, Response}

fn force(normal: Normal, touch: Touch) -> f32 {
    return max(normal.stiffness * touch.overlap - normal.damping * touch.separation, normal.floor);
}

// Energy taken by the dashpot over the last drift, J. The dashpot's force, F - k d, is small
// against F; after the step it is known without that difference, so only the force of the
// step before pays with digits.
fn loss(normal: Normal, touch: Touch, before: f32, step: f32) -> f32 {
    let way = touch.separation * step;
    let overlap_before = max(touch.overlap + way, 0.0);
    let dashpot_before = before - normal.stiffness * overlap_before;
    let least = normal.floor - normal.stiffness * touch.overlap;
    let dashpot_after = max(-normal.damping * touch.separation, least);
    return -0.5 * way * (dashpot_before + dashpot_after);
}

fn velocity_arm(radius: f32, overlap: f32) -> f32 {
    return radius;
}

fn torque_arm(radius: f32, overlap: f32, wall: bool) -> f32 {
    return radius;
}

fn respond(law: Law, touch: Touch, turn: Turn, memory: Memory, step: f32) -> Response {
    let zero = vec3<f32>(0.0);
    let normal_force = force(law.normal, touch);
    var viscosity = 0.0;
#ifdef LEDGER
    viscosity = loss(law.normal, touch, dot(memory.force, touch.normal), step);
#endif
    return Response(normal_force, zero, zero, memory, 0.0, viscosity, 0.0);
}
