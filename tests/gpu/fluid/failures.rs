//! What fails says so.

use super::scenes::{free, porous, rough};
use crate::lab::Suite;
use lbm::gpu::Solver;
use lbm::{Error, State};
use shaders::{Choice, Device};

pub fn list(suite: &mut Suite) {
    suite.gpu("a_lost_device_stops_the_fluid", lost);
    suite.gpu("numbers_that_run_away_are_told_on_the_gpu", run_away);
    suite.gpu("wrong_models_and_states_are_refused_on_the_gpu", wrong);
}

/// On a device of its own, since the others need theirs.
fn lost(_: &Device) {
    let device = Device::open(Choice::Any).unwrap();
    let model = porous([6, 5, 4]);
    let mut solver = Solver::new(&device, model.clone(), State::at_rest(&model)).unwrap();
    solver.advance(3).unwrap();
    device.destroy();
    let gone = |result: Result<(), Error>| match result {
        Err(Error::Device(shaders::Error::Lost(_))) => {}
        other => panic!("{other:?}"),
    };
    gone(solver.advance(3));
    gone(solver.advance(1000));
    gone(solver.snapshot().map(|_| ()));
    gone(solver.state().map(|_| ()));
    gone(Solver::new(&device, model.clone(), State::at_rest(&model)).map(|_| ()));
}

fn run_away(device: &Device) {
    let mut model = free([8, 8, 8]);
    model.inertia = true;
    model.fluid.viscosity = 5e-4;
    model.step = Some(1.0);
    let state = rough(&model, 0.0, 0.9);
    let mut solver = Solver::new(device, model, state).unwrap();
    let error = solver.advance(3000).unwrap_err();
    let Error::Unstable { step, what } = error else {
        panic!("{error}");
    };
    assert_eq!(step, solver.steps());
    assert!(what.contains("shorter"), "{what}");
    assert!(solver.advance(1).is_err(), "it goes on");
}

fn wrong(device: &Device) {
    let model = free([4, 4, 4]);
    let mut state = State::at_rest(&model);
    state.pressure.pop();
    let refused = Solver::new(device, model.clone(), state).err();
    assert!(matches!(refused, Some(Error::Invalid(what)) if what.contains("pressure")));
    let mut negative = model.clone();
    negative.spacing = -1.0;
    let refused = Solver::new(device, negative, State::at_rest(&model)).err();
    assert!(matches!(refused, Some(Error::Invalid(what)) if what.contains("spacing")));
    // What f32 cannot carry, as on the CPU.
    let mut slow = porous([1, 1, 32]);
    slow.step = Some(1e-9);
    let state = State::at_rest(&slow);
    let refused = Solver::new(device, slow, state).err();
    assert!(matches!(refused, Some(Error::Invalid(what)) if what.contains("f64")));
}
