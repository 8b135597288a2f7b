//! A bed that dilates at a prescribed rate, uniformly: heavy grains that are moved apart, and a
//! drained lid that rises with them.
//!
//! With ∇·v = ε, a tight base at z = 0 and the drain at z = h the suction grows from that of the
//! storage, p = -ε t/S, to that of the flow which fills the pores,
//!
//! > p = -(μ ε/2k) (h² - z²) + 2 (μ ε h²/k) Σ (-1)^j m⁻³ cos(m z/h) exp(-m² T),
//!
//! m = π/2, 3π/2, ..., T = k t/(μ S h²). Which of the two is seen is told by the Deborah number
//! De = S μ h²/(k t) = 1/T. Source: Carslaw and Jaeger (1959), Conduction of Heat in Solids, §3.14;
//! Goren et al. (2010), J. Geophys. Res. 115, B09216.

use crate::bed::*;
use coupling::Coupled;
use dem::WallMotion;
use glam::DVec3;
use std::f64::consts::PI;

/// Rate of dilation [1/s].
const RATE: f64 = 0.05;

/// Mean pressure of the layers of cells, from the base, after so many steps of dilation; that of
/// theory; and the Deborah number.
pub fn dilated(permeability: f64, steps: u64) -> (Vec<f64>, Vec<f64>, f64) {
    let mut state = pressed();
    let height = -state.walls[1].offset;
    for k in 0..state.grains.len() {
        let z = state.grains.position[k].z;
        state.grains.radius[k] *= 0.8;
        state.grains.velocity[k] = DVec3::new(0.0, 0.0, RATE * z);
        // Heavy: pressure does not stop them.
        state.grains.mass[k] *= 1e6;
    }
    state.contacts.clear();
    let mut model = model(law(), STRESS);
    model.walls[1].motion = WallMotion::Velocity(-RATE * height);
    let mut bed = Coupled::<3>::new(model, state, water(permeability), None, 1).unwrap();
    bed.advance(steps).unwrap();
    let now = bed.snapshot();
    let layers = now.pressure.chunks(25);
    let means = layers.map(|layer| layer.iter().sum::<f64>() / 25.0);
    let report = bed.report();
    let (h, time) = (report.height, steps as f64 * STEP);
    let passed = permeability * time / (WATER.viscosity * report.storage * h * h);
    let suction = WATER.viscosity * RATE * h * h / permeability;
    let theory = (0..4).map(|k| {
        let z = 0.25 * (k as f64 + 0.5);
        let terms = (0..400).map(|j| {
            let m = PI * (j as f64 + 0.5);
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            sign * (m * z).cos() * (-m * m * passed).exp() / m.powi(3)
        });
        suction * (-0.5 * (1.0 - z * z) + 2.0 * terms.sum::<f64>())
    });
    (means.collect(), theory.collect(), 1.0 / passed)
}

#[test]
fn a_layer_that_dilates_steadily_has_the_suction_of_the_flow_into_it() {
    let (found, theory, deborah) = dilated(1e-11, 1500);
    println!("{found:?} {theory:?} Pa, De {deborah}");
    assert!(
        deborah < 0.2 && theory[0] < -1e5,
        "not steady, or hardly sucked at"
    );
    for (found, exact) in found.iter().zip(&theory) {
        assert!(
            ((found - exact) / theory[0]).abs() < 0.01,
            "{found} of {exact} Pa"
        );
    }
}

/// Far above De = 1 the suction is that of the dilation, whatever the permeability, and far below
/// that of its rate.
#[test]
fn the_deborah_number_tells_storage_from_flow() {
    for permeability in [1e-15, 1e-13, 1e-12, 1e-11, 1e-10] {
        let (found, theory, deborah) = dilated(permeability, 600);
        println!(
            "k {permeability:e}, De {deborah:.3}: {} of {} Pa",
            found[0], theory[0]
        );
        assert!(
            (found[0] / theory[0] - 1.0).abs() < 0.05,
            "De {deborah}: {} of {} Pa",
            found[0],
            theory[0]
        );
    }
}
