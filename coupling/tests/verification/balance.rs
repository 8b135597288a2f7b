//! What must balance: forces, volumes, stresses.

use crate::bed::*;
use crate::tampered::{Spoilt, Tampered};
use coupling::{Cavitation, Coupled, Water};
use dem::contact::Linear;
use dem::{Companion, Solver, State, StressLoad, WallMotion};
use glam::DVec3;
use lbm::Side;

/// The bed, its grains thrown about with this speed [m/s].
pub fn shaken(speed: f64) -> State {
    shake(pressed(), speed)
}

/// A bed, its grains thrown about with this speed [m/s].
pub fn shake(mut state: State, speed: f64) -> State {
    let mut random = random(7);
    for velocity in &mut state.grains.velocity {
        let throw = [random(), random(), random()].map(|x| 2.0 * x - 1.0);
        *velocity = speed * DVec3::from(throw);
    }
    state
}

/// Forces of the water on grains and walls sum to zero in every step, whatever happens: with
/// loose grains that are dragged, after renewals, after searches.
#[test]
fn forces_on_grains_and_walls_balance_to_rounding() {
    let model = model(law(), STRESS);
    let mut solver = Solver::new(model, shaken(0.05), 1).unwrap();
    let water = Water::new(water(1e-12), &solver, None).unwrap();
    let mut water = Tampered::new(water, Spoilt::Not);
    let mut largest: f64 = 0.0;
    for _ in 0..100 {
        solver.advance_together(7, &mut water).unwrap();
        let [x, y, z, sizes] = *water.balance.lock().unwrap();
        assert!(sizes > 1.0, "nothing is pushed: {sizes} N");
        largest = largest.max(x.abs().max(y.abs()).max(z.abs()) / sizes);
    }
    assert!(largest < 1e-14, "{largest:e}");
}

/// Momentum along x and y, along which walls do not push; and the volume of the water.
fn momentum_and_volume(steps: u64) {
    let state = shaken(0.05);
    let mut sealed = water(1e-12);
    sealed.sides = [Side::FreeSlip, Side::FreeSlip];
    let loaded = model(law(), 1.1 * STRESS);
    let mut bed = Coupled::<3>::new(loaded, state.clone(), sealed, None, 1).unwrap();
    let momentum = |state: &State| -> DVec3 {
        let grains = &state.grains;
        let each = grains.mass.iter().zip(&grains.velocity);
        each.map(|(m, v)| *m * *v).sum()
    };
    let scale: f64 = state.grains.mass.iter().sum::<f64>() * 0.05;
    bed.advance(steps).unwrap();
    let now = bed.grains().snapshot().state;
    let change = momentum(&now) - momentum(&state);
    assert!(
        change.truncate().length() < 1e-13 * scale * (steps as f64).sqrt(),
        "{change}"
    );
    // What has gone from between the walls is compressed: A Δh and the content are one number.
    let taken = AREA * (now.walls[1].offset - state.walls[1].offset);
    let content = bed.ledger().content;
    assert!(taken.abs() > 1e-9, "nothing was compressed: {taken:e}");
    // The height of the wall, 0.18 m, is rounded to 3e-17 m in each step.
    let rounding = AREA * 1.4e-17 * steps as f64;
    assert!(
        (content - taken).abs() < rounding && rounding < 1e-5 * taken.abs(),
        "{content:e} of {taken:e} m³"
    );
}

#[test]
fn momentum_and_volume_are_conserved() {
    momentum_and_volume(5000);
}

#[test]
#[ignore = "half a minute: the same over 1e5 steps"]
fn momentum_and_volume_are_conserved_for_long() {
    momentum_and_volume(100_000);
}

