//! What is stable, what is not, and what does not depend on the machine.

use crate::balance::shaken;
use crate::bed::*;
use crate::tampered::{Spoilt, Tampered};
use coupling::{Coupled, Ledger, Model, Water};
use dem::contact::Linear;
use dem::{Solver, State, WallMotion};
use lbm::Side;

/// Kinetic energy at the end over that at the start; infinite where the run has failed.
fn growth(water: Model, steps: u64) -> f64 {
    let mut bed = Coupled::<3>::new(model(law(), STRESS), shaken(1e-3), water, None, 1).unwrap();
    let start = bed.grains().snapshot().ledger.kinetic;
    match bed.advance(steps) {
        Ok(()) => bed.grains().snapshot().ledger.kinetic / start,
        Err(_) => f64::INFINITY,
    }
}

#[test]
fn a_shaken_bed_calms_down_at_any_interval_and_permeability() {
    for (permeability, interval) in [(1e-15, 1), (1e-15, 64), (1e-12, 1), (1e-12, 16), (1e-10, 1)] {
        let mut water = water(permeability);
        water.interval = Some(interval);
        let growth = growth(water, 1000);
        assert!(growth < 0.5, "k {permeability:e}, n {interval}: {growth:e}");
    }
}

/// Negative control: with the pressure of the last fluid step, instead of that which follows the
/// grains, the run blows up.
#[test]
fn plain_staggering_fails() {
    let mut water = water(1e-12);
    water.interval = Some(16);
    water.predicts = false;
    let growth = growth(water, 1000);
    assert!(growth > 100.0 || growth.is_nan(), "{growth:e}");
}

/// A frictionless bed without dashpots and its sealed water at hardly any permeability.
fn energies(spoilt: Spoilt, steps: u64) -> Vec<f64> {
    let undamped = Linear {
        normal_damping: 0.0,
        sliding: None,
        ..law()
    };
    let mut tight = water(1e-20);
    tight.sides = [Side::FreeSlip, Side::FreeSlip];
    let mut state = shaken(1e-2);
    state.contacts.clear();
    let mut solver = Solver::new(model(undamped, STRESS), state, 1).unwrap();
    let water = Water::<3>::new(tight, &solver, None).unwrap();
    let mut water = Tampered::new(water, spoilt);
    let mut energies = Vec::new();
    for _ in 0..steps / 64 {
        if solver.advance_together(64, &mut water).is_err() {
            energies.push(f64::INFINITY);
            break;
        }
        let now = solver.snapshot();
        let WallMotion::Stress(load) = solver.model().walls[1].motion else {
            unreachable!("the top wall is pushed");
        };
        let lid = now.state.walls[1];
        let beta = WATER.compressibility;
        let seen = water.water.snapshot();
        let cell = AREA / 25.0 * seen.height;
        let each = seen.pressure.iter().zip(&seen.porosity);
        let elastic: f64 = each.map(|(p, phi)| 0.5 * beta * phi * cell * p * p).sum();
        let wall = 0.5 * load.mass * lid.velocity * lid.velocity - lid.offset * STRESS * AREA;
        energies.push(now.ledger.stored() + elastic + wall);
    }
    energies
}

/// The bed's own energy, some tenths of a joule, waves about in these; it may only fall.
#[test]
fn energy_of_an_undamped_sealed_bed_only_falls() {
    let energies = energies(Spoilt::Not, 4096);
    println!("{energies:?}");
    let first = energies[0];
    let most = energies.iter().fold(f64::MIN, |m, e| m.max(*e));
    assert!(most - first < 1e-5, "up by {:e} J", most - first);
}

/// Negative control: a gather that is not the transpose of the scatter pumps energy.
#[test]
fn a_gather_of_its_own_pumps_energy() {
    let energies = energies(Spoilt::Trilinear, 4096);
    println!("{energies:?}");
    let first = energies[0];
    let most = energies.iter().fold(f64::MIN, |m, e| m.max(*e));
    assert!(most - first > 1e-2, "up by {:e} J", most - first);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = |threads: usize| -> (State, Vec<f64>, Ledger) {
        let water = water(1e-12);
        let state = shaken(0.5);
        let mut bed = Coupled::<3>::new(model(law(), STRESS), state, water, None, threads).unwrap();
        bed.advance(500).unwrap();
        assert!(bed.grains().searches() > 1, "no search was made");
        (
            bed.grains().snapshot().state,
            bed.water().pressure().to_vec(),
            bed.ledger(),
        )
    };
    let one = run(1);
    for threads in [2, 3] {
        assert!(run(threads) == one, "{threads} threads");
    }
}
