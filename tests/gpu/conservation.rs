//! What no contact may change or lose: momentum, angular momentum, energy that the ledger books,
//! and the rotation of a free grain.

use crate::lab::Suite;
use crate::rounding::ROUNDING;
use dem::contact::{Linear, Sliding, Tension};
use dem::{Model, Outside, Snapshot, State, Surface, WallMotion, gpu};
use glam::{DQuat, DVec3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::Device;
use tests::bed::Bed;
use tests::packing::{angular_momentum, momentum};
use tests::{MIDDLE, RADIUS, floor, mass, run, smooth, solver, state, steps_to, turning};

pub fn list(suite: &mut Suite) {
    suite.gpu("momentum_stays_to_the_rounding_of_the_sums", momenta);
    suite.gpu("a_free_grain_turns_as_its_spin_says", free_spin);
    suite.gpu("a_grain_turns_about_an_axis_that_changes", turning_axis);
    suite.gpu("the_ledger_of_a_sheared_bed_closes", ledger);
    suite.gpu("sums_of_a_long_run_do_not_fill", long_sums);
}

const STIFFNESS: f64 = 1e7;

/// 125 grains of three sizes, spinning, that fall together and part again, with the whole law.
fn cloud() -> (Model, State) {
    let law = Linear {
        sliding: Some(Sliding {
            stiffness: 2.0 / 7.0 * STIFFNESS,
            damping: 30.0,
            friction_static: 0.58,
            friction_dynamic: 0.47,
        }),
        rolling: turning(0.1 * STIFFNESS, 5.0, 0.1),
        twisting: turning(0.1 * STIFFNESS, 5.0, 0.1),
        ..smooth(STIFFNESS, 80.0, Tension::Clip)
    };
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut grains = vec![];
    for k in 0..125 {
        let site = DVec3::from([k % 5, k / 5 % 5, k / 25].map(|s| f64::from(s) - 2.0));
        let radius = RADIUS * [0.6, 0.8, 1.0][k as usize % 3];
        grains.push((MIDDLE + 2.1 * RADIUS * site, radius));
    }
    let mut start = state(&grains, 0);
    for k in 0..start.grains.len() {
        let mut vector =
            |size: f64| DVec3::from([0, 1, 2].map(|_| random.random_range(-size..size)));
        let inwards = 10.0 * (MIDDLE - start.grains.position[k]);
        start.grains.velocity[k] = inwards + vector(0.3) + DVec3::new(0.1, -0.2, 0.15);
        start.grains.angular_velocity[k] = vector(40.0);
    }
    let model = tests::model(law, &start.grains);
    (model, start)
}

/// What rounding may do to momentum and angular momentum, from the CPU's run.
///
/// - Sums of forces and dt/m are rounded: a share of the impulses, all of one sign at worst.
/// - Velocities are rounded in each step in which a force acts, up and down by chance: their sum
///   over steps and grains stays within six standard deviations.
/// - The normal is rounded, so that forces do not quite act along the line of centres: a share
///   of the impulses times the radius.
struct RoundOff {
    momentum: f64,
    angular: f64,
}

fn round_off(model: &Model, start: &State, steps: u64) -> RoundOff {
    let mut solver = solver(model, start);
    let (mut impulse, mut squares, mut spins): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for _ in 0..steps {
        solver.advance(1).unwrap();
        let now = solver.snapshot();
        let grains = &now.state.grains;
        for k in 0..grains.len() {
            let force = now.force[k].length();
            impulse += force * model.step;
            if force > 0.0 {
                squares += (grains.mass[k] * grains.velocity[k].length()).powi(2);
                let spin = grains.moment_of_inertia[k] * grains.angular_velocity[k].length();
                spins += spin * spin;
            }
        }
    }
    let chance = |squares: f64| 6.0 * squares.sqrt();
    // Half a dozen roundings of a force before it is a change of velocity.
    let momentum = ROUNDING * (6.0 * impulse + chance(squares));
    let extent = start.grains.position.iter().map(|x| x.length());
    let extent = extent.fold(0.0, f64::max);
    RoundOff {
        momentum,
        angular: extent * momentum + ROUNDING * (6.0 * impulse * RADIUS + chance(spins)),
    }
}

fn momenta(device: &Device) {
    let (model, start) = cloud();
    let steps = steps_to(0.014, &model);
    let allowed = round_off(&model, &start, steps);
    let mut solver = gpu::Solver::new(device, model.clone(), start.clone()).unwrap();
    // Velocities are rounded when they are handed over: count from there.
    let before = solver.snapshot().unwrap();
    let mut worst = [0.0_f64; 2];
    for _ in 0..5 {
        solver.advance(steps / 5).unwrap();
        let now = solver.snapshot().unwrap().state.grains;
        let grains = &before.state.grains;
        let lost = momentum(&now) - momentum(grains);
        worst[0] = worst[0].max(lost.length());
        let lost = angular_momentum(&now) - angular_momentum(grains);
        worst[1] = worst[1].max(lost.length());
    }
    let each = (0..125).map(|k| start.grains.mass[k] * start.grains.velocity[k].length());
    println!(
        "{steps} steps: momentum by {:.1e} of {:.1e} kg m/s (all grains {:.1e}), angular by {:.1e} of {:.1e}",
        worst[0],
        allowed.momentum,
        each.sum::<f64>(),
        worst[1],
        allowed.angular
    );
    assert!(worst[0] < allowed.momentum, "momentum lost");
    assert!(worst[1] < allowed.angular, "angular momentum lost");
    let ledger = solver.snapshot().unwrap().ledger;
    let lost = ledger.dissipated_friction + ledger.dissipated_viscosity + ledger.dissipated_rolling;
    let before = start.grains.kinetic_energy() + start.grains.rotational_energy();
    assert!(lost > 0.1 * before, "the cloud hardly met");
}

/// Slow spins, whose turns are gathered, and fast ones, which are not; over several turns.
fn free_spin(device: &Device) {
    let spins = [0.3, 30.0, 3000.0].map(|size| size * DVec3::new(0.36, -0.48, 0.8));
    let places = [0.0, 1.0, 2.0].map(|k| (MIDDLE + 3.0 * k * RADIUS * DVec3::Z, RADIUS));
    let mut start = state(&places, 0);
    start.grains.angular_velocity = spins.to_vec();
    let law = Linear {
        sliding: tests::friction(1e6, 0.5),
        ..smooth(1e6, 0.0, Tension::Clip)
    };
    let mut model = tests::model(law, &start.grains);
    model.step = 1e-5;
    let steps = 2000;
    let mut solver = gpu::Solver::new(device, model.clone(), start).unwrap();
    solver.advance(steps).unwrap();
    let grains = solver.snapshot().unwrap().state.grains;
    for (k, spin) in spins.iter().enumerate() {
        let by = *spin * steps as f64 * model.step;
        let off = grains.orientation[k] * DQuat::from_scaled_axis(by).inverse();
        let off = off.to_scaled_axis().length();
        // The spin, the step and their product; and each turn of the quaternion by chance up or
        // down, six standard deviations; there is at most one a step.
        let turns = (by.length() * 256.0 * 2.0).min(steps as f64).ceil();
        let allowed = ROUNDING * (3.0 * by.length() + 6.0 * turns.sqrt());
        println!(
            "turned by {:.3} rad: off by {off:.1e} of {allowed:.1e}",
            by.length()
        );
        assert!(off <= allowed, "off by {off:e} of {allowed:e}");
    }
}

/// A torque takes the spin from x to y: rotations do not commute, and their order counts.
fn turning_axis(device: &Device) {
    let mut start = state(&[(MIDDLE, RADIUS)], 0);
    let law = Linear {
        sliding: tests::friction(1e6, 0.5),
        ..smooth(1e6, 0.0, Tension::Clip)
    };
    let mut model = tests::model(law, &start.grains);
    model.step = 1e-5;
    let (steps, spin) = (500, 800.0);
    let inertia = start.grains.moment_of_inertia[0];
    let change = DVec3::new(-spin, spin, 0.0) / steps as f64;
    start.grains.angular_velocity[0] = spin * DVec3::X;
    let mut solver = gpu::Solver::new(device, model.clone(), start).unwrap();
    let torque = [change * inertia / model.step];
    let outside = Outside {
        force: &[DVec3::ZERO],
        torque: &torque,
    };
    solver.advance_with(steps, outside).unwrap();
    let (mut expected, mut angle) = (DQuat::IDENTITY, 0.0);
    for k in 0..steps {
        let by = model.step * (spin * DVec3::X + (k as f64 + 0.5) * change);
        expected = DQuat::from_scaled_axis(by) * expected;
        angle += by.length();
    }
    let found = solver.snapshot().unwrap().state.grains.orientation[0];
    let off = (found * expected.inverse()).to_scaled_axis().length();
    // Each step is more than is gathered; spin and quaternion are rounded by chance up or down.
    let allowed = ROUNDING * (3.0 * angle + 6.0 * (steps as f64).sqrt() * (1.0 + angle));
    println!("turned by {angle:.2} rad: off by {off:.1e} of {allowed:.1e}");
    assert!(off <= allowed, "off by {off:e} of {allowed:e}");
}

/// Under gravity, with the wall's stress modulated, to a strain of 0.1: what the ledger misses
/// is the error of the step, the same on both, and not of the sums.
fn ledger(device: &Device) {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 5).sheared(0.02);
    model.gravity = DVec3::new(0.01, 0.0, -0.05);
    if let WallMotion::Stress(load) = &mut model.walls[1].motion {
        load.amplitude = 0.3;
        load.frequency = 0.2;
    }
    let steps = steps_to(5.0, &model);
    let mut solver = gpu::Solver::new(device, model, start.clone()).unwrap();
    solver.advance(steps).unwrap();
    let share = |s: &Snapshot| s.ledger.residual / s.ledger.work_drive;
    let found = share(&solver.snapshot().unwrap());
    let cpu = share(&run(solver.model(), &start, steps));
    println!("{steps} steps: residual over work of the drive {found:.2e}, on the CPU {cpu:.2e}");
    assert!(found.abs() < 1e-4, "residual over work {found:e}");
}

/// A wall that is pressed by a tenth of k_n R in each of many steps, as the walls of the plane shear
/// and of a million of the poster's grains are.
fn long_sums(device: &Device) {
    let overlap = 0.1 * RADIUS;
    let (stiffness, place) = (1e6, RADIUS - overlap);
    let mut start = state(&[(MIDDLE + place * DVec3::Z, RADIUS)], 1);
    start.grains.velocity[0] = DVec3::ZERO;
    let mut model = tests::model(smooth(stiffness, 0.0, Tension::Clip), &start.grains);
    model.walls = vec![floor(Surface::Frictionless)];
    let force = stiffness * overlap;
    model.gravity = -force / mass(RADIUS) * DVec3::Z;
    let steps = 100_000;
    let mut solver = gpu::Solver::new(device, model, start).unwrap();
    for _ in 0..10 {
        solver.advance(steps / 10).unwrap();
    }
    let mean = solver.snapshot().unwrap().sums.wall_force[0] / steps as f64;
    assert!((mean / force - 1.0).abs() < 1e-5, "{mean} N of {force} N");
}
