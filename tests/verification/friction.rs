//! Springs, contact by contact: the arms that make the surfaces' velocity, where the spring is left
//! when a contact slides, the plane that it lies in.

use approx::assert_relative_eq;
use dem::contact::{Linear, Sliding, Tension};
use dem::{ContactLaw, Model, State, Surface};
use glam::DVec3;
use tests::bed::Bed;
use tests::{
    MIDDLE, RADIUS, floor, friction, mass, resting, run, smooth, solver, state, steps_to, turning,
};

/// Overlap of a deep contact [m].
const OVERLAP: f64 = 0.1 * RADIUS;
/// Spin of the grains that roll on each other [rad/s].
const SPIN: f64 = 10.0;

/// Slip velocity [m/s] of the only contact in the first step.
fn slip(model: &Model, start: &State) -> f64 {
    let end = run(model, start, 1);
    let [contact] = &end.state.contacts[..] else {
        panic!("one contact, not {}", end.state.contacts.len());
    };
    contact.history.spring.length() / model.step
}

/// Arms of R would see the surfaces slip by the spins times d/2.
fn assert_no_slip(slip: f64, spins: f64) {
    let of_whole_radii = spins * 0.5 * OVERLAP;
    println!("slip {slip:.1e} m/s, with whole radii {of_whole_radii:.1e} m/s");
    // The grains part by 2 % of the overlap in the step.
    assert!(slip < 0.05 * of_whole_radii, "slip {slip:e} m/s");
}

fn sticky() -> Linear {
    Linear {
        sliding: friction(1e6, 1e3),
        ..smooth(1e6, 0.0, Tension::Clip)
    }
}

#[test]
fn a_grain_pressed_into_a_floor_rolls_on_the_arm_r_minus_half_the_overlap() {
    let mut start = state(&[(MIDDLE + (RADIUS - OVERLAP) * DVec3::Z, RADIUS)], 1);
    start.grains.angular_velocity[0] = SPIN * DVec3::Y;
    start.grains.velocity[0] = SPIN * (RADIUS - 0.5 * OVERLAP) * DVec3::X;
    let mut model = tests::model(sticky(), &start.grains);
    model.walls = vec![floor(Surface::Full)];
    assert_no_slip(slip(&model, &start), SPIN);
}

#[test]
fn grains_pressed_into_each_other_roll_on_arms_that_add_up_to_their_distance() {
    let radii = [RADIUS, 1.5 * RADIUS];
    let distance = radii[0] + radii[1] - OVERLAP;
    let places = [MIDDLE + distance * DVec3::Z, MIDDLE];
    let mut start = state(&[(places[0], radii[0]), (places[1], radii[1])], 0);
    start.grains.angular_velocity.fill(SPIN * DVec3::Y);
    start.grains.velocity[0] = SPIN * distance * DVec3::X;
    let model = tests::model(sticky(), &start.grains);
    assert_no_slip(slip(&model, &start), 2.0 * SPIN);
}

/// -k_t ξ - γ_t u is the limit μ_d F_n while the contact slides, so that it sticks at once when
/// the trial force falls below it.
#[test]
fn spring_and_dashpot_of_a_sliding_contact_together_give_the_limit() {
    let (gravity, speed) = (10.0, 0.5);
    let limit = 0.4 * mass(RADIUS) * gravity;
    let sliding = Sliding {
        stiffness: 3e5,
        damping: 0.5 * limit / speed,
        friction_static: 0.6,
        friction_dynamic: 0.4,
    };
    let law = Linear {
        sliding: Some(sliding),
        ..smooth(1e6, 0.0, Tension::Clip)
    };
    let (model, mut start) = resting(law, 0.0, gravity);
    start.grains.constraint[0].rotation_held = true;
    start.grains.velocity[0] = speed * DVec3::X;
    let end = run(&model, &start, steps_to(0.01, &model)).state;
    let contact = &end.contacts[0];
    assert!(contact.history.sliding);
    assert_relative_eq!(contact.force.x, -limit, max_relative = 1e-6);
    let dashpot = sliding.damping * end.grains.velocity[0].x;
    let spring = sliding.stiffness * contact.history.spring.x;
    // The dashpot sees a velocity half a step old.
    assert_relative_eq!(spring + dashpot, limit, max_relative = 1e-3);
}

/// Measuring the forces of the start is no step: a spring that is relaxed stays so.
#[test]
fn the_forces_of_the_start_advance_no_spring() {
    let (model, mut start) = resting(sticky(), 0.0, 10.0);
    start.grains.velocity[0] = 0.01 * DVec3::X;
    let now = solver(&model, &start).snapshot();
    let contact = &now.state.contacts[0];
    assert!(contact.force.z > 0.0);
    assert_eq!((contact.force.x, contact.force.y), (0.0, 0.0));
    assert_eq!(contact.history.spring, DVec3::ZERO);
}

/// Springs are carried with the contact plane, however a dense shear turns it.
#[test]
fn springs_lie_in_the_plane_of_their_contact() {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 3).sheared(0.05);
    let ContactLaw::Linear(law) = &mut model.law else {
        unreachable!("beds have the linear law")
    };
    law.rolling = turning(0.1 * law.normal_stiffness, 0.0, 0.2);
    let end = run(&model, &start, steps_to(2.0, &model));
    let mut seen = [0; 2];
    for contact in &end.state.contacts {
        let normal = contact.branch.normalize();
        let history = contact.history;
        let springs = [history.spring, history.rolling_spring];
        for (seen, spring) in seen.iter_mut().zip(springs) {
            *seen += u32::from(spring != DVec3::ZERO);
            let out_of_plane = spring.dot(normal).abs();
            assert!(out_of_plane <= 1e-12 * spring.length(), "{contact:?}");
        }
    }
    assert!(seen.iter().all(|&n| n > 300), "{seen:?} springs");
}