/// Mean stress of the grains on the tight bottom, pressure there and in the cells at the drained
/// top [Pa], under 110 kPa, while the water still carries most of the last ten.
fn stresses(spoilt: Spoilt) -> [f64; 3] {
    let loaded = with_load(&model(law(), STRESS), |load| StressLoad {
        mean: STRESS + 1e4,
        ..load
    });
    let mut solver = Solver::new(loaded, pressed(), 1).unwrap();
    let water = Water::new(water(1e-13), &solver, None).unwrap();
    let mut water = Tampered::new(water, spoilt);
    solver.advance_together(4000, &mut water).unwrap();
    let mut means = [0.0; 3];
    for _ in 0..600 {
        solver.advance_together(10, &mut water).unwrap();
        let forces = [
            solver.snapshot().wall_force[0],
            water.wall_force(0),
            water.wall_force(1),
        ];
        for (mean, force) in means.iter_mut().zip(forces) {
            *mean += force / AREA / 600.0;
        }
    }
    means
}

#[test]
fn total_stress_is_effective_stress_and_pore_pressure() {
    let [grains, pores, _] = stresses(Spoilt::Not);
    let total = grains + pores;
    assert!(pores > 9e3, "the water carries {pores} Pa only");
    assert!((total / 1.1e5 - 1.0).abs() < 1e-3, "{grains} + {pores} Pa");
}

/// Negative control: with -V ∇p alone, without drag, the balance fails by φ p.
#[test]
fn pressure_without_drag_fails_by_the_porosity() {
    let porosity = 0.4;
    let [grains, pores, top] = stresses(Spoilt::PressureAlone(1.0 - porosity));
    let off = (grains + pores - 1.1e5) / (pores - top);
    assert!(
        (off / porosity - 1.0).abs() < 0.1,
        "off by {off} of the pore pressure"
    );
}

/// Bed and walls move together through the lattice: no pressure.
#[test]
fn rigid_translation_makes_no_pressure() {
    let mut state = pressed();
    let speed = DVec3::new(0.17, 0.1, 0.05);
    state.grains.velocity.fill(speed);
    let mut model = model(law(), STRESS);
    let height = -state.walls[1].offset;
    model.walls[0].motion = WallMotion::Velocity(speed.z);
    model.walls[1].motion = WallMotion::Velocity(-speed.z);
    let mut water = water(1e-15);
    water.sides = [Side::FreeSlip, Side::FreeSlip];
    for check in [3000, 6000] {
        let mut bed =
            Coupled::<3>::new(model.clone(), state.clone(), water.clone(), None, 1).unwrap();
        bed.advance(check).unwrap();
        let way =
            bed.grains().snapshot().state.grains.displacement[0] - state.grains.displacement[0];
        assert!(way.x > 0.9 * check as f64 * STEP * speed.x);
        let now = bed.snapshot();
        let most = now.pressure.iter().fold(0.0f64, |m, p| m.max(p.abs()));
        assert!((now.height * 4.0 / height - 1.0).abs() < 1e-12);
        assert!(most < 1.0, "{most:e} Pa after {check} steps");
    }
}

/// A bed under its own weight and a load, drained to rest: the pressure beyond hydrostatic
/// vanishes, and the grains carry load and buoyant weight.
#[test]
fn a_wet_bed_at_rest_is_in_hydrostatic_equilibrium() {
    let damped = Linear {
        normal_damping: 300.0,
        ..law()
    };
    let mut model = with_load(&model(damped, STRESS), |load| StressLoad {
        damping: 3000.0,
        ..load
    });
    model.gravity = DVec3::new(0.0, 0.0, -9.81);
    let state = pressed();
    let volume: f64 = (0..state.grains.len())
        .map(|k| state.grains.volume(k))
        .sum();
    // Dry at first: loose grains fall onto others. In water they sink for seconds.
    let mut dry = Solver::new(model.clone(), state, 1).unwrap();
    dry.advance(10_000).unwrap();
    let state = dry.snapshot().state;
    let mut bed = Coupled::<3>::new(model, state, water(1e-11), None, 1).unwrap();
    bed.advance(20_000).unwrap();
    let now = bed.grains().snapshot();
    let carried = now.wall_force[0] - now.wall_force[1];
    let weight = volume * (DENSITY - WATER.density) * 9.81;
    assert!(
        (carried / weight - 1.0).abs() < 1e-3,
        "{carried} of {weight} N"
    );
    let most = bed
        .water()
        .pressure()
        .iter()
        .fold(0.0f64, |m, p| m.max(p.abs()));
    assert!(most < 1.0, "{most} Pa");
}

