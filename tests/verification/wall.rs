//! Walls: held, moving, and carrying a stress with a mass and damping of their own.

use approx::assert_relative_eq;
use dem::contact::Tension;
use dem::{Drive, Horizontal, StressLoad, Surface, Wall, WallMotion, WallState};
use glam::DVec3;
use std::f64::consts::TAU;
use tests::bed::Bed;
use tests::{MIDDLE, RADIUS, floor, mass, run, smooth, state, steps_to};

const LOAD: StressLoad = StressLoad {
    mean: 2e3,
    amplitude: 0.0,
    frequency: 0.0,
    area: 0.04,
    mass: 5.0,
    damping: 0.0,
};

fn lid(motion: WallMotion) -> Wall {
    Wall {
        name: "top".into(),
        normal: -DVec3::Z,
        surface: Surface::Frictionless,
        motion,
    }
}

/// A wall under `load` with nothing below: height gone down [m] and velocity [m/s] after `time`
/// [s].
fn falls(load: StressLoad, time: f64) -> (f64, f64) {
    falls_from(0.0, load, time)
}

/// The same, with the clock of the state at `clock` [s] to begin with.
fn falls_from(clock: f64, load: StressLoad, time: f64) -> (f64, f64) {
    let mut start = state(&[(MIDDLE + DVec3::Z * RADIUS, RADIUS)], 1);
    start.walls.push(WallState {
        offset: -1e3,
        velocity: 0.0,
    });
    start.time = clock;
    let mut model = tests::model(smooth(1e6, 0.0, Tension::Clip), &start.grains);
    model.walls = vec![floor(Surface::Frictionless), lid(WallMotion::Stress(load))];
    model.step = 1e-5;
    let end = run(&model, &start, steps_to(time, &model)).state.walls[1];
    (end.offset + 1e3, end.velocity)
}

#[test]
fn a_free_wall_is_accelerated_by_its_stress() {
    let rate = LOAD.mean * LOAD.area / LOAD.mass;
    let (way, speed) = falls(LOAD, 0.1);
    assert_relative_eq!(speed, rate * 0.1, max_relative = 1e-10);
    assert_relative_eq!(way, 0.5 * rate * 0.01, max_relative = 1e-9);
}

#[test]
fn a_damped_wall_reaches_its_terminal_velocity() {
    let damping = 200.0;
    let (_, speed) = falls(StressLoad { damping, ..LOAD }, 0.02);
    let terminal = LOAD.mean * LOAD.area / damping;
    let expected = terminal * (1.0 - (-damping / LOAD.mass * 0.02_f64).exp());
    assert_relative_eq!(speed, expected, max_relative = 1e-3);
}

/// M v = A ∫σ dt, with the phase counted from the time of the state: a run that goes on does
/// not begin the wave anew.
#[test]
fn a_sinusoidal_stress_is_that_of_the_clock() {
    let load = StressLoad {
        amplitude: 1e3,
        frequency: 3.0,
        ..LOAD
    };
    let (time, turn) = (0.11, TAU * 3.0);
    for clock in [0.0, 0.2] {
        let (_, speed) = falls_from(clock, load, time);
        let wave = (turn * clock).cos() - (turn * (clock + time)).cos();
        let impulse = load.mean * time + load.amplitude / turn * wave;
        assert_relative_eq!(speed, load.area * impulse / load.mass, max_relative = 1e-6);
    }
}

#[test]
fn a_wall_at_a_velocity_pushes_a_grain_along() {
    // An elastic grain hit by a wall at speed w leaves at 2 w.
    let speed = 0.3;
    let mut start = state(&[(MIDDLE + DVec3::Z * (RADIUS + 1e-6), RADIUS)], 1);
    start.walls[0].velocity = speed;
    let mut model = tests::model(smooth(1e6, 0.0, Tension::Clip), &start.grains);
    model.step /= 20.0;
    let mut moving = floor(Surface::Frictionless);
    moving.motion = WallMotion::Velocity(speed);
    model.walls = vec![moving];
    let end = run(&model, &start, steps_to(2e-3, &model));
    assert_relative_eq!(
        end.state.grains.velocity[0].z,
        2.0 * speed,
        max_relative = 1e-3
    );
    assert_relative_eq!(
        end.state.walls[0].offset,
        speed * end.state.time,
        max_relative = 1e-9
    );
    // The wall gave what the grain has.
    let kinetic = end.state.grains.kinetic_energy();
    assert_relative_eq!(end.ledger.work_walls, kinetic, max_relative = 1e-3);
}

/// Grains and floor carry what presses on the wall.
#[test]
fn a_stressed_wall_comes_to_rest_on_the_grains_that_carry_it() {
    let (model, start) = Bed::new(300, 6.0, 0.3, 1).compressed();
    let area = model.domain.area();
    let end = run(&model, &start, steps_to(20.0, &model));
    assert_relative_eq!(end.wall_force[1] / area, 1.0, max_relative = 2e-2);
    assert_relative_eq!(end.wall_force[0] / area, 1.0, max_relative = 2e-2);
    let mean = end.sums.wall_force[1] / end.sums.steps as f64;
    assert_relative_eq!(mean / area, 1.0, max_relative = 1e-1);
}

