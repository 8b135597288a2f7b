//! Water that is pushed through a bed at rest: the pressure it takes is that of the law of
//! resistance, layer by layer.

use crate::bed::*;
use coupling::{Coupled, Model, Resistance};
use dem::WallMotion;
use lbm::{Fluid, Side, Signal};

/// Differences of mean pressure between the middles of the layers, of a flux [m/s] upward, over
/// those of the law with the porosity of the layers; greatest departure from one.
fn departure(law: Resistance, fluid: Fluid, flux: f64, steps: u64) -> f64 {
    let mut model = model(crate::bed::law(), STRESS);
    model.walls[1].motion = WallMotion::Held;
    let mut water = Model::new([5, 5, 4], fluid, law);
    water.sides = [Side::Flux(Signal::Steady(flux)), drained()];
    let mut bed = Coupled::<3>::new(model, pressed(), water, None, 1).unwrap();
    bed.advance(steps).unwrap();
    let now = bed.snapshot();
    let layer = |k: usize, of: &[f64]| of[25 * k..25 * (k + 1)].iter().sum::<f64>() / 25.0;
    let resists = |k: usize| {
        let cells = &now.porosity[25 * k..25 * (k + 1)];
        // Beside each other: conductances add.
        let through = cells.iter().map(|phi| 1.0 / law.at(&fluid, *phi, flux));
        25.0 / through.sum::<f64>()
    };
    let departures = (0..3).map(|k| {
        let drop = layer(k, &now.pressure) - layer(k + 1, &now.pressure);
        let theory = 0.5 * now.height * flux * (resists(k) + resists(k + 1));
        println!("layer {k}: {drop} of {theory} Pa");
        (drop / theory - 1.0).abs()
    });
    departures.fold(0.0, f64::max)
}

#[test]
fn seepage_takes_the_pressure_of_darcys_law() {
    let law = Resistance::Darcy(coupling::Permeability::prefactor(1e-10));
    let departure = departure(law, WATER, 1e-5, 8000);
    assert!(departure < 0.01, "{departure}");
}

/// Ergun's law with half of its pressure from the square of the flux.
#[test]
fn seepage_takes_the_pressure_of_erguns_law() {
    let law = Resistance::Ergun { diameter: 2e-5 };
    let fluid = Fluid {
        viscosity: 1.8e-6,
        ..WATER
    };
    let flux = 4e-3;
    let share = law.at(&fluid, 0.4, 0.0) / law.at(&fluid, 0.4, flux);
    assert!(share > 0.3 && share < 0.7, "{share}");
    let departure = departure(law, fluid, flux, 2000);
    assert!(departure < 0.02, "{departure}");
}