/// A closed box with grains that do not touch, its lid sinking and its grains with it:
/// dp/dt = -∇·v/(φ β).
#[test]
fn uniform_compaction_raises_the_pressure_by_the_storage() {
    let mut state = pressed();
    let height = -state.walls[1].offset;
    let speed = 0.01;
    for k in 0..state.grains.len() {
        let z = state.grains.position[k].z;
        state.grains.radius[k] *= 0.8;
        state.grains.velocity[k] = DVec3::new(0.0, 0.0, -speed * z / height);
        // Heavy: pressure does not stop them.
        state.grains.mass[k] *= 1e6;
    }
    state.contacts.clear();
    let mut model = model(law(), STRESS);
    model.walls[1].motion = WallMotion::Velocity(speed);
    let mut water = water(1e-12);
    water.sides = [Side::FreeSlip, Side::FreeSlip];
    let mut bed = Coupled::<3>::new(model, state, water, None, 1).unwrap();
    bed.advance(1000).unwrap();
    let now = bed.snapshot();
    let storage = WATER.compressibility * bed.ledger().pores;
    let theory = speed * AREA * 1000.0 * STEP / storage;
    let porosities = now.porosity.iter();
    let mean: f64 = now
        .pressure
        .iter()
        .zip(porosities)
        .map(|(p, phi)| p * phi)
        .sum::<f64>()
        / now.porosity.iter().sum::<f64>();
    assert!((mean / theory - 1.0).abs() < 1e-5, "{mean} of {theory} Pa");
}

/// A sealed bed whose lid is lifted and lowered again: the water breaks at the least pressure,
/// vapour takes the rest of the room, and the water is whole again when it has gone.
#[test]
fn water_breaks_at_the_least_pressure_and_closes_again() {
    let mut water = water(1e-12);
    water.sides = [Side::FreeSlip, Side::FreeSlip];
    water.cavitation = Some(Cavitation { pressure: -1e5 });
    let speed = 0.02;
    let mut state = pressed();
    let mut run = |speed: f64, water_state: Option<&coupling::State>, steps| {
        let mut model = model(law(), STRESS);
        model.walls[1].motion = WallMotion::Velocity(speed);
        let mut bed =
            Coupled::<3>::new(model, state.clone(), water.clone(), water_state, 1).unwrap();
        let before = bed.ledger();
        bed.advance(steps).unwrap();
        state = bed.grains().snapshot().state;
        let after = bed.ledger();
        let lifted = -speed * AREA * STEP * steps as f64;
        // Water comes from nowhere: content and room are one number.
        let off = (after.content - before.content + lifted) / lifted;
        assert!(off.abs() < 1e-9, "{off:e}");
        (bed.state(), bed.report(), after, bed.snapshot())
    };
    let (open, report, ledger, now) = run(-speed, None, 2048);
    let least = now.pressure.iter().fold(0.0f64, |m, p| m.min(*p));
    assert_eq!(least, -1e5);
    assert!(
        ledger.vapour > 1e-6 && report.vapour_most > 1e-6,
        "{ledger:?}"
    );
    assert!(!report.warnings().is_empty());
    let (_, _, ledger, now) = run(speed, Some(&open), 2048);
    assert!(ledger.vapour < 1e-9, "{ledger:?}");
    assert!(now.pressure.iter().all(|p| *p > -1e5));
}