#[test]
fn held_and_driven_layers_move_as_told_and_are_free_along_z() {
    let (model, start) = Bed::new(300, 6.0, 0.5, 1).sheared(0.05);
    let Some(Drive::Velocity(speed)) = model.drive else {
        unreachable!("driven at a velocity")
    };
    let end = run(&model, &start, steps_to(5.0, &model));
    let grains = &end.state.grains;
    let mut moved_along_z = [0.0_f64; 2];
    for k in 0..grains.len() {
        let expected = match grains.constraint[k].horizontal {
            Horizontal::Free => continue,
            Horizontal::Held => 0.0,
            Horizontal::Driven => speed,
        };
        assert_eq!(grains.velocity[k].x, expected);
        assert_eq!(grains.velocity[k].y, 0.0);
        assert_eq!(grains.angular_velocity[k], DVec3::ZERO);
        let way = grains.displacement[k] - start.grains.displacement[k];
        assert!((way.x - expected * end.state.time).abs() < 1e-9 && way.y == 0.0);
        let layer = usize::from(expected > 0.0);
        moved_along_z[layer] = moved_along_z[layer].max(way.z.abs());
    }
    assert!(moved_along_z.iter().all(|&z| z > 1e-4), "{moved_along_z:?}");
}

/// In the mean over time the forces on both layers balance, as no other force acts along x but
/// the change of momentum between them.
#[test]
fn both_layers_feel_the_same_shear() {
    let (model, start) = Bed::new(300, 6.0, 0.5, 1).sheared(0.02);
    let end = run(&model, &start, steps_to(100.0, &model));
    let mean = |sum: f64| sum / end.sums.steps as f64 / model.domain.area();
    let (top, bottom) = (-mean(end.sums.driven_force), mean(end.sums.held_force));
    let free = |grains: &dem::Grains| -> f64 {
        let each =
            (0..grains.len()).filter(|&k| grains.constraint[k].horizontal == Horizontal::Free);
        each.map(|k| grains.mass[k] * grains.velocity[k].x).sum()
    };
    let change = free(&end.state.grains) - free(&start.grains);
    let change = change / end.state.time / model.domain.area();
    assert!(top > 0.2, "shear stress {top}");
    // The sums hold a force for a whole step, the momentum for halves at both ends.
    assert!(
        (top - bottom - change).abs() < 1e-3,
        "{top}, {bottom}, {change}"
    );
}

/// The layer is one rigid body: M dv/dt = τ A + the forces of the other grains.
#[test]
fn a_layer_under_shear_stress_moves_as_one_body() {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 1).sheared(0.02);
    let stress = 0.8;
    model.drive = Some(Drive::ShearStress(stress));
    let end = run(&model, &start, steps_to(3.0, &model));
    let layer: Vec<usize> = (0..start.grains.len())
        .filter(|&k| start.grains.constraint[k].horizontal == Horizontal::Driven)
        .collect();
    let velocity = &end.state.grains.velocity;
    assert!(
        layer
            .iter()
            .all(|&k| velocity[k].x == velocity[layer[0]].x && velocity[k].y == 0.0)
    );
    let mass: f64 = layer.iter().map(|&k| start.grains.mass[k]).sum();
    let time = end.state.time - start.time;
    let mean = end.sums.driven_force / end.sums.steps as f64;
    let gained = mass * (velocity[layer[0]].x - start.grains.velocity[layer[0]].x);
    let impulse = (mean + stress * model.domain.area()) * time;
    assert!(gained > 0.0);
    assert_relative_eq!(gained, impulse, max_relative = 1e-2);
}

/// With nothing in its way: v = τ A t / M, and the drive's work is all the layer has.
#[test]
fn a_free_layer_is_accelerated_by_its_shear_stress() {
    let places = [0.3, 0.7].map(|x| (DVec3::new(x, 0.5, RADIUS), RADIUS));
    let mut start = state(&places, 0);
    for constraint in &mut start.grains.constraint {
        constraint.horizontal = Horizontal::Driven;
    }
    let (stress, time) = (0.2, 0.1);
    let mut model = tests::model(smooth(1e6, 0.0, Tension::Clip), &start.grains);
    model.drive = Some(Drive::ShearStress(stress));
    let end = run(&model, &start, steps_to(time, &model));
    let mass = 2.0 * mass(RADIUS);
    let rate = stress * model.domain.area() / mass;
    let time = end.state.time;
    for k in 0..2 {
        let grains = &end.state.grains;
        assert_relative_eq!(grains.velocity[k].x, rate * time, max_relative = 1e-9);
        let way = 0.5 * rate * time * time;
        assert_relative_eq!(grains.displacement[k].x, way, max_relative = 1e-9);
    }
    let moving = 0.5 * mass * (rate * time).powi(2);
    assert_relative_eq!(end.ledger.work_drive, moving, max_relative = 1e-9);
}
