//! Resistance to rolling and twisting: a spring, a dashpot and a slider for each.
//!
//! Rolling:  displacement s of rate R* (ω - (ω·n) n), with ω the spin of i against j,
//!           F = -k s - γ ds/dt, |F| <= μ_r F_n, torque R* F on i, -R* F on j.
//! Twisting: the same with the component along n.
//! R* = R_i R_j / (R_i + R_j), and R_i at a wall. Springs are carried and reset as the
//! tangential one is, with a single friction coefficient.
//! Source:   Luding (2008), Granular Matter 10, 235-246, sections 2.3.2 and 2.3.3.
//! Proof:    tests/verification (spin decay, rolling on an incline)

use super::{Response, Turn};
use crate::lanes::{Lanes, V3};

/// Spring, dashpot and slider against rolling or twisting.
///
/// They act on the displacement R* θ (R* = R_i R_j / (R_i + R_j), R* = R_i at a wall),
/// and give the torque R* F with |F| at most μ F_n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
    /// Friction coefficient μ_r (rolling) or μ_w (twisting) [-].
    pub friction: f64,
}

impl Turning {
    /// No resistance: whatever the stiffness, the limit is zero.
    pub(crate) const NONE: Self = Self {
        stiffness: 1.0,
        damping: 0.0,
        friction: 0.0,
    };
}

/// Add rolling and twisting resistance to `response`.
#[inline(always)]
pub(crate) fn resist<V: Lanes, const LEDGER: bool>(
    rolling: &Turning,
    twisting: &Turning,
    n: V3<V>,
    turn: &Turn<V>,
    pressing: V,
    step: V,
    response: &mut Response<V>,
) {
    let memory = response.memory;
    let zero = V::splat(0.0);
    let one = V::splat(1.0);
    let along = turn.spin.dot(n);

    let rate = turn.spin.minus(along, n).scale(turn.reduced_radius);
    let k = V::splat(rolling.stiffness);
    let gamma = V::splat(rolling.damping);
    let carried = memory.rolling.minus(memory.rolling.dot(n), n);
    let stretched = carried.plus(step, rate);
    let trial = V3::zero().minus(k, stretched).minus(gamma, rate);
    let limit = V::splat(rolling.friction) * pressing;
    let trial_squared = trial.dot(trial);
    let slides = trial_squared.greater(limit * limit);
    let force = trial.scale(V::select(slides, limit / trial_squared.sqrt(), one));
    let relaxed = force.plus(gamma, rate).scale(zero - one / k);
    let spring = V3::select(slides, relaxed, stretched);

    let twist_rate = along * turn.reduced_radius;
    let k_twist = V::splat(twisting.stiffness);
    let gamma_twist = V::splat(twisting.damping);
    let twist_stretched = twist_rate.mul_add(step, memory.twisting);
    let twist_trial = zero - k_twist * twist_stretched - gamma_twist * twist_rate;
    let twist_limit = V::splat(twisting.friction) * pressing;
    let twist_slides = twist_trial.abs().greater(twist_limit);
    let twist_cut = V::select(twist_slides, twist_limit / twist_trial.abs(), one);
    let twist_force = twist_trial * twist_cut;
    let twist_relaxed = zero - gamma_twist.mul_add(twist_rate, twist_force) / k_twist;
    let twist_spring = V::select(twist_slides, twist_relaxed, twist_stretched);

    let couple = force.plus(twist_force, n).scale(turn.reduced_radius);
    if LEDGER {
        let work = step * (memory.couple.dot(turn.spin) + couple.dot(turn.spin));
        let stored = k * (spring.dot(spring) - memory.rolling.dot(memory.rolling));
        let twisted = k_twist * (twist_spring * twist_spring - memory.twisting * memory.twisting);
        response.rolling_loss = V::splat(-0.5) * (work + stored + twisted);
    }
    response.couple = couple;
    response.memory.rolling = spring;
    response.memory.twisting = twist_spring;
    response.memory.couple = couple;
}
