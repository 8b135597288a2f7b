// The linear law exactly as LAMMPS computes it. Twin of dem/src/contact/linear_lammps.rs,
// which tells what differs from the linear law. Its two friction coefficients are equal.

#define_import_path dem::contact::linear_lammps
#import dem::contact::types::{Law, Touch, Turn, Memory, Response, tangential_loss}
#import dem::contact::normal as along_normal

fn velocity_arm(radius: f32, overlap: f32) -> f32 {
    return radius;
}

fn torque_arm(radius: f32, overlap: f32, wall: bool) -> f32 {
    return select(radius - 0.5 * overlap, radius, wall);
}

fn respond(law: Law, touch: Touch, turn: Turn, memory: Memory, step: f32) -> Response {
    let n = touch.normal;
    let u = touch.slip;
    let k_t = law.sliding.stiffness;
    let gamma_t = law.sliding.damping;

    let normal_force = along_normal::force(law.normal, touch);
    let limit = law.sliding.friction_dynamic * abs(normal_force);

    let old = memory.spring;
    let along = dot(old, n);
    var carried = old;
    if k_t * abs(along) > 1e-10 * limit {
        let flat = old - along * n;
        let flat_squared = dot(flat, flat);
        // ξ² / flat² = 1 + along² / flat²: a ratio of two numbers that close would let the
        // length wander by a rounding a step.
        let tilt = along * inverseSqrt(flat_squared);
        carried = select(vec3<f32>(0.0), flat * sqrt(1.0 + tilt * tilt), flat_squared > 0.0);
    }
    let stretched = carried + step * u;
    let trial = -k_t * stretched - gamma_t * u;

    let size = sqrt(dot(trial, trial));
    let slides = size > limit;
    var tangential = trial;
    var spring = stretched;
    if slides {
        // A contact that slides before it has any spring carries no tangential force. Not
        // told by the square of the spring, which vanishes in f32 below 1e-19 m.
        let loaded = any(stretched != vec3<f32>(0.0));
        tangential = trial * select(0.0, limit / size, loaded);
        spring = select(stretched, (tangential + gamma_t * u) * (-1.0 / k_t), loaded);
    }

    var friction = 0.0;
    var viscosity = 0.0;
#ifdef LEDGER
    let lost = tangential_loss(memory, k_t, tangential, spring, u, step);
    friction = select(0.0, lost, slides);
    let dashpot = select(lost, 0.0, slides);
    viscosity = dashpot + along_normal::loss(law.normal, touch, dot(memory.force, n), step);
#endif

    var after = memory;
    after.spring = spring;
    after.sliding = slides;
    return Response(normal_force, tangential, vec3<f32>(0.0), after, friction, viscosity, 0.0);
}
