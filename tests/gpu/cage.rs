//! Contacts that overlap by 4e-8 m, undamped for long: f32 places would gain energy fifty
//! thousandfold.
//!
//! The energy of a leapfrog oscillates with the phase of the motion at the step in use; what
//! it keeps, for springs, is H = T + U - dt²/8 Σ F²/m with F the net forces, velocities and
//! places at one time.
//! Source: Hairer, Lubich and Wanner (2003), Acta Numerica 12, 399, section 4 (modified energy).

use crate::lab::Suite;
use dem::contact::Tension;
use dem::{Model, Snapshot, State, Surface, gpu};
use glam::{DQuat, DVec3};
use shaders::Device;
use tests::{RADIUS, floor, mass, smooth, state};

pub fn list(suite: &mut Suite) {
    suite.gpu("a_caged_grain_keeps_its_energy", |d| caged(d, SHORT));
    suite.gpu("a_stack_of_grains_keeps_its_energy", |d| stack(d, SHORT));
    suite.long("a_caged_grain_keeps_its_energy_for_long", |d| {
        caged(d, LONG)
    });
    suite.long("a_stack_of_grains_keeps_its_energy_for_long", |d| {
        stack(d, LONG);
    });
    suite.gpu("a_damped_grain_comes_to_rest", damped);
}

/// Steps in software; the long form, on hardware or with patience:
/// `cargo test -p tests --test gpu -- --ignored for_long`
const SHORT: u64 = 100_000;
const LONG: u64 = 1_000_000;

const STIFFNESS: f64 = 1e9;
const STEP: f64 = 6.6e-7;
/// Overlap at rest [m].
const OVERLAP: f64 = 4e-8;
/// Amplitude [m].
const AMPLITUDE: f64 = 2e-8;
const CENTRE: DVec3 = DVec3::new(0.312_345_678_9, 0.298_765_432_1, 0.345_678_912_3);

fn energy(s: &Snapshot, model: &Model) -> f64 {
    let grains = &s.state.grains;
    let gone = (0..grains.len()).map(|k| s.force[k].length_squared() / grains.mass[k]);
    let l = &s.ledger;
    l.kinetic + l.elastic_normal
        - l.work_gravity
        - model.step * model.step / 8.0 * gone.sum::<f64>()
}

/// Relative drift of the energy above that at rest, from the first to the last of ten readings.
fn drift(device: &Device, model: Model, state: State, rest: f64, steps: u64) -> f64 {
    let mut solver = gpu::Solver::new(device, model.clone(), state).unwrap();
    let clock = std::time::Instant::now();
    let mut energies = vec![energy(&solver.snapshot().unwrap(), &model) - rest];
    for _ in 0..10 {
        solver.advance(steps / 10).unwrap();
        energies.push(energy(&solver.snapshot().unwrap(), &model) - rest);
    }
    let per_step = clock.elapsed().as_secs_f64() / steps as f64;
    let off = energies.iter().map(|e| (e / energies[0] - 1.0).abs());
    let worst = off.fold(0.0, f64::max);
    println!(
        "energy {:.3e} J, after {steps} steps {:.3e} J; worst of ten {worst:.1e}; {:.0} us a step",
        energies[0],
        energies[10],
        1e6 * per_step
    );
    worst
}

/// One grain between six that are too heavy to move, along axes that no coordinate is along.
fn cage(damping: f64) -> (Model, State) {
    let turned = DQuat::from_euler(glam::EulerRot::XYZ, 0.5, 0.7, 0.3);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turned * axis);
    let moved = AMPLITUDE * (0.6 * axes[0] + 0.64 * axes[1] + 0.48 * axes[2]);
    let mut grains = vec![(CENTRE + moved, RADIUS)];
    for axis in axes {
        for side in [-1.0, 1.0] {
            grains.push((CENTRE + side * (2.0 * RADIUS - OVERLAP) * axis, RADIUS));
        }
    }
    let mut state = state(&grains, 0);
    for k in 1..7 {
        state.grains.mass[k] = 1e15;
        state.grains.moment_of_inertia[k] = 1e11;
    }
    let mut model = tests::model(smooth(STIFFNESS, damping, Tension::Clip), &state.grains);
    model.step = STEP;
    (model, state)
}

fn caged(device: &Device, steps: u64) {
    let (model, state) = cage(0.0);
    // Six contacts at their overlap of rest.
    let rest = 6.0 * 0.5 * STIFFNESS * OVERLAP * OVERLAP;
    let worst = drift(device, model, state, rest, steps);
    assert!(worst < 1e-3, "drift {worst:e}");
}

/// Three grains on a floor, so heavy that the lowest contact carries 40 N.
fn stack(device: &Device, steps: u64) {
    let weight = STIFFNESS * OVERLAP / 3.0;
    let mut height = -2.0 * RADIUS + RADIUS;
    let mut grains = vec![];
    let mut rest = 0.0;
    for above in [3.0, 2.0, 1.0] {
        let overlap = above * weight / STIFFNESS;
        height += 2.0 * RADIUS - overlap;
        rest += 0.5 * STIFFNESS * overlap * overlap;
        grains.push((DVec3::new(CENTRE.x, CENTRE.y, height), RADIUS));
    }
    let mut state = state(&grains, 1);
    let mut model = tests::model(smooth(STIFFNESS, 0.0, Tension::Clip), &state.grains);
    model.walls = vec![floor(Surface::Frictionless)];
    model.gravity = -weight / mass(RADIUS) * DVec3::Z;
    model.step = STEP;
    // Pushed down, where work of gravity counts from.
    state.grains.position[2].z -= 1e-8;
    rest -= weight * 1e-8;
    let worst = drift(device, model, state, rest, steps);
    assert!(worst < 1e-3, "drift {worst:e}");
}

/// A damped grain is at rest after some hundred steps, and stays so.
fn damped(device: &Device) {
    let (model, state) = cage(780.0);
    let mut solver = gpu::Solver::new(device, model, state).unwrap();
    let mut fastest: f64 = 0.0;
    solver.advance(2000).unwrap();
    for _ in 0..20 {
        solver.advance(37).unwrap();
        let now = solver.snapshot().unwrap();
        fastest = fastest.max(now.state.grains.velocity[0].length());
    }
    println!("at most {fastest:.1e} m/s");
    assert!(fastest < 1e-8, "still at {fastest:e} m/s");
}
