//! Velocity Verlet is of second order without dashpots. With them it is of first order, since
//! forces see velocities half a step old.

use approx::assert_abs_diff_eq;
use dem::contact::{Sliding, Tension};
use glam::DVec3;
use tests::{MIDDLE, RADIUS, mass, order, resting, run, smooth, state};

const STIFFNESS: f64 = 1e6;

/// Error of the overlap [m] of two grains that meet at 0.1 m/s, two radians of the undamped
/// oscillation later, against δ = v/ω_d exp(-β t) sin ω_d t.
fn overlap_error(steps: u64, damping: f64) -> f64 {
    let speed = 0.1;
    let effective = mass(RADIUS) / 2.0;
    let omega = (STIFFNESS / effective).sqrt();
    let time = 2.0 / omega;
    let mut start = state(
        &[
            (MIDDLE - DVec3::X * RADIUS, RADIUS),
            (MIDDLE + DVec3::X * RADIUS, RADIUS),
        ],
        0,
    );
    start.grains.velocity = vec![0.5 * speed * DVec3::X, -0.5 * speed * DVec3::X];
    let mut model = tests::model(smooth(STIFFNESS, damping, Tension::Keep), &start.grains);
    model.step = time / steps as f64;
    let end = run(&model, &start, steps).state.grains;
    let overlap = 2.0 * RADIUS - (end.position[1] - end.position[0]).length();

    let beta = damping / (2.0 * effective);
    let damped = (omega * omega - beta * beta).sqrt();
    overlap - speed / damped * (-beta * time).exp() * (damped * time).sin()
}

/// Error of the velocity [m/s] of a grain that rests on a floor and is pushed along it, one
/// radian later: v = v₀ (1 - (1 - cos ω t) / (1 + a²m/I)), ω² = k_t (1/m + a²/I), arm a = R - δ.
///
/// At a wall the arm is R - δ/2 for overlap δ.
fn sticking_error(steps: u64, damping: f64) -> f64 {
    let (speed, stiffness) = (1e-3, 2e5);
    let law = dem::contact::Linear {
        sliding: Some(Sliding {
            stiffness,
            damping,
            friction_static: 1e3,
            friction_dynamic: 1e3,
        }),
        ..smooth(STIFFNESS, 0.0, Tension::Clip)
    };
    let (mut model, mut start) = resting(law, 0.0, tests::GRAVITY);
    start.grains.velocity[0] = speed * DVec3::X;
    let m = start.grains.mass[0];
    let arm = RADIUS - 0.5 * (RADIUS - start.grains.position[0].z);
    let mobility = 1.0 / m + arm * arm / start.grains.moment_of_inertia[0];
    let omega = (stiffness * mobility).sqrt();
    let time = 1.0 / omega;
    model.step = time / steps as f64;
    let end = run(&model, &start, steps).state.grains;

    // u'' + 2 β u' + ω² u = 0 for the slip velocity u, of which the grain's share is 1/(m mobility).
    let beta = 0.5 * damping * mobility;
    let damped = (omega * omega - beta * beta).sqrt();
    let (sin, cos) = (damped * time).sin_cos();
    let slip = speed * (-beta * time).exp() * (cos - beta / damped * sin);
    end.velocity[0].x - (speed - (speed - slip) / (m * mobility))
}

fn orders(error: impl Fn(u64) -> f64) -> [f64; 2] {
    let errors = [200, 400, 800].map(error);
    [order(errors[0], errors[1]), order(errors[1], errors[2])]
}

#[test]
fn a_collision_without_dashpot_is_of_second_order() {
    for order in orders(|n| overlap_error(n, 0.0)) {
        assert_abs_diff_eq!(order, 2.0, epsilon = 0.05);
    }
}

#[test]
fn a_collision_with_dashpot_is_of_first_order() {
    for order in orders(|n| overlap_error(n, 20.0)) {
        assert_abs_diff_eq!(order, 1.0, epsilon = 0.05);
    }
}

#[test]
fn a_sticking_contact_without_dashpot_is_of_second_order() {
    for order in orders(|n| sticking_error(n, 0.0)) {
        assert_abs_diff_eq!(order, 2.0, epsilon = 0.05);
    }
}

#[test]
fn a_sticking_contact_with_dashpot_is_of_first_order() {
    for order in orders(|n| sticking_error(n, 5.0)) {
        assert_abs_diff_eq!(order, 1.0, epsilon = 0.05);
    }
}
