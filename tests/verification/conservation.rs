//! A cloud without walls keeps momentum and angular momentum to round-off, whatever the law.

use dem::contact::{Linear, Sliding, Tension};
use dem::{Model, Snapshot, State};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tests::packing::{angular_momentum, momentum};
use tests::{MIDDLE, RADIUS, run, smooth, solver, state, steps_to, turning};

const STIFFNESS: f64 = 1e7;

fn everything() -> Linear {
    Linear {
        sliding: Some(Sliding {
            stiffness: 2.0 / 7.0 * STIFFNESS,
            damping: 30.0,
            friction_static: 0.58,
            friction_dynamic: 0.47,
        }),
        rolling: turning(0.1 * STIFFNESS, 5.0, 0.1),
        twisting: turning(0.1 * STIFFNESS, 5.0, 0.1),
        ..smooth(STIFFNESS, 80.0, Tension::Clip)
    }
}

/// 125 grains of three sizes, spinning, that fall together.
fn cloud(law: Linear) -> (Model, State) {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut grains = vec![];
    for k in 0..125 {
        let site = DVec3::from([k % 5, k / 5 % 5, k / 25].map(|s| f64::from(s) - 2.0));
        let radius = RADIUS * [0.6, 0.8, 1.0][k as usize % 3];
        grains.push((MIDDLE + 2.1 * RADIUS * site, radius));
    }
    let mut start = state(&grains, 0);
    for k in 0..start.grains.len() {
        let mut vector =
            |size: f64| DVec3::from([0, 1, 2].map(|_| random.random_range(-size..size)));
        let inwards = 10.0 * (MIDDLE - start.grains.position[k]);
        start.grains.velocity[k] = inwards + vector(0.3) + DVec3::new(0.1, -0.2, 0.15);
        start.grains.angular_velocity[k] = vector(40.0);
    }
    let model = tests::model(law, &start.grains);
    (model, start)
}

/// Sum of the magnitudes, the scale of round-off.
fn scale(start: &State) -> (f64, f64) {
    let grains = &start.grains;
    let momentum = |k: usize| grains.mass[k] * grains.velocity[k].length();
    let p: f64 = (0..grains.len()).map(momentum).sum();
    let l = (0..grains.len())
        .map(|k| momentum(k) * grains.position[k].length())
        .sum();
    (p, l)
}

#[test]
fn momentum_and_angular_momentum_stay() {
    let (model, start) = cloud(everything());
    let (p, l) = scale(&start);
    let mut solver = solver(&model, &start);
    for _ in 0..10 {
        solver.advance(steps_to(0.003, &model)).unwrap();
        let now = solver.snapshot().state;
        let lost = momentum(&now.grains) - momentum(&start.grains);
        assert!(
            lost.length() < 1e-13 * p,
            "momentum by {:e} of {p:e}",
            lost.length()
        );
        let lost = angular_momentum(&now.grains) - angular_momentum(&start.grains);
        assert!(
            lost.length() < 1e-13 * l,
            "angular momentum by {:e} of {l:e}",
            lost.length()
        );
    }
    let ledger = solver.snapshot().ledger;
    let lost = ledger.dissipated_friction + ledger.dissipated_viscosity + ledger.dissipated_rolling;
    let before = start.grains.kinetic_energy() + start.grains.rotational_energy();
    assert!(
        lost > 0.1 * before,
        "the cloud hardly met: lost {lost} of {before} J"
    );
}

/// Relative change of the total energy, springs included.
fn energy_error(law: Linear, finer: f64) -> (f64, Snapshot) {
    let (mut model, start) = cloud(law);
    model.step /= finer;
    // Frictionless grains do not spin.
    let spins = if law.sliding.is_some() {
        start.grains.rotational_energy()
    } else {
        0.0
    };
    let before = start.grains.kinetic_energy() + spins;
    let end = run(&model, &start, steps_to(0.01, &model));
    let ledger = end.ledger;
    let now = ledger.kinetic
        + ledger.rotational
        + ledger.elastic_normal
        + ledger.elastic_tangential
        + ledger.elastic_rolling
        + ledger.dissipated_friction
        + ledger.dissipated_viscosity
        + ledger.dissipated_rolling;
    ((now / before - 1.0).abs(), end)
}

#[test]
fn elastic_grains_keep_their_energy() {
    let elastic = smooth(STIFFNESS, 0.0, Tension::Clip);
    let (coarse, _) = energy_error(elastic, 1.0);
    let (fine, end) = energy_error(elastic, 8.0);
    assert!(coarse < 1e-2 && fine < 1e-4, "{coarse:e} and {fine:e}");
    assert_eq!(end.ledger.dissipated_friction, 0.0);
    // Without a dashpot this is the round-off of forces that are the springs' alone.
    assert!(end.ledger.dissipated_viscosity.abs() < 1e-9 * end.ledger.kinetic);
}

#[test]
fn what_friction_and_dashpots_take_is_booked() {
    let (coarse, end) = energy_error(everything(), 1.0);
    let (fine, _) = energy_error(everything(), 8.0);
    assert!(
        coarse < 2e-2 && fine < coarse / 3.0,
        "{coarse:e} and {fine:e}"
    );
    let ledger = end.ledger;
    let before = cloud(everything()).1.grains;
    let before = before.kinetic_energy() + before.rotational_energy();
    for lost in [
        ledger.dissipated_friction,
        ledger.dissipated_viscosity,
        ledger.dissipated_rolling,
    ] {
        assert!(lost > 1e-3 * before, "{ledger:?}");
    }
}
