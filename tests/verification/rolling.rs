//! Resistance to rolling and twisting: torques of at most μ R* F_n.
//!
//! In place, without friction: ω = ω₀ - 5 μ g t / (2 R) on a floor (R* = R). Rolling freely on
//! a floor with friction: ω = ω₀ - 5 μ_r g t / (7 R). Down an incline v = 5/7 g (sin θ - μ_r cos θ) t,
//! at rest where tan θ ≤ μ_r. Two equal grains pressed together have R* = R/2.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dem::contact::{Linear, Sliding, Tension};
use dem::{Grains, Outside};
use glam::DVec3;
use tests::{
    GRAVITY, MIDDLE, RADIUS, mass, resting, run, smooth, solver, state, steps_to, turning,
};

const STIFFNESS: f64 = 1e6;
const MU: f64 = 0.1;

fn law(friction: f64, rolling: bool, twisting: bool) -> Linear {
    let resistance = turning(STIFFNESS, 10.0, MU);
    Linear {
        sliding: Some(Sliding {
            stiffness: 2.0 / 7.0 * STIFFNESS,
            damping: 20.0,
            friction_static: friction,
            friction_dynamic: friction,
        }),
        rolling: resistance.filter(|_| rolling),
        twisting: resistance.filter(|_| twisting),
        ..smooth(STIFFNESS, 20.0, Tension::Clip)
    }
}

/// Spin [rad/s] of a grain on a floor after `time` [s], and the time step [s].
fn spin_on_floor(law: Linear, spin: DVec3, rolls: bool, time: f64) -> (Grains, f64) {
    let (model, mut start) = resting(law, 0.0, GRAVITY);
    start.grains.angular_velocity[0] = spin;
    if rolls {
        start.grains.velocity[0] = spin.cross(RADIUS * DVec3::Z);
    }
    (
        run(&model, &start, steps_to(time, &model)).state.grains,
        model.step,
    )
}

/// `after` must be `before` slowed down at `rate` [rad/s²], but for the slope of the spring
/// before it yields and a step.
fn assert_slowed(after: DVec3, before: DVec3, rate: f64, time: f64, step: f64) {
    let expected = before - before.normalize() * (rate * time);
    let yielding = MU * mass(RADIUS) * GRAVITY / STIFFNESS / (RADIUS * before.length());
    let slack = rate * (step + yielding);
    assert!(
        (after - expected).length() < slack,
        "spin {after}, closed form {expected}, slack {slack}"
    );
}

#[test]
fn a_grain_turning_on_a_smooth_floor_slows_down_by_rolling_resistance() {
    let spin = DVec3::new(-3.0, 4.0, 0.0);
    let (after, step) = spin_on_floor(law(0.0, true, false), spin, false, 0.01);
    assert_slowed(
        after.angular_velocity[0],
        spin,
        2.5 * MU * GRAVITY / RADIUS,
        0.01,
        step,
    );
    assert!(after.velocity[0].length() < 1e-12);
}

#[test]
fn a_grain_twisting_on_a_smooth_floor_slows_down_by_twisting_resistance() {
    let spin = DVec3::new(0.0, 0.0, -5.0);
    let (after, step) = spin_on_floor(law(0.0, false, true), spin, false, 0.01);
    assert_slowed(
        after.angular_velocity[0],
        spin,
        2.5 * MU * GRAVITY / RADIUS,
        0.01,
        step,
    );
}

#[test]
fn rolling_and_twisting_do_not_resist_each_other() {
    for (spin, law) in [
        (DVec3::new(-3.0, 4.0, 0.0), law(0.0, false, true)),
        (DVec3::new(0.0, 0.0, -5.0), law(0.0, true, false)),
    ] {
        let (after, _) = spin_on_floor(law, spin, false, 0.01);
        assert_abs_diff_eq!(
            (after.angular_velocity[0] - spin).length(),
            0.0,
            epsilon = 1e-12
        );
    }
}

