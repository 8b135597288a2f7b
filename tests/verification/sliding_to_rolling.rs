//! A ball thrown along a floor without spin slides, then rolls with 5/7 of its speed.
//!
//! Sliding: v = v₀ - μ_d g t, ω = 5/2 μ_d g t / R; rolling from t = 2 v₀ / (7 μ_d g) on.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dem::contact::{Linear, Sliding, Tension};
use glam::DVec3;
use tests::{GRAVITY, RADIUS, resting, smooth, solver, steps_to};

const STIFFNESS: f64 = 1e6;
const MU_D: f64 = 0.3;

fn law() -> Linear {
    Linear {
        sliding: Some(Sliding {
            stiffness: 2.0 / 7.0 * STIFFNESS,
            damping: 20.0,
            friction_static: 0.5,
            friction_dynamic: MU_D,
        }),
        ..smooth(STIFFNESS, 20.0, Tension::Clip)
    }
}

#[test]
fn a_thrown_ball_slides_with_mu_d_and_rolls_with_five_sevenths() {
    let thrown = 0.1;
    // Off the axes, so that both tangential components take part.
    let along = DVec3::new(0.6, 0.8, 0.0);
    let axis = DVec3::Z.cross(along);
    let (model, mut start) = resting(law(), 0.0, GRAVITY);
    start.grains.velocity[0] = thrown * along;
    let rolls_at = 2.0 * thrown / (7.0 * MU_D * GRAVITY);
    let mut solver = solver(&model, &start);

    solver.advance(steps_to(0.5 * rolls_at, &model)).unwrap();
    let now = solver.snapshot();
    let sliding = &now.state.grains;
    let lost = MU_D * GRAVITY * now.state.time;
    // The first evaluation counts as the step before it: one step of friction either way.
    let one_step = MU_D * GRAVITY * model.step;
    assert!(now.state.contacts[0].history.sliding);
    assert_abs_diff_eq!(
        sliding.velocity[0].dot(along),
        thrown - lost,
        epsilon = one_step
    );
    let spin = sliding.angular_velocity[0].dot(axis);
    assert_abs_diff_eq!(spin, 2.5 * lost / RADIUS, epsilon = 2.5 * one_step / RADIUS);

    solver.advance(steps_to(rolls_at, &model)).unwrap();
    let now = solver.snapshot();
    let rolling = &now.state.grains;
    assert!(!now.state.contacts[0].history.sliding);
    let speed = rolling.velocity[0].dot(along);
    assert_relative_eq!(speed, 5.0 / 7.0 * thrown, max_relative = 1e-4);
    let spin = rolling.angular_velocity[0].dot(axis);
    assert_relative_eq!(spin * RADIUS, speed, max_relative = 1e-4);

    solver.advance(steps_to(2.0 * rolls_at, &model)).unwrap();
    let later = solver.snapshot().state.grains.velocity[0].dot(along);
    assert_relative_eq!(later, speed, max_relative = 1e-6);
}
