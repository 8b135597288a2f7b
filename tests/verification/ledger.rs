//! The energy ledger closes: what drive, walls and gravity bring is found again.

use dem::contact::{Linear, Tension};
use dem::{Body, Model, Snapshot, State, WallMotion};
use glam::DVec3;
use std::f64::consts::PI;
use tests::bed::Bed;
use tests::packing::separation;
use tests::{MIDDLE, RADIUS, friction, mass, resting, run, smooth, state, steps_to};

/// A sheared bed under gravity, with the wall's stress modulated.
fn case() -> (Model, State) {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 5).sheared(0.02);
    model.gravity = DVec3::new(0.01, 0.0, -0.05);
    if let WallMotion::Stress(load) = &mut model.walls[1].motion {
        load.amplitude = 0.3;
        load.frequency = 0.2;
    }
    (model, start)
}

/// After a strain of 0.1, with steps `finer` times smaller than the default.
fn sheared(finer: f64) -> Snapshot {
    let (mut model, start) = case();
    model.step /= finer;
    run(&model, &start, steps_to(5.0, &model))
}

/// At the default step errors of first and second order happen to cancel in part, so the order
/// is looked for below it.
#[test]
fn the_residual_is_small_against_the_work_of_the_drive_and_falls_with_the_step() {
    let [default, coarse, fine] = [1.0, 4.0, 16.0].map(sheared);
    let relative = |s: &Snapshot| (s.ledger.residual / s.ledger.work_drive).abs();
    let residuals = [&default, &coarse, &fine].map(relative);
    println!("residual over work: {residuals:?}");
    assert!(residuals[0] < 1e-4, "{:?}", default.ledger);
    assert!(residuals[2] < 0.4 * residuals[1], "{residuals:?}");
}

/// Energies of motion and springs, with their formulas written out.
#[test]
fn motion_and_springs_are_those_of_the_state() {
    let end = sheared(1.0);
    let grains = &end.state.grains;
    let (model, _) = case();
    let normal = model.law.normal_stiffness();
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    let (mut moving, mut turning) = (0.0, 0.0);
    for k in 0..grains.len() {
        // Spheres of density 1.
        let mass = 4.0 / 3.0 * PI * grains.radius[k].powi(3);
        moving += 0.5 * mass * grains.velocity[k].length_squared();
        let inertia = 0.4 * mass * grains.radius[k].powi(2);
        turning += 0.5 * inertia * grains.angular_velocity[k].length_squared();
    }
    assert!(close(end.ledger.kinetic, moving));
    assert!(close(end.ledger.rotational, turning));
    let (mut pressed, mut sheared) = (0.0, 0.0);
    for contact in &end.state.contacts {
        let i = contact.i as usize;
        let distance = match contact.j {
            Body::Grain(j) => {
                let j = j as usize;
                let d = separation(grains.position[i], grains.position[j], &model.domain);
                d.length() - grains.radius[j]
            }
            Body::Wall(0) => grains.position[i].z,
            Body::Wall(_) => -end.state.walls[1].offset - grains.position[i].z,
        };
        pressed += 0.5 * normal * (grains.radius[i] - distance).powi(2);
        sheared += 0.5 * 2.0 / 7.0 * normal * contact.history.spring.length_squared();
    }
    // An overlap of 1e-4 d is a difference of lengths up to the box of 10 d.
    assert!((end.ledger.elastic_normal / pressed - 1.0).abs() < 1e-10);
    assert!(close(end.ledger.elastic_tangential, sheared));
}

/// Two grains head on, with dashpots that may pull: of ½ m* v² a share 1 - e² goes into them,
/// e = exp(-πζ/√(1-ζ²)), ζ = γ/(2 √(k m*)).
#[test]
fn a_head_on_impact_loses_to_viscosity_what_restitution_tells() {
    let (stiffness, damping) = (1e9, 780.0);
    let law = smooth(stiffness, damping, Tension::Keep);
    let place = (RADIUS + 1e-9) * DVec3::Z;
    let mut start = state(&[(MIDDLE + place, RADIUS), (MIDDLE - place, RADIUS)], 0);
    start.grains.velocity = vec![-0.5 * DVec3::Z, 0.5 * DVec3::Z];
    let mut model = tests::model(law, &start.grains);
    model.step /= 100.0;
    let reduced = 0.5 * mass(RADIUS);
    let time = 2.0 * PI * (reduced / stiffness).sqrt();
    let end = run(&model, &start, steps_to(time, &model));
    assert!(end.state.contacts.is_empty(), "they have not parted");
    let zeta = 0.5 * damping / (stiffness * reduced).sqrt();
    let restitution = (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
    let expected = 0.5 * reduced * (1.0 - restitution * restitution);
    let off = end.ledger.dissipated_viscosity / expected - 1.0;
    println!("viscous loss off by {off:.1e}");
    // Restitution itself is found to 1e-3 at such steps.
    assert!(off.abs() < 2e-3, "viscous loss off by {off:e}");
    assert_eq!(end.ledger.dissipated_friction, 0.0);
}

/// A grain that cannot turn slides on a floor: friction takes μ m g for each metre.
#[test]
fn a_slide_loses_to_friction_its_force_times_its_way() {
    let (stiffness, coefficient, gravity) = (1e6, 0.4, 10.0);
    let law = Linear {
        sliding: friction(stiffness, coefficient),
        ..smooth(stiffness, 0.0, Tension::Clip)
    };
    let (model, mut start) = resting(law, 0.0, gravity);
    start.grains.constraint[0].rotation_held = true;
    start.grains.velocity[0] = 0.5 * DVec3::X;
    let end = run(&model, &start, steps_to(0.05, &model));
    let limit = coefficient * mass(RADIUS) * gravity;
    let way = end.state.grains.displacement[0].x;
    // The first of the way stretches the spring, the rest is lost.
    let stretch = limit / (2.0 / 7.0 * stiffness);
    let expected = limit * (way - stretch);
    let off = end.ledger.dissipated_friction / expected - 1.0;
    println!("friction off by {off:.1e} over {way:.3} m");
    // Where in its step the slip begins is open: one step of the way.
    let step = 0.5 * model.step / way;
    assert!(off.abs() < step, "friction off by {off:e} of {step:e}");
}

/// Each source of work alone, against a sum over the steps made outside.
#[test]
fn the_drives_work_is_its_force_times_its_way() {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 5).sheared(0.02);
    model.step *= 0.5;
    let Some(dem::Drive::Velocity(speed)) = model.drive else {
        unreachable!("a driven layer")
    };
    let steps = steps_to(5.0, &model);
    let end = run(&model, &start, steps);
    // The grains resist: the drive pushes against the sum of the layer's forces.
    let mean = end.sums.driven_force / steps as f64;
    let expected = -mean * speed * steps as f64 * model.step;
    // The trapezoidal rule differs from the sum in half the first and last force.
    assert!(
        (end.ledger.work_drive / expected - 1.0).abs() < 1e-2,
        "{} and {expected}",
        end.ledger.work_drive
    );
}
