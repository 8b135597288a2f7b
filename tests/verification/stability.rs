//! The stable step is sharp for what it claims: one caged grain, and the crystal that sets it.

use dem::contact::{Linear, Sliding, Tension};
use dem::stability::stable_step;
use dem::{Model, State};
use glam::DVec3;
use tests::{DENSITY, MIDDLE, RADIUS, mass, ran_away, smooth, solver, state};

const STIFFNESS: f64 = 1e6;

/// A grain between two immovable ones (of enormous mass) along x, squeezed so that no contact
/// opens, and shaken a little: along the line two normal springs and dashpots hold it.
fn caged(damping: f64) -> (Model, State) {
    let apart = 2.0 * RADIUS - 1e-4;
    let places = [MIDDLE, MIDDLE - apart * DVec3::X, MIDDLE + apart * DVec3::X];
    let mut start = state(&places.map(|x| (x, RADIUS)), 0);
    for k in 1..3 {
        start.grains.mass[k] *= 1e12;
        start.grains.moment_of_inertia[k] *= 1e12;
    }
    start.grains.velocity[0] = 1e-6 * DVec3::X;
    let model = tests::model(smooth(STIFFNESS, damping, Tension::Keep), &start.grains);
    (model, start)
}

/// Largest speed [m/s] in the last of many steps of size `step`, or infinity where it ran away.
fn shaken(model: &Model, start: &State, step: f64) -> f64 {
    let mut solver = solver(
        &Model {
            step,
            ..model.clone()
        },
        start,
    );
    let mut fastest = 0.0;
    for n in 0..2000 {
        if solver.advance(1).is_err() {
            return f64::INFINITY;
        }
        if n >= 1900 {
            fastest = solver.snapshot().state.grains.velocity[0]
                .length()
                .max(fastest);
        }
    }
    fastest
}

/// h² ω² + 2 h c = 4 with ω² = 2 k/m and c = 2 γ/m, exactly.
fn limit_of_the_cage(damping: f64) -> f64 {
    let (a, c) = (2.0 * STIFFNESS / mass(RADIUS), 2.0 * damping / mass(RADIUS));
    4.0 / (c + (c * c + 4.0 * a).sqrt())
}

#[test]
fn a_caged_grain_is_stable_below_its_limit_and_runs_away_above() {
    for damping in [0.0, 20.0, 100.0, 1000.0] {
        let (model, start) = caged(damping);
        let limit = limit_of_the_cage(damping);
        let below = shaken(&model, &start, 0.99 * limit);
        let above = shaken(&model, &start, 1.01 * limit);
        assert!(below < 1e-5, "γ = {damping}: {below} m/s below the limit");
        // The walls of the cage stop it where contacts open.
        assert!(above > 1e-2, "γ = {damping}: {above} m/s above the limit");
    }
}

#[test]
fn the_stable_step_of_any_bed_lies_below_that_of_a_cage() {
    for damping in [0.0, 20.0, 100.0, 1000.0] {
        let (model, start) = caged(damping);
        let stable = stable_step(&model, &start.grains);
        assert!(stable < limit_of_the_cage(damping));
        assert!(
            stable > 0.2 * limit_of_the_cage(damping),
            "needlessly small"
        );
    }
}

/// A face-centred cubic crystal of equal grains, periodic along x and y, squeezed sideways.
///
/// Twelve contacts hold each grain inside it: its fastest mode is all grains turning in step.
fn crystal(law: Linear) -> (Model, State) {
    let cells = 4;
    let edge = 2.0_f64.sqrt() * (2.0 * RADIUS - 1e-4);
    let mut start = State::default();
    for k in 0..4 * cells * cells * cells {
        let cell = [k / 4 % cells, k / 4 / cells % cells, k / 4 / cells / cells];
        let inside = [
            [0.25, 0.25, 0.25],
            [0.75, 0.75, 0.25],
            [0.75, 0.25, 0.75],
            [0.25, 0.75, 0.75],
        ];
        let place = DVec3::from(cell.map(|c| c as f64)) + DVec3::from(inside[k % 4]);
        start.grains.add_sphere(edge * place, RADIUS, DENSITY);
    }
    let mut model = tests::model(law, &start.grains);
    model.domain.size = [cells as f64 * edge; 2];
    model.domain.periodic = [true, true];
    (model, start)
}

fn rough() -> Linear {
    Linear {
        sliding: Some(Sliding {
            stiffness: 2.0 * STIFFNESS,
            damping: 0.0,
            friction_static: 1e9,
            friction_dynamic: 1e9,
        }),
        ..smooth(STIFFNESS, 0.0, Tension::Keep)
    }
}

/// The crystal's free surfaces part with time; a mode that grows does so at once.
fn spin_after_a_shake(step_over_stable: f64) -> f64 {
    let (mut model, mut start) = crystal(rough());
    model.step = step_over_stable * stable_step(&model, &start.grains);
    start
        .grains
        .angular_velocity
        .fill(DVec3::new(1e-9, 2e-9, 1.5e-9));
    let mut solver = solver(&model, &start);
    if solver.advance(60).is_err() {
        return f64::INFINITY;
    }
    let spin = solver.snapshot().state.grains.angular_velocity;
    spin.iter().map(|w| w.length()).fold(0.0, f64::max)
}

#[test]
fn a_crystal_of_the_lightest_grains_is_at_its_limit() {
    let below = spin_after_a_shake(0.98);
    let above = spin_after_a_shake(1.15);
    assert!(above > 1e3 * below, "below {below}, above {above} rad/s");
}

/// A run beyond the limit stops with a reason instead of filling files with nonsense.
#[test]
fn numbers_that_run_away_are_noticed() {
    let (mut model, mut start) = crystal(rough());
    model.step = 1.5 * stable_step(&model, &start.grains);
    start.grains.angular_velocity.fill(DVec3::X);
    let mut solver = solver(&model, &start);
    assert!(ran_away(solver.advance(2000)));
}
