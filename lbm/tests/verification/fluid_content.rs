//! Water is neither made nor lost, but by sources and through sides.

use crate::common::{column, no_slip, scatter};
use lbm::{Bed, Ends, Field, Model, Real, Side, Signal, Solver, State};

/// A closed box of 6 x 5 x 7 cells whose porosity and permeability vary from cell to cell, one
/// of them solid.
fn closed() -> Model {
    let n = 6 * 5 * 7;
    let random = scatter(2 * n);
    let mut model = column(7, 0.7, 1e-13);
    model.cells = [6, 5, 7];
    model.ends[2] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3]));
    model.bed = Some(Bed {
        porosity: Field::Cells(random[..n].iter().map(|x| 0.3 + 0.2 * x).collect()),
        permeability: Field::Cells(random[n..].iter().map(|x| 1e-13 * (1.0 + x)).collect()),
        forchheimer: None,
    });
    model.solid = vec![false; n];
    model.solid[100] = true;
    model
}

/// What sources brought is there afterwards, with drag and storage that jump.
#[test]
fn content_is_what_the_sources_brought() {
    fn error<T: Real>() -> f64 {
        let model = closed();
        let n = model.solid.len();
        let source: Vec<f64> = scatter(n).iter().map(|x| 1e-6 * (x - 0.3)).collect();
        let mut solver = Solver::<T>::new(model.clone(), State::at_rest(&model), 1).unwrap();
        let steps = 1000;
        solver.advance_with(steps, &source).unwrap();
        let fluid = (0..n).filter(|&cell| !model.solid[cell]);
        let rate: f64 = fluid.map(|cell| source[cell]).sum();
        let brought = rate * model.spacing.powi(3) * solver.time();
        solver.snapshot().content / brought - 1.0
    }
    let (double, single) = (error::<f64>(), error::<f32>());
    assert!(double.abs() < 1e-12, "f64: {double:e}");
    assert!(single.abs() < 1e-6, "f32: {single:e}");
}

/// Uniform compaction of a closed bed: dp/dt = -∇·v/(φβ).
#[test]
fn uniform_compaction_raises_pressure_by_its_storage() {
    let mut model = column(6, 1.0, 1e-13);
    model.ends[2] = Ends::Walls(Side::FreeSlip, Side::FreeSlip);
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    let rate = 1e-5;
    solver.advance_with(500, &[rate; 6]).unwrap();
    let exact = rate * solver.time() / (0.4 * model.fluid.compressibility);
    for p in solver.snapshot().pressure {
        assert!((p / exact - 1.0).abs() < 1e-12, "{p} Pa, exact {exact} Pa");
    }
}

/// Cells change their height while water diffuses between them, and what they hold together
/// does not; at rest afterwards, pressure is content over storage.
#[test]
fn stretching_the_cells_keeps_their_content() {
    let model = closed();
    let n = model.solid.len();
    let mut state = State::at_rest(&model);
    state.pressure = scatter(n).iter().map(|x| 1e3 * x).collect();
    let mut solver = Solver::<f64>::new(model.clone(), state, 1).unwrap();
    let before = solver.snapshot().content;
    for k in 1..=200 {
        let thickness = model.spacing * (1.0 + 5e-4 * f64::from(k));
        solver.set_thickness(thickness).unwrap();
        solver.advance(20).unwrap();
    }
    let after = solver.snapshot();
    assert!((after.content / before - 1.0).abs() < 1e-13);
    solver.advance(20_000).unwrap();
    let after = solver.snapshot();
    let Some(bed) = &model.bed else {
        unreachable!()
    };
    let pores: f64 = (0..n)
        .filter(|&cell| !model.solid[cell])
        .map(|cell| bed.porosity.at(cell))
        .sum();
    let volume = model.spacing.powi(2) * after.thickness;
    let exact = before / (pores * volume * model.fluid.compressibility);
    for (cell, p) in after.pressure.iter().enumerate() {
        let off = p / exact - 1.0;
        assert!(
            model.solid[cell] || off.abs() < 1e-10,
            "cell {cell}: {off:e}"
        );
    }
    // Cells too flat for the lattice are refused.
    let flat = solver.set_thickness(0.5 * model.spacing);
    assert!(flat.unwrap_err().to_string().contains("below 3"));
}

/// In cells that are no cubes Darcy's flux is right along each axis.
#[test]
fn darcy_flux_does_not_depend_on_the_shape_of_the_cells() {
    for axis in [0, 2] {
        for stretch in [0.7, 1.0, 1.6] {
            let n = 8;
            let mut model = column(n, 1.0, 1e-12);
            let ends = Ends::Walls(
                Side::Pressure(Signal::Steady(500.0)),
                Side::Pressure(Signal::Steady(0.0)),
            );
            model.cells = [1; 3];
            model.cells[axis] = n;
            model.ends = [Ends::Periodic, Ends::Periodic, Ends::Periodic];
            model.ends[axis] = ends;
            // A body force against half of the pressure.
            let length = n as f64 * model.spacing * if axis == 2 { stretch } else { 1.0 };
            model.acceleration[axis] = -250.0 / length / model.fluid.density;
            let exact = 1e-12 / model.fluid.viscosity * 250.0 / length;
            let mut state = State::at_rest(&model);
            state.thickness = stretch * model.spacing;
            let mut solver = Solver::<f64>::new(model, state, 1).unwrap();
            solver.advance(20_000).unwrap();
            for q in solver.snapshot().flux {
                assert!(
                    (q[axis] / exact - 1.0).abs() < 1e-9,
                    "axis {axis}, stretch {stretch}: {} m/s, exact {exact} m/s",
                    q[axis]
                );
            }
        }
    }
}

/// A prescribed flux brings what it says, at edges with other sides too.
#[test]
fn what_flows_in_is_there_or_flows_out() {
    let mut model = column(6, 1.0, 1e-13);
    let rate = Signal::Sinusoidal {
        mean: 1e-7,
        amplitude: 1e-7,
        frequency: 0.05,
        phase: 0.3,
    };
    model.cells = [5, 4, 6];
    model.ends = [
        no_slip(),
        Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3])),
        Ends::Walls(Side::Flux(rate.clone()), Side::FreeSlip),
    ];
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    solver.advance(3000).unwrap();
    let step = solver.scaling().step;
    let brought: f64 = (0..3000)
        .map(|k| rate.at((f64::from(k) + 0.5) * step) * step)
        .sum();
    let content = solver.snapshot().content / (20.0 * model.spacing.powi(2));
    assert!(
        (content / brought - 1.0).abs() < 1e-11,
        "{content} and {brought} m"
    );
}
