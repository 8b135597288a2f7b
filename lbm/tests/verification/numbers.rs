//! Which numbers are good enough for pore pressure?

use crate::common::{column, free, relative_error};
use crate::porous::{drained, terzaghi};
use lbm::{Bed, Ends, Error, Field, Real, Regime, Side, Signal, Solver, State};

/// Single precision, shifted to rest, drains a column as double precision does, down to the
/// least diffusivity per step that the solver accepts: ε L², at one per cent. The pressure is
/// small, as it is in practice: p/(ρc²) is 1e-6.
#[test]
fn single_precision_is_enough_down_to_its_limit() {
    let limit = |n: usize| 1.01 * f64::from(f32::EPSILON) * (n * n) as f64;
    for (n, diffusivity, most) in [
        (16, 0.1, 1e-3),
        (16, 1e-3, 1e-3),
        (16, limit(16), 1e-2),
        (32, 1e-2, 1e-3),
        (32, limit(32), 1e-2),
    ] {
        let error = drained::<f32>(n, diffusivity);
        assert!(error < most, "{n} cells, D {diffusivity:e}: {error:e}");
    }
}

/// Pressure of a column of `n` cells that drains, at T = 0.2, over what it began with, 1e-6 ρc².
/// Storage is 3 and drag `sigma`, which makes the diffusivity 1/3σ; nothing is refused, since it
/// is called incompressible.
pub fn at_drag<T: Real>(n: usize, sigma: f64) -> Vec<f64> {
    // τ = 1
    let viscosity = 1.0 / 6.0;
    let mut model = free([n, 1, 1], viscosity);
    model.regime = Some(Regime::Incompressible);
    model.step = Some(1.0);
    model.bed = Some(Bed {
        porosity: Field::Uniform(0.4),
        permeability: Field::Uniform(viscosity / sigma),
        forchheimer: None,
    });
    model.ends[0] = Ends::Walls(Side::Pressure(Signal::Steady(0.0)), Side::FreeSlip);
    let state = State {
        pressure: vec![1e-6; n],
        ..State::at_rest(&model)
    };
    let mut solver = Solver::<T>::new(model, state, 1).unwrap();
    solver
        .advance((0.2 * (n * n) as f64 * 3.0 * sigma).round() as u64)
        .unwrap();
    let pressure = solver.snapshot().pressure;
    pressure.iter().map(|p| p / 1e-6).collect()
}

/// The exact profile.
pub fn at_rest_below(n: usize) -> Vec<f64> {
    (0..n)
        .map(|k| terzaghi(1.0 - (k as f64 + 0.5) / n as f64, 0.2))
        .collect()
}

/// Drag changes the order of the numbers by four decades, and single precision follows double to
/// 1e-4 of the pressure as long as enough diffuses per step; where the least that the solver
/// accepts, ε L², is not reached it does not.
#[test]
fn single_precision_follows_double_while_enough_diffuses() {
    let n = 16;
    let off = |sigma| relative_error(at_drag::<f32>(n, sigma), &at_drag::<f64>(n, sigma));
    for sigma in [1.0, 10.0, 100.0] {
        let off = off(sigma);
        assert!(off < 1e-4, "σ {sigma}: {off:e}");
    }
    let least = f64::from(f32::EPSILON) * (n * n) as f64;
    let sigma = 3e4;
    assert!(1.0 / (3.0 * sigma) < least);
    let (frozen, double) = (at_drag::<f32>(n, sigma), at_drag::<f64>(n, sigma));
    let exact = at_rest_below(n);
    let error = relative_error(double, &exact);
    assert!(error < 1e-3, "f64: {error:e}");
    let error = relative_error(frozen, &exact);
    assert!(error > 1e-2, "f32: {error:e}");
}

/// Below the limit single precision is refused, and double is not.
#[test]
fn what_rounding_would_stop_is_refused() {
    let mut model = column(32, 1.0, 1e-17);
    model.step = Some(1e-3);
    let state = State::at_rest(&model);
    let refusal = Solver::<f32>::new(model.clone(), state.clone(), 1).err();
    let Some(Error::Invalid(message)) = refusal else {
        panic!("single precision was accepted");
    };
    assert!(message.contains("f64"), "{message}");
    assert!(Solver::<f64>::new(model.clone(), state.clone(), 1).is_ok());

    // As it is where sound sets the step.
    model.regime = Some(Regime::Acoustic);
    model.step = None;
    let refusal = Solver::<f32>::new(model.clone(), state.clone(), 1).err();
    assert!(refusal.is_some_and(|error| error.to_string().contains("rounding stops it")));
    assert!(Solver::<f64>::new(model, state, 1).is_ok());
}

