//! The same bits for any number of threads, and after any interruption.

use crate::common::{column, free, no_slip, scatter};
use lbm::{Bed, Ends, Field, Model, Real, Side, Signal, Solver, State};

/// A box with solids scattered in it, walls of each kind, and, if porous, a rough bed.
fn scattered(porous: bool) -> Model {
    let cells = [37, 21, 23];
    let n = 37 * 21 * 23;
    let random = scatter(3 * n);
    let mut model = match porous {
        true => column(23, 2.3, 1e-13),
        false => free(cells, 0.05),
    };
    model.cells = cells;
    model.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([1e-4, 0.0, 0.0]));
    if porous {
        model.ends[2] = Ends::Walls(
            Side::Flux(Signal::Steady(1e-8)),
            Side::Pressure(Signal::Steady(50.0)),
        );
        model.bed = Some(Bed {
            porosity: Field::Cells(random[..n].iter().map(|x| 0.3 + 0.2 * x).collect()),
            permeability: Field::Cells(
                random[n..2 * n].iter().map(|x| 1e-13 * (1.0 + x)).collect(),
            ),
            forchheimer: None,
        });
    } else {
        model.ends[2] = no_slip();
        model.inertia = true;
        model.speed = 1e-3;
    }
    model.acceleration = [1e-6, 0.0, 2e-6];
    model.solid = random[2 * n..].iter().map(|&x| x < 0.2).collect();
    model
}

fn same_bits<T: Real>(porous: bool) {
    let model = scattered(porous);
    let run = |threads: usize, pieces: &[u64]| {
        let mut solver = Solver::<T>::new(model.clone(), State::at_rest(&model), threads).unwrap();
        pieces
            .iter()
            .for_each(|&steps| solver.advance(steps).unwrap());
        solver.state()
    };
    let one = run(1, &[21]);
    assert!(one.flux.as_flattened().iter().any(|&q| q != 0.0));
    for threads in [2, 3, 4] {
        assert!(
            run(threads, &[21]).populations == one.populations,
            "{threads} threads"
        );
    }
    assert!(
        run(2, &[1, 13, 7]).populations == one.populations,
        "in pieces"
    );

    // Stopped after an odd number of steps, and taken over by another solver.
    let half = run(2, &[9]);
    let mut solver = Solver::<T>::new(model.clone(), half, 3).unwrap();
    solver.advance(12).unwrap();
    assert!(
        solver.state().populations == one.populations,
        "after a restart"
    );
}

#[test]
fn free_water_has_the_same_bits_for_any_number_of_threads() {
    same_bits::<f64>(false);
    same_bits::<f32>(false);
}

#[test]
fn a_bed_has_the_same_bits_for_any_number_of_threads() {
    same_bits::<f64>(true);
    same_bits::<f32>(true);
}
