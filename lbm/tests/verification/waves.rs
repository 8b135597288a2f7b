//! Waves of pressure: sound in gravel, and what is left of it in till.

use crate::common::{column, relative_error};
use lbm::{Ends, Field, Regime, Side, Signal, Solver, State};
use std::f64::consts::TAU;

/// A standing wave in a bed obeys S ρ ∂²p/∂t² + S (μ/k) ∂p/∂t = ∇²p, with the true
/// compressibility of water and ρ = ρ_water/φ: speed and damping.
#[test]
fn waves_in_gravel_have_their_speed_and_damping() {
    for permeability in [1e-6, 1e-7] {
        let n = 64;
        let mut model = column(n, 64.0, permeability);
        model.ends[2] = Ends::Periodic;
        model.regime = None;
        let wave = |k: usize| (TAU * (k as f64 + 0.5) / n as f64).cos();
        let p0 = 100.0;
        let mut state = State::at_rest(&model);
        state.pressure = (0..n).map(|k| p0 * wave(k)).collect();
        let mut solver = Solver::<f64>::new(model.clone(), state, 1).unwrap();
        assert_eq!(solver.scaling().regime, Regime::Acoustic);
        let fluid = model.fluid;
        let density = fluid.density / 0.4;
        let speed = 1.0 / (0.4 * fluid.compressibility * density).sqrt();
        let damping = fluid.viscosity / (permeability * density);
        let omega = ((speed * TAU / 64.0).powi(2) - damping * damping / 4.0).sqrt();
        for _ in 0..6 {
            solver.advance(30).unwrap();
            let t = solver.time();
            let decay = (-damping * t / 2.0).exp();
            let swing = (omega * t).cos() + damping / (2.0 * omega) * (omega * t).sin();
            for (k, p) in solver.snapshot().pressure.iter().enumerate() {
                let off = p / p0 - wave(k) * decay * swing;
                assert!(
                    off.abs() < 1e-2,
                    "k {permeability:e}, {t} s, cell {k}: {off}"
                );
            }
        }
    }
}

/// A tide at the surface of a half-space: p = p0 e^(-z/δ) sin(ωt - z/δ), δ = √(2D/ω).
/// Source: Carslaw and Jaeger (1959), Conduction of Heat in Solids, 2.6.
#[test]
fn a_pressure_wave_reaches_its_skin_depth() {
    let (n, depth, p0) = (80, 8.0, 1e3);
    let mut model = column(n, depth, 1e-13);
    let d = 1e-13 / (model.fluid.viscosity * 0.4 * model.fluid.compressibility);
    let omega = 2.0 * d;
    model.ends[2] = Ends::Walls(
        Side::Pressure(Signal::Sinusoidal {
            mean: 0.0,
            amplitude: p0,
            frequency: omega / TAU,
            phase: 0.0,
        }),
        Side::FreeSlip,
    );
    let profile = |t: f64| -> Vec<f64> {
        let p = |k: usize| {
            let z = (k as f64 + 0.5) * depth / n as f64;
            p0 * (-z).exp() * (omega * t - z).sin()
        };
        (0..n).map(p).collect()
    };
    let mut state = State::at_rest(&model);
    state.pressure = profile(0.0);
    let mut solver = Solver::<f64>::new(model, state, 1).unwrap();
    let steps = (1.0 / (omega / TAU) / solver.scaling().step / 8.0) as u64;
    for _ in 0..8 {
        solver.advance(steps).unwrap();
        let error = relative_error(solver.snapshot().pressure, &profile(solver.time()));
        assert!(error < 3e-3, "{} s: {error:e}", solver.time());
    }
}

/// Which regime a bed is in follows from its numbers: sound in gravel, diffusion in till.
#[test]
fn permeability_decides_the_regime() {
    for (permeability, regime) in [
        (1e-7, Regime::Acoustic),
        (1e-12, Regime::Diffusive),
        (1e-17, Regime::Diffusive),
    ] {
        let mut model = column(32, 3.2, permeability);
        model.regime = None;
        let solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
        assert_eq!(solver.scaling().regime, regime, "k {permeability:e} m²");
    }
    // With free water above it runs acoustic throughout.
    let mut model = column(32, 3.2, 1e-13);
    model.regime = None;
    let Some(bed) = &mut model.bed else {
        unreachable!()
    };
    bed.permeability = Field::Cells(
        (0..32)
            .map(|k| if k < 16 { 1e-13 } else { f64::INFINITY })
            .collect(),
    );
    bed.porosity = Field::Cells((0..32).map(|k| if k < 16 { 0.4 } else { 1.0 }).collect());
    let solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    assert_eq!(solver.scaling().regime, Regime::Acoustic);
}