/// In a scene that is undrained, a jump of pressure stays: a cell loses no more than two hundredths
/// of it. In one that lasts a hundred times as long it does.
#[test]
fn what_is_undrained_keeps_its_pressure() {
    let n = 8;
    let mut model = column(n, 1.0, 1e-15);
    let d = 1e-15 / (model.fluid.viscosity * 0.4 * model.fluid.compressibility);
    let duration = 0.009 / d * model.spacing.powi(2);
    model.step = Some(duration / 20.0);
    let mut state = State::at_rest(&model);
    state.pressure = (0..n)
        .map(|cell| if cell < n / 2 { 1e3 } else { 0.0 })
        .collect();
    let mut solver = Solver::<f64>::new(model, state.clone(), 1).unwrap();
    let lost = |solver: &Solver<f64>| {
        let now = solver.snapshot().pressure;
        let lost = now
            .iter()
            .zip(&state.pressure)
            .map(|(p, before)| (p - before).abs() / 1e3);
        lost.fold(0.0, f64::max)
    };
    assert!(solver.scaling().is_undrained(duration));
    solver.advance(20).unwrap();
    let short = lost(&solver);
    assert!(short > 1e-3 && short < 2e-2, "{short}");
    assert!(!solver.scaling().is_undrained(100.0 * duration));
    solver.advance(2000).unwrap();
    assert!(lost(&solver) > 0.2, "{}", lost(&solver));
}

/// Populations kept in 16 bits freeze: the change per step is below half of their last digit.
/// Here they are rounded to IEEE half precision after each step, scaled by 2^15 to make the
/// most of its range, for a pressure of 1e-2 ρc²; the arithmetic is in double precision.
#[test]
fn sixteen_bits_are_not_enough_for_pore_pressure() {
    let n = 16;
    let error = |diffusivity: f64, round: fn(f64) -> f64| {
        let mut model = column(n, 1.0, 1e-13);
        let d = 1e-13 / (model.fluid.viscosity * 0.4 * model.fluid.compressibility);
        let steps = (0.2 * (n * n) as f64 / diffusivity).round();
        model.step = Some(0.2 / d / steps);
        let mut state = State::at_rest(&model);
        let solver = Solver::<f64>::new(model.clone(), state.clone(), 1).unwrap();
        let p0 = 1e-2 * solver.scaling().pressure_unit();
        state.pressure = vec![p0; n];
        for _ in 0..steps as u64 {
            let mut solver = Solver::<f64>::new(model.clone(), state, 1).unwrap();
            solver.advance(1).unwrap();
            state = solver.state();
            let populations = state.populations.as_flattened_mut();
            populations.iter_mut().for_each(|f| *f = round(*f));
        }
        let solver = Solver::<f64>::new(model, state, 1).unwrap();
        let exact: Vec<f64> = (0..n)
            .map(|k| p0 * terzaghi((k as f64 + 0.5) / n as f64, 0.2))
            .collect();
        relative_error(solver.snapshot().pressure, &exact)
    };
    fn half(x: f64) -> f64 {
        let scaled = x * 32768.0;
        let exponent = scaled.abs().log2().floor().max(-14.0);
        let unit = (exponent - 10.0).exp2();
        let rounded = if scaled == 0.0 {
            0.0
        } else {
            (scaled / unit).round_ties_even() * unit
        };
        rounded / 32768.0
    }
    // 5.003 lies between 1280 and 1281 units of 2^-8, nearer to the latter.
    assert_eq!(half(5.003 / 32768.0), 1281.0 / 256.0 / 32768.0);
    let exact = error(1e-2, |f| f);
    assert!(exact < 1e-3, "without rounding: {exact:e}");
    let frozen = error(1e-2, half);
    assert!(frozen > 0.2, "in 16 bits: {frozen:e}");
}
