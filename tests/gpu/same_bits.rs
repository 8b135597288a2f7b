//! One device, one result: the same bits in a second run, however many steps are asked for at a
//! time, and however often the solver is read.

use crate::lab::Suite;
use dem::contact::Sliding;
use dem::{ContactLaw, Drive, Model, Snapshot, State, gpu};
use glam::DVec3;
use shaders::Device;
use tests::bed::Bed;
use tests::turning;

pub fn list(suite: &mut Suite) {
    suite.gpu("the_same_bits_driven_at_a_velocity", at_a_velocity);
    suite.gpu("the_same_bits_under_a_shear_stress", under_a_stress);
}

/// A sheared bed of the whole law, with a search every few steps.
pub fn case() -> (Model, State) {
    let (mut model, start) = Bed::new(200, 5.0, 0.5, 11).sheared(0.05);
    model.gravity = DVec3::new(0.0, 0.0, -0.01);
    model.skin = Some(0.005);
    let ContactLaw::Linear(law) = &mut model.law else {
        unreachable!("beds have the linear law")
    };
    law.sliding = law.sliding.map(|sliding| Sliding {
        friction_static: 0.7,
        damping: 0.3 * law.normal_damping,
        ..sliding
    });
    let (stiffness, damping) = (0.1 * law.normal_stiffness, 0.1 * law.normal_damping);
    law.rolling = turning(stiffness, damping, 0.1);
    law.twisting = turning(stiffness, damping, 0.1);
    (model, start)
}

fn begun(device: &Device, (model, state): &(Model, State), lanes: u32) -> gpu::Solver {
    gpu::Solver::with_lanes(device, lanes, model.clone(), state.clone()).unwrap()
}

const STEPS: u64 = 600;

/// The state after [`STEPS`] steps, made in parts of `each`, and read after each part if `reads`.
fn run(device: &Device, case: &(Model, State), lanes: u32, each: u64, reads: bool) -> Snapshot {
    let mut solver = begun(device, case, lanes);
    for _ in 0..STEPS / each {
        solver.advance(each).unwrap();
        if reads {
            let _ = solver.snapshot().unwrap();
        }
    }
    let end = solver.snapshot().unwrap();
    assert!(solver.searches() > 5, "{} searches", solver.searches());
    assert!(end.ledger.dissipated_friction > 0.0, "nothing slides");
    assert!(end.state.contacts.len() > 300, "the bed fell apart");
    end
}

/// All bits: a comparison by value would take -0 for 0.
pub fn assert_same(a: &Snapshot, b: &Snapshot, what: &str) {
    let entries = |s: &Snapshot| format!("{:?} {:?}", s.ledger, s.sums);
    assert_eq!(entries(a), entries(b), "{what}");
    assert!(format!("{a:?}") == format!("{b:?}"), "{what}");
}

fn all(device: &Device, case: &(Model, State), lanes: u32) {
    let once = run(device, case, lanes, STEPS, false);
    for (each, reads, what) in [
        (STEPS, false, "a second run"),
        (STEPS / 10, false, "ten parts"),
        (1, false, "step by step"),
        (25, true, "read 24 times"),
    ] {
        assert_same(&once, &run(device, case, lanes, each, reads), what);
    }
}

fn at_a_velocity(device: &Device) {
    all(device, &case(), 1);
}

/// Four threads a grain.
fn under_a_stress(device: &Device) {
    let (mut model, state) = case();
    model.drive = Some(Drive::ShearStress(0.8));
    all(device, &(model, state), 4);
}
