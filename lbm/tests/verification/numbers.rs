//! Which numbers are good enough for pore pressure?

use crate::common::{column, relative_error};
use crate::porous::{drained, terzaghi};
use lbm::{Error, Solver, State};

/// Single precision, shifted to rest, drains a column as double precision does, down to the
/// least diffusivity per step that the solver accepts: ε L², at one per cent. The pressure is
/// small, as it is in practice: p/(ρc²) is 5e-8 and less.
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
        let error = drained::<f32>(n, diffusivity, 1e3);
        assert!(error < most, "{n} cells, D {diffusivity:e}: {error:e}");
    }
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
    assert!(Solver::<f64>::new(model, state, 1).is_ok());
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
