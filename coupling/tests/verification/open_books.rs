//! Where the energy goes in open pores, and what is left out there.

use crate::loose::*;
use coupling::{Coupled, Model, Resistance};
use lbm::{Side, Signal};

const LAW: Resistance = Resistance::DiFelice { diameter: DIAMETER };

/// Grains that fall in a closed box give their weight's work to the water, which loses it by drag.
#[test]
fn energy_of_grains_that_settle_is_found() {
    let size = [6.0 * DIAMETER, 6.0 * DIAMETER, 30.0 * DIAMETER];
    let places = scattered(size, 0.15, 3);
    let mut bed = closed(WATER, LAW, &places, size, [3, 3, 15]);
    let height = |bed: &Coupled<3>| {
        let grains = bed.grains().snapshot().state.grains;
        grains.position.iter().map(|x| x.z).sum::<f64>()
    };
    let start = height(&bed);
    bed.advance(5000).unwrap();
    let (grains, water) = (bed.grains().snapshot().ledger, bed.ledger());
    println!("{grains:?}\n{water:?}");
    let volume = std::f64::consts::PI / 6.0 * DIAMETER.powi(3);
    let fallen = (start - height(&bed)) * volume * (DENSITY - WATER.density) * GRAVITY;
    let lost = water.dissipated_darcy + water.dissipated_loose;
    let found = lost + water.kinetic + water.dissipated_method;
    println!("{:.6} of {fallen:e} J", found / fallen);
    assert!(
        water.residual.abs() < 2e-4 * water.work_grains,
        "{:e} J of {:e} J are not found",
        water.residual,
        water.work_grains
    );
    // The books could be wrong all the same: most is lost by drag, little to the method, and none
    // of these terms could be forgotten.
    assert!((0.8..1.0).contains(&(lost / fallen)), "{lost:e} J lost");
    for term in [
        water.kinetic,
        water.dissipated_loose,
        water.dissipated_darcy,
    ] {
        assert!(term > 6e-3 * fallen, "a term of {term:e} J");
    }
    assert!(water.dissipated_method.abs() < 0.05 * fallen);
}

/// Water that is pressed through a bed: what its sides put in is lost by drag.
#[test]
fn energy_of_water_that_flows_through_a_bed_is_found() {
    let width = 5.0 * DIAMETER;
    let height = 24.0 * DIAMETER;
    let state = laid(400, width, height);
    let mut water = Model::new([2, 2, 24], WATER, Resistance::Ergun { diameter: DIAMETER });
    let flux = 4e-3;
    water.sides = [
        Side::Flux(Signal::Table(vec![[0.0, 0.0], [0.02, flux]])),
        Side::Pressure(Signal::Steady(0.0)),
    ];
    let mut of_grains = model([width; 2]);
    of_grains.ledger = true;
    let mut bed = Coupled::<3>::new(of_grains, state, water, None, 1).unwrap();
    bed.advance(3000).unwrap();
    let before = bed.ledger();
    bed.advance(2000).unwrap();
    let now = bed.ledger();
    println!("{now:?}");
    assert!(
        now.residual.abs() < 2e-4 * now.work_sides,
        "{:e} J of {:e} J are not found",
        now.residual,
        now.work_sides
    );
    // Steady by now: the pressure at the bottom times the flux, and all of it is drag.
    let pressure = bed.water().on_walls()[0] / (width * width);
    let work = 2000.0 * STEP * pressure * flux * width * width;
    let sides = now.work_sides - before.work_sides;
    let lost = now.dissipated_darcy - before.dissipated_darcy;
    println!("{sides:e} and {lost:e} of {work:e} J");
    assert!((sides / work - 1.0).abs() < 0.01, "{sides:e} of {work:e} J");
    assert!((lost / work - 1.0).abs() < 0.01, "{lost:e} of {work:e} J");
}
