//! One device, one result: the same bits in a second run, however many steps are asked for at a
//! time, however often the solver is read, and after a restart.

use super::scenes::{free, porous, rough, scatter};
use crate::lab::Suite;
use lbm::gpu::Solver;
use lbm::{Ends, Model, Side, Signal, State};
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("the_same_bits_of_free_water", free_water);
    suite.gpu("the_same_bits_of_a_bed", bed);
}

/// Steps: more than a submission has, and odd.
const STEPS: u64 = 601;

fn all(device: &Device, model: &Model, state: &State) {
    let begun = |state: &State| Solver::new(device, model.clone(), state.clone()).unwrap();
    let bits = |state: &State| -> Vec<u64> {
        let all = state.populations.as_flattened();
        all.iter().map(|f| f.to_bits()).collect()
    };
    let mut solver = begun(state);
    solver.advance(STEPS).unwrap();
    let once = solver.state().unwrap();
    assert!(bits(&once) != bits(&begun(state).state().unwrap()));
    for (parts, reads, what) in [
        (&[STEPS][..], false, "a second run"),
        (&[1, 254, 1, 44, 301], false, "in parts"),
        (&[7, 1, 200, 193, 200], true, "read in between"),
    ] {
        let mut solver = begun(state);
        for &steps in parts {
            solver.advance(steps).unwrap();
            if reads {
                let now = solver.state().unwrap();
                assert_eq!(now.pressure, solver.snapshot().unwrap().pressure);
            }
        }
        assert!(bits(&solver.state().unwrap()) == bits(&once), "{what}");
    }
    // On the device's clock, if it has one.
    let mut solver = begun(state);
    solver.advance(3).unwrap();
    if let Some(timing) = solver.time_steps(STEPS - 3).unwrap() {
        assert!(timing.seconds > 0.0 && timing.steps > 100, "{timing:?}");
        assert_eq!(solver.steps(), 3 + timing.steps);
    }
    solver.advance(STEPS - solver.steps()).unwrap();
    assert!(bits(&solver.state().unwrap()) == bits(&once), "timed");

    // Stopped after an odd number of steps, and taken over by another solver.
    let mut solver = begun(state);
    solver.advance(333).unwrap();
    let mut solver = begun(&solver.state().unwrap());
    solver.advance(STEPS - 333).unwrap();
    let state = solver.state().unwrap();
    assert!(bits(&state) == bits(&once), "after a restart");
    assert_eq!(state.pressure, once.pressure);
}

fn free_water(device: &Device) {
    let mut model = free([13, 7, 6]);
    model.inertia = true;
    model.acceleration = [1e-5, 0.0, 2e-5];
    model.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([1e-3, 0.0, 0.0]));
    model.solid = scatter(13 * 7 * 6).iter().map(|&x| x < 0.1).collect();
    all(device, &model, &rough(&model, 1e-4, 1e-3));
}

fn bed(device: &Device) {
    let mut model = porous([13, 7, 6]);
    model.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3]));
    model.ends[2] = Ends::Walls(
        Side::Flux(Signal::Steady(1e-8)),
        Side::Pressure(Signal::Sinusoidal {
            mean: 10.0,
            amplitude: 20.0,
            frequency: 1.0,
            phase: 0.0,
        }),
    );
    all(device, &model, &rough(&model, 1e3, 1e-7));
}
