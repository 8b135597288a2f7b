//! Sides of the box and solids in it.

use crate::common::{free, no_slip, relative_error};
use lbm::{Ends, Model, Side, Signal, Solver, State};
use std::f64::consts::PI;

/// A plane of free slip is one of symmetry: half a channel under it is the lower half of a
/// whole one, for flow along any direction of the plane.
#[test]
fn free_slip_is_symmetry() {
    let run = |n: usize, top: Side, solid: bool| {
        let mut model = free([4, 3, n], 0.1);
        model.ends[2] = Ends::Walls(Side::NoSlip([0.0; 3]), top);
        model.acceleration = [1e-6, 2e-6, 0.0];
        if solid {
            // A bump on each wall: flow that varies along the plane.
            model.solid = vec![false; 12 * n];
            model.solid[5] = true;
            if n == 12 {
                model.solid[12 * (n - 1) + 5] = true;
            }
        }
        let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
        solver.advance(777).unwrap();
        solver.snapshot().flux
    };
    for solid in [false, true] {
        let whole = run(12, Side::NoSlip([0.0; 3]), solid);
        let half = run(6, Side::FreeSlip, solid);
        let error = relative_error(half.into_flattened(), whole[..12 * 6].as_flattened());
        assert!(error < 1e-12, "solid {solid}: {error:e}");
    }
}

/// Slow flow along a duct between two pressures, in its middle, for the gradient that there is:
/// the ends themselves are free of shear stress, and the profile takes a width to develop.
/// Source: White (2006), Viscous Fluid Flow, 3-48.
#[test]
fn a_pressure_difference_drives_a_duct() {
    let (n, length, p, viscosity) = (12, 60, 1e-5, 0.1);
    let model = Model {
        ends: [
            Ends::Walls(
                Side::Pressure(Signal::Steady(p)),
                Side::Pressure(Signal::Steady(0.0)),
            ),
            no_slip(),
            no_slip(),
        ],
        ..free([length, n, n], viscosity)
    };
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 2).unwrap();
    solver.advance(6000).unwrap();
    let now = solver.snapshot();
    let axis = (n / 2 * n + n / 2) * length + length / 2;
    let gradient = (now.pressure[axis - 2] - now.pressure[axis + 2]) / 4.0;
    let u = |y: f64, z: f64| -> f64 {
        let a = n as f64 / 2.0;
        let term = |i: i32| {
            let i = f64::from(i);
            let sign = if (i as i32 / 2) % 2 == 0 { 1.0 } else { -1.0 };
            let k = i * PI / (2.0 * a);
            sign * (1.0 - (k * z).cosh() / (k * a).cosh()) * (k * y).cos() / i.powi(3)
        };
        let sum: f64 = (1..80).step_by(2).map(term).sum();
        16.0 * a * a / (viscosity * PI.powi(3)) * gradient * sum
    };
    let exact: Vec<f64> = (0..n * n)
        .map(|i| u((i % n) as f64 - 5.5, (i / n) as f64 - 5.5))
        .collect();
    let middle = now.flux.chunks(length).map(|row| row[length / 2][0]);
    let error = relative_error(middle, &exact);
    assert!(error < 1e-2, "{error:e}");
}
