//! Forces and torques from outside act on each grain as gravity does, and cost nothing when absent.

use approx::assert_relative_eq;
use dem::contact::{Linear, Tension};
use dem::{Horizontal, Outside};
use glam::DVec3;
use tests::bed::Bed;
use tests::{MIDDLE, RADIUS, friction, smooth, solver, state};

#[test]
fn a_free_grain_follows_force_and_torque() {
    let start = state(
        &[(MIDDLE, RADIUS), (MIDDLE + 0.1 * DVec3::X, 0.5 * RADIUS)],
        0,
    );
    let law = Linear {
        sliding: friction(1e6, 0.5),
        ..smooth(1e6, 0.0, Tension::Clip)
    };
    let model = tests::model(law, &start.grains);
    let (force, torque) = (
        [DVec3::new(1.0, -2.0, 3.0), DVec3::new(0.0, 0.0, -0.1)],
        [DVec3::new(0.01, 0.0, 0.02), DVec3::ZERO],
    );
    let mut solver = solver(&model, &start);
    solver
        .advance_with(
            100,
            Outside {
                force: &force,
                torque: &torque,
            },
        )
        .unwrap();
    let now = solver.snapshot();
    let time = now.state.time;
    let grains = &now.state.grains;
    for k in 0..2 {
        let velocity = force[k] * (time / grains.mass[k]);
        let spin = torque[k] * (time / grains.moment_of_inertia[k]);
        assert!((grains.velocity[k] - velocity).length() < 1e-12 * velocity.length());
        assert!((grains.angular_velocity[k] - spin).length() <= 1e-12 * spin.length());
        let way = 0.5 * time * velocity;
        assert!((grains.displacement[k] - way).length() < 1e-12 * way.length().max(RADIUS));
    }
    // They end when no longer given.
    solver.advance(100).unwrap();
    let later = solver.snapshot().state.grains;
    for k in 0..2 {
        assert_relative_eq!(
            later.velocity[k].length(),
            grains.velocity[k].length(),
            max_relative = 1e-12
        );
    }
}

/// Given in the order of identities, though the solver sorts its grains.
#[test]
fn gravity_from_outside_moves_a_bed_as_gravity_does() {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 2).sheared(0.05);
    let pull = DVec3::new(0.02, 0.01, -0.1);
    let weight: Vec<DVec3> = start.grains.mass.iter().map(|m| *m * pull).collect();
    let none = vec![DVec3::ZERO; weight.len()];
    let mut from_outside = solver(&model, &start);
    from_outside
        .advance_with(
            300,
            Outside {
                force: &weight,
                torque: &none,
            },
        )
        .unwrap();
    let outside = from_outside.snapshot().state.grains;
    model.gravity = pull;
    let mut by_gravity = solver(&model, &start);
    by_gravity.advance(300).unwrap();
    let gravity = by_gravity.snapshot().state.grains;
    for k in 0..outside.len() {
        let way = outside.displacement[k] - gravity.displacement[k];
        assert!(way.length() < 1e-9, "grain {k} is off by {way}");
        if outside.constraint[k].horizontal == Horizontal::Held {
            assert_eq!(outside.velocity[k].x, 0.0);
        }
    }
}

#[test]
fn zero_from_outside_gives_the_same_bits_as_nothing() {
    let (model, start) = Bed::new(300, 6.0, 0.5, 2).sheared(0.05);
    let zero = vec![DVec3::ZERO; start.grains.len()];
    let mut with = solver(&model, &start);
    with.advance_with(
        500,
        Outside {
            force: &zero,
            torque: &zero,
        },
    )
    .unwrap();
    let mut without = solver(&model, &start);
    without.advance(500).unwrap();
    assert!(with.snapshot().state == without.snapshot().state);
}

#[test]
fn forces_that_go_on_give_the_same_bits_as_one_call() {
    let (model, start) = Bed::new(300, 6.0, 0.5, 2).sheared(0.05);
    let pull: Vec<DVec3> = start
        .grains
        .mass
        .iter()
        .map(|m| *m * DVec3::new(0.1, 0.2, -0.1))
        .collect();
    let outside = Outside {
        force: &pull,
        torque: &pull,
    };
    let mut once = solver(&model, &start);
    once.advance_with(300, outside).unwrap();
    let mut thrice = solver(&model, &start);
    for _ in 0..3 {
        thrice.advance_with(100, outside).unwrap();
    }
    assert!(once.snapshot() == thrice.snapshot());
}
