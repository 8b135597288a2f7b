//! The solver and the CPU's from one state, read side by side. Tolerances: `rounding.rs`.

use crate::compare::{apart, assert_within};
use crate::rounding::{allowed, nudged};
use dem::{Model, Outside, Snapshot, State, gpu};
use glam::DVec3;
use shaders::Device;
use tests::solver;

/// Steps at which the two are read; searches fall in between.
const READ_AT: [u64; 5] = [0, 1, 2, 20, 100];

/// How the two are run.
#[derive(Clone, Copy, Default)]
pub struct Way {
    /// Threads a grain, if not those that the device is given.
    pub lanes: Option<u32>,
    /// Forces from outside, others in each part and none in the last?
    pub pushed: bool,
}

/// Both from `state`, read now and then; then both from what the GPU hands over.
pub fn compare(device: &Device, model: &Model, state: &State) {
    compare_as(Way::default(), device, model, state);
}

pub fn compare_as(way: Way, device: &Device, model: &Model, state: &State) {
    let handed = phase(way, device, "first phase", model, state);
    phase(way, device, "second phase", model, &handed.state);
}

fn phase(way: Way, device: &Device, what: &str, model: &Model, state: &State) -> Snapshot {
    let (given, handed) = (model.clone(), state.clone());
    let on_gpu = match way.lanes {
        Some(lanes) => gpu::Solver::with_lanes(device, lanes, given, handed),
        None => gpu::Solver::new(device, given, handed),
    };
    let mut on_gpu = on_gpu.unwrap();
    // Periodic lengths in whole units, for all.
    let model = on_gpu.model().clone();
    let mut cpu = solver(&model, state);
    let start = cpu.snapshot();
    let mut off = solver(&model, &nudged(state, &start, &model));
    for (part, until) in READ_AT.into_iter().enumerate() {
        let steps = until - cpu.snapshot().sums.steps;
        if way.pushed && steps > 0 && part + 1 < READ_AT.len() {
            let (force, torque) = pushes(state.grains.len(), part);
            let outside = Outside {
                force: &force,
                torque: &torque,
            };
            on_gpu.advance_with(steps, outside).unwrap();
            cpu.advance_with(steps, outside).unwrap();
            off.advance_with(steps, outside).unwrap();
        } else {
            on_gpu.advance(steps).unwrap();
            cpu.advance(steps).unwrap();
            off.advance(steps).unwrap();
        }
        let (a, b) = (cpu.snapshot(), on_gpu.snapshot().unwrap());
        assert_eq!(b.state.time, a.state.time);
        assert_eq!(b.state.grains.id, a.state.grains.id);
        assert_eq!(b.state.grains.radius, a.state.grains.radius);
        assert_eq!(b.state.grains.mass, a.state.grains.mass);
        assert_eq!(b.state.grains.constraint, a.state.grains.constraint);
        let allowed = allowed(&a, &off.snapshot(), &start, &model);
        let what = format!("{what}, step {until}");
        assert_within(&what, &apart(&a, &b, &model), &allowed);
    }
    println!(
        "{what}: {} contacts, {} slide; searches: {} on the GPU, {} on the CPU",
        start.state.contacts.len(),
        sliding(&cpu.snapshot()),
        on_gpu.searches(),
        cpu.searches()
    );
    on_gpu.snapshot().unwrap()
}

/// Forces and torques of the size of a contact's, others for each grain and part.
fn pushes(grains: usize, part: usize) -> (Vec<DVec3>, Vec<DVec3>) {
    let wave = |k: usize| {
        let x = (7 * k + 3 * part) as f64;
        DVec3::new(x.sin(), (1.7 * x).cos(), (2.3 * x).sin())
    };
    let force = (0..grains).map(wave).collect();
    let torque = (0..grains).map(|k| 0.2 * wave(k + 1000)).collect();
    (force, torque)
}

fn sliding(s: &Snapshot) -> usize {
    let contacts = s.state.contacts.iter();
    contacts.filter(|c| c.history.sliding).count()
}
