//! Weight acts on fast grains with short steps too: v + g dt must not be lost in the last digit
//! of a velocity in single precision.

use crate::lab::Suite;
use dem::{State, gpu};
use glam::DVec3;
use shaders::Device;
use tests::bed::Bed;

pub fn list(suite: &mut Suite) {
    suite.gpu("weight_acts_on_fast_grains", falls);
}

/// The step of the poster, and one of stiff small grains.
fn falls(device: &Device) {
    for (step, speed) in [(6.6e-7, 1.0), (1e-7, 1.0), (1e-8, 2.5)] {
        let (mut model, _) = Bed::new(500, 7.0, 0.5, 1).sheared(0.01);
        model.walls.clear();
        model.drive = None;
        model.gravity = -9.81 * DVec3::Z;
        model.step = step;
        let mut state = State::default();
        let k = state.grains.add_sphere(DVec3::splat(3.0), 0.5, 2600.0) as usize;
        state.grains.velocity[k].z = -speed;
        let mut solver = gpu::Solver::new(device, model, state).unwrap();
        let steps = 5000;
        solver.advance(steps).unwrap();
        let gained = -speed - solver.snapshot().unwrap().state.grains.velocity[0].z;
        let share = gained / (9.81 * step * steps as f64);
        println!("steps of {step:e} s at {speed} m/s: {share:.5} of the weight");
        assert!((share - 1.0).abs() < 1e-3);
    }
}
