//! Resistance to rolling and twisting: a spring, a dashpot and a slider for each.
//!
//! Rolling:  displacement s of rate R* (ω - (ω·n) n), with ω the spin of i against j,
//!           F = -k s - γ ds/dt, |F| <= μ_r F_n, torque R* F on i, -R* F on j.
//! Twisting: the same with the component along n.
//! R* = R_i R_j / (R_i + R_j), and R_i at a wall. Springs are carried and reset as the
//! tangential one is, with a single friction coefficient.
//! Source:   Luding (2008), Granular Matter 10, 235-246, sections 2.3.2 and 2.3.3.
//! Twin:     shaders/dem/contact/turning.wgsl
//! Proof:    tests/verification (spin decay, rolling on an incline)

use super::{Memory, Response, Turn};
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
pub(crate) fn resist<V: Lanes>(
    (rolling, twisting): (&Turning, &Turning),
    n: V3<V>,
    turn: &Turn<V>,
    pressing: V,
    step: V,
    response: &mut Response<V>,
) {
    let old = response.springs;
    let zero = V::splat(0.0);
    let one = V::splat(1.0);
    let along = turn.spin.dot(n);

    let rate = turn.spin.minus(along, n).scale(turn.reduced_radius);
    let k = V::splat(rolling.stiffness);
    let gamma = V::splat(rolling.damping);
    let carried = old.rolling.minus(old.rolling.dot(n), n);
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
    let twist_stretched = twist_rate.mul_add(step, old.twisting);
    let twist_trial = zero - k_twist * twist_stretched - gamma_twist * twist_rate;
    let twist_limit = V::splat(twisting.friction) * pressing;
    let twist_slides = twist_trial.abs().greater(twist_limit);
    let twist_cut = V::select(twist_slides, twist_limit / twist_trial.abs(), one);
    let twist_force = twist_trial * twist_cut;
    let twist_relaxed = zero - gamma_twist.mul_add(twist_rate, twist_force) / k_twist;
    let twist_spring = V::select(twist_slides, twist_relaxed, twist_stretched);

    response.couple = force.plus(twist_force, n).scale(turn.reduced_radius);
    response.springs.rolling = spring;
    response.springs.twisting = twist_spring;
}

/// Energy lost in turning over the last drift [J]: the mean of the torque before and after
/// times the angle, less what the springs kept.
#[inline(always)]
pub(crate) fn loss<V: Lanes>(
    (rolling, twisting): (&Turning, &Turning),
    turn: &Turn<V>,
    before: &Memory<V>,
    after: &Response<V>,
    step: V,
) -> V {
    let work = step * (before.couple.dot(turn.spin) + after.couple.dot(turn.spin));
    let (old, new) = (before.springs, after.springs);
    let rolled = new.rolling.dot(new.rolling) - old.rolling.dot(old.rolling);
    let twisted = new.twisting * new.twisting - old.twisting * old.twisting;
    let stored = V::splat(rolling.stiffness) * rolled + V::splat(twisting.stiffness) * twisted;
    V::splat(-0.5) * (work + stored)
}
