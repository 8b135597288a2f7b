//! Where the energy of grains and water goes: every term on its own, and nothing is left.

use crate::balance::shaken;
use crate::bed::*;
use coupling::{Cavitation, Coupled, Ledger, Model};
use dem::{State, StressLoad, WallMotion};
use glam::DVec3;
use lbm::{Side, Signal};

/// Do the ledgers of grains and water close, to a part of the greatest work? And could the test
/// see it if one of these terms [J] were left out?
fn judge(grains: &dem::Ledger, water: &Ledger, part: f64, terms: &[f64]) {
    println!("{grains:?}\n{water:?}");
    let works = [water.work_grains, water.work_walls, water.work_sides];
    let scale = works.iter().fold(0.0f64, |most, work| most.max(work.abs()));
    assert!(
        water.residual.abs() < part * scale,
        "of the water's energy {:e} J are not found, of {scale:e} J",
        water.residual
    );
    // What the fluid steps take is told by difference: a term that is wrong would be in it.
    let lost = water.dissipated_darcy;
    assert!(lost > 0.0 && lost < 0.6 * scale, "{lost:e} J lost in flow");
    for term in terms {
        assert!(
            term.abs() > 10.0 * part * scale,
            "a term of {term:e} J could be forgotten"
        );
    }
}

fn sealed(permeability: f64) -> Model {
    let mut water = water(permeability);
    water.sides = [Side::FreeSlip, Side::FreeSlip];
    water
}

/// A load on a bed whose drain has a pressure of its own: the load presses water out against it.
#[test]
fn energy_of_a_bed_that_drains_is_found_to_the_last_term() {
    let loaded = with_load(&model(law(), STRESS), |load| StressLoad {
        mean: STRESS + 1e4,
        ..load
    });
    let mut water = water(1e-12);
    water.sides[1] = Side::Pressure(Signal::Steady(5e3));
    // Darcy's law between the cells holds in a fluid step, not for the saw that longer ones make.
    water.interval = Some(1);
    let mut bed = Coupled::<3>::new(loaded, pressed(), water, None, 1).unwrap();
    bed.advance(1000).unwrap();
    let early = bed.ledger();
    // What Darcy's law takes between the middles of the cells and the drain.
    let (mut darcy, mut before) = (0.0, power_of_darcy(&bed));
    for _ in 0..80 {
        bed.advance(50).unwrap();
        let now = power_of_darcy(&bed);
        darcy += 25.0 * STEP * (before + now);
        before = now;
    }
    let (grains, water) = (bed.grains().snapshot().ledger, bed.ledger());
    let (walls, sides) = (water.work_walls, water.work_sides);
    let lost = [water.dissipated_darcy, water.dissipated_loose];
    judge(
        &grains,
        &water,
        1e-4,
        &[water.elastic, walls, sides, lost[0], lost[1]],
    );
    // Springs take a little of what loads do; without the water's work a third more is missing.
    assert!(grains.residual.abs() < 1e-4 * grains.work_companion.abs());
    let found = water.dissipated_darcy - early.dissipated_darcy;
    println!("{found:e} of {darcy:e} J");
    assert!(
        (found / darcy - 1.0).abs() < 0.05,
        "{found:e} of {darcy:e} J"
    );
}

/// Σ Δp² A/(R Δz) along z [W], in which direction this bed drains, with R = μ/k.
fn power_of_darcy(bed: &Coupled<3>) -> f64 {
    let now = bed.snapshot();
    let conducts = 1e-12 / WATER.viscosity * AREA / 25.0 / now.height;
    let each = (0..100).map(|cell| {
        let p = now.pressure[cell];
        match now.pressure.get(cell + 25) {
            Some(above) => (p - above).powi(2),
            None => 2.0 * (p - 5e3).powi(2),
        }
    });
    conducts * each.sum::<f64>()
}

/// Grains thrown about in still water under gravity: they lose to it, and buoyancy works.
#[test]
fn energy_that_loose_grains_lose_is_found() {
    let mut each = water(1e-10);
    each.exchange = Some(1);
    losses::<3>(each, 2000, 1e-6);
    // Cells of one diameter, where walls are in the mean of faces.
    let mut fine = water(1e-11);
    fine.cells = [10, 10, 9];
    fine.exchange = Some(1);
    losses::<5>(fine, 300, 1e-6);
    // Of several steps the books do not know what the last one brought, but the mean.
    let mut held = water(1e-10);
    held.exchange = Some(2);
    losses::<3>(held, 2000, 1e-3);
}

fn losses<const N: usize>(water: Model, steps: u64, part: f64) {
    let mut heavy = model(law(), STRESS);
    heavy.gravity = DVec3::new(0.0, 0.0, -9.81);
    let mut bed = Coupled::<N>::new(heavy, shaken(5e-2), water, None, 1).unwrap();
    bed.advance(steps).unwrap();
    let (grains, water) = (bed.grains().snapshot().ledger, bed.ledger());
    let lift = grains.work_companion + water.work_grains;
    let lost = [water.dissipated_darcy, water.dissipated_loose];
    judge(&grains, &water, part, &[lift, lost[0], lost[1]]);
}

/// A lid is lifted from a sealed bed until the water breaks: what it takes to open vapour is kept.
#[test]
fn energy_that_opens_vapour_is_found() {
    let mut broken = sealed(1e-12);
    broken.cavitation = Some(Cavitation { pressure: -1e5 });
    broken.exchange = Some(1);
    let mut lifted = model(law(), STRESS);
    lifted.walls[1].motion = WallMotion::Velocity(-0.02);
    let mut bed = Coupled::<3>::new(lifted, pressed(), broken, None, 1).unwrap();
    bed.advance(2048).unwrap();
    let (grains, water) = (bed.grains().snapshot().ledger, bed.ledger());
    judge(
        &grains,
        &water,
        1e-3,
        &[water.work_walls, 1e5 * water.vapour],
    );
}

/// Books change nothing, and are not kept where nobody asks for them.
#[test]
fn books_do_not_change_the_run() {
    let run = |ledger: bool| -> (State, Ledger) {
        let mut model = model(law(), STRESS);
        model.ledger = ledger;
        let mut water = water(1e-12);
        water.exchange = Some(1);
        let mut bed = Coupled::<3>::new(model, shaken(0.5), water, None, 1).unwrap();
        bed.advance(300).unwrap();
        assert!(bed.grains().searches() > 1, "no search was made");
        (bed.grains().snapshot().state, bed.ledger())
    };
    let ((with, kept), (without, none)) = (run(true), run(false));
    assert!(with == without, "another run");
    assert!(
        kept.residual.abs() < 1e-3 * kept.dissipated_loose,
        "{kept:?}"
    );
    assert!(none.residual.is_nan() && none.work_walls.is_nan() && none.elastic.is_finite());
}
