//! Waves of pressure: sound in gravel, and what is left of it in till.

use crate::common::{column, orders, relative_error};
use lbm::{Ends, Field, Regime, Side, Signal, Solver, State};
use std::f64::consts::TAU;

/// Speed [m/s] and damping [1/s] of a standing wave over `n` cells in a bed with the true
/// compressibility of water, over those of S ρ ∂²p/∂t² + S (μ/k) ∂p/∂t = ∇²p with ρ = ρ_water/φ:
/// c² = 1/(S ρ) and μ/(k ρ).
pub fn speed_and_damping(n: usize, permeability: f64) -> [f64; 2] {
    let length = 64.0;
    let mut model = column(n, length, permeability);
    model.ends[2] = Ends::Periodic;
    model.regime = Some(Regime::Acoustic);
    let wave: Vec<f64> = (0..n)
        .map(|k| (TAU * (k as f64 + 0.5) / n as f64).cos())
        .collect();
    let mut state = State::at_rest(&model);
    state.pressure = wave.iter().map(|w| 100.0 * w).collect();
    let mut solver = Solver::<f64>::new(model.clone(), state, 1).unwrap();
    let every = n as u64 / 8;
    let mut amplitude = |_| {
        let pressure = solver.snapshot().pressure;
        solver.advance(every).unwrap();
        pressure.iter().zip(&wave).map(|(p, w)| p * w).sum::<f64>()
    };
    let swing: Vec<f64> = (0..30).map(&mut amplitude).collect();
    // At equal times apart, h, a damped oscillation obeys a'' = A a' - B a with B = e^{-γh} and
    // A = 2 e^{-γh/2} cos ωh: least squares.
    let sum = |f: &dyn Fn(&[f64]) -> f64| swing.windows(3).map(f).sum::<f64>();
    let (m11, m12, m22) = (
        sum(&|w| w[1] * w[1]),
        sum(&|w| w[1] * w[0]),
        sum(&|w| w[0] * w[0]),
    );
    let (r1, r2) = (sum(&|w| w[2] * w[1]), sum(&|w| w[2] * w[0]));
    let det = m11 * m22 - m12 * m12;
    let a = (r1 * m22 - r2 * m12) / det;
    let b = (r1 * m12 - r2 * m11) / det;
    let h = every as f64 * solver.scaling().step;
    let damping = -b.ln() / h;
    let omega = (a / (2.0 * b.sqrt())).acos() / h;
    let speed = (omega * omega + damping * damping / 4.0).sqrt() * length / TAU;

    let density = model.fluid.density / 0.4;
    [
        speed * (0.4 * model.fluid.compressibility * density).sqrt(),
        damping * permeability * density / model.fluid.viscosity,
    ]
}

/// Waves in gravel run and are damped as they should, to one per cent.
/// Source: Biot (1956), J. Acoust. Soc. Am. 28, 168, for a frame that does not move.
#[test]
fn waves_in_gravel_have_their_speed_and_damping() {
    for permeability in [3e-7, 1e-7, 1e-8] {
        let [speed, damping] = speed_and_damping(64, permeability);
        assert!((speed - 1.0).abs() < 1e-2, "k {permeability:e}: {speed}");
        assert!(
            (damping - 1.0).abs() < 1e-2,
            "k {permeability:e}: {damping}"
        );
    }
}

/// A tide at the surface of a half-space, p = p0 e^(-z/δ) sin(ωt - z/δ) with δ = √(2D/ω), on `n`
/// cells over twelve skin depths δ: the greatest relative error at eight times of a period.
/// Source: Carslaw and Jaeger (1959), Conduction of Heat in Solids, 2.6.
pub fn tide(n: usize) -> f64 {
    let (depth, p0) = (12.0, 1e3);
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
    let mut error = |_| {
        solver.advance(steps).unwrap();
        relative_error(solver.snapshot().pressure, &profile(solver.time()))
    };
    (0..8).map(&mut error).fold(0.0, f64::max)
}

#[test]
fn a_pressure_wave_reaches_its_skin_depth() {
    let errors = [30, 60].map(tide);
    assert!(orders(&errors)[0] > 1.8, "{errors:?}");
    assert!(errors[1] < 3e-3, "{errors:?}");
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
