// Resistance to rolling and twisting. Twin of dem/src/contact/turning.rs, which carries the
// formula and its source.

#define_import_path dem::contact::turning
#import dem::contact::types::{Turning, Turn, Response}

fn resist(
    rolling: Turning,
    twisting: Turning,
    n: vec3<f32>,
    turn: Turn,
    pressing: f32,
    step: f32,
    response: ptr<function, Response>,
) {
    let memory = (*response).memory;
    let along = dot(turn.spin, n);

    let rate = (turn.spin - along * n) * turn.reduced_radius;
    let k = rolling.stiffness;
    let gamma = rolling.damping;
    let carried = memory.rolling - dot(memory.rolling, n) * n;
    let stretched = carried + step * rate;
    let trial = -k * stretched - gamma * rate;
    let limit = rolling.friction * pressing;
    let trial_squared = dot(trial, trial);
    var force = trial;
    var spring = stretched;
    if trial_squared > limit * limit {
        force = trial * (limit * inverseSqrt(trial_squared));
        spring = (force + gamma * rate) * (-1.0 / k);
    }

    let twist_rate = along * turn.reduced_radius;
    let k_twist = twisting.stiffness;
    let gamma_twist = twisting.damping;
    let twist_stretched = memory.twisting + step * twist_rate;
    let twist_trial = -k_twist * twist_stretched - gamma_twist * twist_rate;
    let twist_limit = twisting.friction * pressing;
    var twist_force = twist_trial;
    var twist_spring = twist_stretched;
    if abs(twist_trial) > twist_limit {
        twist_force = select(-twist_limit, twist_limit, twist_trial > 0.0);
        twist_spring = (twist_force + gamma_twist * twist_rate) * (-1.0 / k_twist);
    }

    let couple = (force + twist_force * n) * turn.reduced_radius;
#ifdef LEDGER
    // Differences of squares as in `tangential_loss`.
    let work = step * dot(memory.couple + couple, turn.spin);
    let stored = k * dot(spring - memory.rolling, spring + memory.rolling);
    let twisted = k_twist * (twist_spring - memory.twisting) * (twist_spring + memory.twisting);
    (*response).rolling_loss = -0.5 * (work + stored + twisted);
#endif
    (*response).couple = couple;
    (*response).memory.rolling = spring;
    (*response).memory.twisting = twist_spring;
    (*response).memory.couple = couple;
}
