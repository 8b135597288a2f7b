// Linear spring-dashpot contact with static and dynamic friction. Twin of
// dem/src/contact/linear.rs, which carries the formula, its source and its proof.
//
// In f32 a spring stops growing where u dt is below 2^-25 of it, and is a few per cent off the
// way made where it is little more: below 1e-9 m/s for springs of 1e-8 m and steps of 1e-6 s
// (tests/gpu/springs.rs). The sizes of forces are compared as squares, which vanish below
// 1e-19 N: such a contact sticks.

#define_import_path dem::contact::linear
#import dem::contact::types::{Law, Touch, Turn, Memory, Response, tangential_loss}
#import dem::contact::normal as along_normal
#ifdef TURNS
#import dem::contact::turning::resist
#endif

fn velocity_arm(radius: f32, overlap: f32) -> f32 {
    return radius - 0.5 * overlap;
}

fn torque_arm(radius: f32, overlap: f32, wall: bool) -> f32 {
    return radius - 0.5 * overlap;
}

fn respond(law: Law, touch: Touch, turn: Turn, memory: Memory, step: f32) -> Response {
    let n = touch.normal;
    let u = touch.slip;
    let k_t = law.sliding.stiffness;
    let gamma_t = law.sliding.damping;

    let normal_force = along_normal::force(law.normal, touch);
    let pressing = max(normal_force, 0.0);

    let carried = memory.spring - dot(memory.spring, n) * n;
    let stretched = carried + step * u;
    let trial = -k_t * stretched - gamma_t * u;

    let dynamic_limit = law.sliding.friction_dynamic * pressing;
    let static_limit = law.sliding.friction_static * pressing;
    let limit = select(static_limit, dynamic_limit, memory.sliding);
    let trial_squared = dot(trial, trial);
    let slides = trial_squared > limit * limit;
    var tangential = trial;
    var spring = stretched;
    if slides {
        tangential = trial * (dynamic_limit * inverseSqrt(trial_squared));
        spring = (tangential + gamma_t * u) * (-1.0 / k_t);
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
    var response = Response(normal_force, tangential, vec3<f32>(0.0), after, friction, viscosity, 0.0);
#ifdef TURNS
    resist(law.rolling, law.twisting, n, turn, pressing, step, &response);
#endif
    return response;
}
