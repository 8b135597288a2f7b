//! What cannot be stable or accurate is refused, with the remedy.

use crate::common::{column, free};
use lbm::{Ends, Field, Model, Side, Signal, Solver, State};

fn refused(model: Model, words: &[&str]) {
    let state = State::at_rest(&model);
    let message = match Solver::<f64>::new(model, state, 1) {
        Ok(_) => panic!("accepted, though {words:?}"),
        Err(error) => error.to_string(),
    };
    for word in words {
        assert!(message.contains(word), "no {word:?} in: {message}");
    }
}

#[test]
fn lattices_that_would_fail_are_refused() {
    let with = |base: &Model, change: &dyn Fn(&mut Model)| {
        let mut model = base.clone();
        change(&mut model);
        model
    };
    let water = free([4, 4, 4], 0.1);
    let bed = column(16, 1.0, 1e-13);
    refused(
        with(&water, &|m| m.step = Some(20.0)),
        &["relaxation time", "step of at most"],
    );
    refused(
        with(&water, &|m| {
            m.speed = 1.0;
            m.step = Some(1.0);
        }),
        &["Mach number", "step of at most"],
    );
    refused(
        with(&water, &|m| {
            m.speed = 20.0;
            m.inertia = true;
        }),
        &["Reynolds number", "spacing of at most"],
    );
    refused(with(&water, &|m| m.spacing = 0.0), &["spacing 0 m"]);
    refused(with(&water, &|m| m.cells[1] = 0), &["[4, 0, 4] cells"]);
    refused(
        with(&water, &|m| m.solid = vec![true; 64]),
        &["all cells are solid"],
    );
    refused(
        with(&water, &|m| {
            m.ends[0] = Ends::Walls(Side::NoSlip([1.0, 0.0, 0.0]), Side::FreeSlip);
        }),
        &["lower x side", "along itself"],
    );
    refused(
        with(&bed, &|m| m.step = Some(1e4)),
        &["diffuses", "step of at most"],
    );
    refused(
        with(&bed, &|m| {
            let Some(bed) = &mut m.bed else {
                unreachable!()
            };
            bed.porosity = Field::Uniform(1.2);
        }),
        &["porosity of cell 0", "at most 1"],
    );
    refused(
        with(&bed, &|m| {
            let Some(bed) = &mut m.bed else {
                unreachable!()
            };
            bed.permeability = Field::Cells(vec![1e-13; 3]);
        }),
        &["permeability: 3 values for 16 cells"],
    );
    refused(
        with(&bed, &|m| {
            m.ends[2] = Ends::Walls(
                Side::Pressure(Signal::Sinusoidal {
                    mean: 0.0,
                    amplitude: 1.0,
                    frequency: 1e3,
                    phase: 0.0,
                }),
                Side::FreeSlip,
            );
            m.step = Some(1e-3);
        }),
        &["a period", "step of at most"],
    );
    let mut state = State::at_rest(&water);
    state.thickness = 0.9;
    let error = Solver::<f64>::new(water, state, 1)
        .err()
        .map(|e| e.to_string());
    assert!(error.is_some_and(|e| e.contains("no cubes")));
}