#[test]
fn turning_stops_for_good() {
    for (spin, law) in [
        (DVec3::new(-3.0, 4.0, 0.0), law(0.0, true, false)),
        (DVec3::new(0.0, 0.0, -5.0), law(0.0, false, true)),
    ] {
        let stops_at = 5.0 / (2.5 * MU * GRAVITY / RADIUS);
        let (after, _) = spin_on_floor(law, spin, false, 2.0 * stops_at);
        let left = after.angular_velocity[0].length();
        assert!(left < 1e-3 * spin.length(), "still turning at {left} rad/s");
    }
}

#[test]
fn a_rolling_grain_slows_down_with_two_sevenths_of_that() {
    let spin = DVec3::new(-3.0, 4.0, 0.0);
    let (after, _) = spin_on_floor(law(0.5, true, false), spin, true, 0.02);
    let expected = 5.0 - 5.0 / 7.0 * MU * GRAVITY / RADIUS * 0.02;
    assert_relative_eq!(
        after.angular_velocity[0].length(),
        expected,
        max_relative = 1e-3
    );
    assert_relative_eq!(
        after.velocity[0].length(),
        expected * RADIUS,
        max_relative = 1e-3
    );
}

#[test]
fn on_an_incline_a_grain_rolls_only_beyond_mu_r() {
    for (tan, rolls) in [
        (0.5 * MU, false),
        (0.9 * MU, false),
        (1.1 * MU, true),
        (2.0 * MU, true),
    ] {
        let cos = 1.0 / (1.0_f64 + tan * tan).sqrt();
        // Tilted in small steps, so that the springs never carry more than their share.
        let (_, mut state) = resting(law(0.5, true, false), 0.0, GRAVITY * cos);
        let mut released = None;
        for part in 1..=100 {
            let along = GRAVITY * tan * cos * f64::from(part) / 100.0;
            let (model, _) = resting(law(0.5, true, false), along, GRAVITY * cos);
            state = run(&model, &state, steps_to(0.005, &model)).state;
            released = Some(model);
        }
        let model = released.expect("a tilt");
        let before = state.grains.velocity[0].x;
        let end = run(&model, &state, steps_to(0.05, &model));
        let gained = (end.state.grains.velocity[0].x - before) / (end.state.time - state.time);
        if rolls {
            let expected = 5.0 / 7.0 * GRAVITY * cos * (tan - MU);
            assert_relative_eq!(gained, expected, max_relative = 1e-2);
        } else {
            assert!(
                before.abs() < 1e-6 && gained.abs() < 1e-5,
                "it moved at tan = {tan}"
            );
        }
    }
}

/// Pressed together by forces from outside and spun against each other.
#[test]
fn two_grains_slow_each_other_down_over_half_their_radius() {
    let (press, spin, time) = (1.0, 5.0, 2e-3);
    for (axis, law) in [
        (DVec3::X, law(0.0, false, true)),
        (DVec3::Y, law(0.0, true, false)),
    ] {
        let apart = 2.0 * RADIUS - press / STIFFNESS;
        let mut start = state(&[(MIDDLE, RADIUS), (MIDDLE + apart * DVec3::X, RADIUS)], 0);
        start.grains.angular_velocity = vec![spin * axis, -spin * axis];
        let model = tests::model(law, &start.grains);
        let mut solver = solver(&model, &start);
        let outside = Outside {
            force: &[press * DVec3::X, -press * DVec3::X],
            torque: &[DVec3::ZERO; 2],
        };
        solver
            .advance_with(steps_to(time, &model), outside)
            .unwrap();
        let after = solver.snapshot().state.grains;
        let rate = MU * press * 0.5 * RADIUS / after.moment_of_inertia[0];
        let expected = spin - rate * time;
        for (k, sign) in [(0, 1.0), (1, -1.0)] {
            let left = after.angular_velocity[k];
            assert_relative_eq!(left.dot(axis), sign * expected, max_relative = 5e-3);
            assert!((left - left.dot(axis) * axis).length() < 1e-9);
        }
    }
}
