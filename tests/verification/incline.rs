//! A block on an incline: a grain that may not turn, under tilted gravity.
//!
//! It starts when tan θ passes μ_s, and then accelerates with g (sin θ - μ_d cos θ).

use approx::assert_relative_eq;
use dem::contact::{Linear, Sliding, Tension};
use dem::{Body, Contact, History, Model, Snapshot, State};
use glam::DVec3;
use tests::{GRAVITY, RADIUS, mass, resting, run, smooth, steps_to};

const STIFFNESS: f64 = 1e6;
const TANGENTIAL: f64 = 2.0 / 7.0 * STIFFNESS;
const MU_S: f64 = 0.58;
const MU_D: f64 = 0.47;

fn law() -> Linear {
    Linear {
        sliding: Some(Sliding {
            stiffness: TANGENTIAL,
            damping: 40.0,
            friction_static: MU_S,
            friction_dynamic: MU_D,
        }),
        ..smooth(STIFFNESS, 80.0, Tension::Clip)
    }
}

/// Gravity along and into an incline of slope `tan`.
fn tilted(tan: f64) -> (f64, f64) {
    let cos = 1.0 / (1.0 + tan * tan).sqrt();
    (GRAVITY * tan * cos, GRAVITY * cos)
}

/// Acceleration down an incline of slope `tan` while it slides [m/s²].
fn acceleration(tan: f64) -> f64 {
    let (along, down) = tilted(tan);
    along - MU_D * down
}

/// The block with no load on its tangential spring.
fn block(tan: f64) -> (Model, State) {
    let (along, down) = tilted(tan);
    let (model, mut state) = resting(law(), along, down);
    state.grains.constraint[0].rotation_held = true;
    (model, state)
}

/// The block with its tangential spring in balance with gravity.
fn block_in_balance(tan: f64) -> (Model, State) {
    let (model, mut state) = block(tan);
    let spring = DVec3::X * (mass(RADIUS) * tilted(tan).0 / TANGENTIAL);
    state.contacts = vec![Contact {
        i: 0,
        j: Body::Wall(0),
        history: History {
            spring,
            ..History::default()
        },
        force: DVec3::ZERO,
        overlap: 0.0,
        branch: DVec3::ZERO,
    }];
    (model, state)
}

fn speed(snapshot: &Snapshot) -> f64 {
    snapshot.state.grains.velocity[0].x
}

fn slides(snapshot: &Snapshot) -> bool {
    snapshot.state.contacts[0].history.sliding
}

#[test]
fn a_block_in_balance_stays_just_below_mu_s() {
    let (model, start) = block_in_balance(0.999 * MU_S);
    let end = run(&model, &start, steps_to(0.1, &model));
    assert!(!slides(&end));
    let moved = end.state.grains.displacement[0].x;
    assert!(moved.abs() < 1e-12, "crept {moved} m");
}

#[test]
fn a_block_in_balance_starts_just_above_mu_s_and_slides_with_mu_d() {
    let tan = 1.001 * MU_S;
    let (model, start) = block_in_balance(tan);
    let half = run(&model, &start, steps_to(0.05, &model));
    let end = run(&model, &start, steps_to(0.1, &model));
    assert!(slides(&end));
    let gained = (speed(&end) - speed(&half)) / (end.state.time - half.state.time);
    assert_relative_eq!(gained, acceleration(tan), max_relative = 1e-6);
    // From the start: the elastic slip is all that is missing.
    assert_relative_eq!(
        speed(&end) / end.state.time,
        acceleration(tan),
        max_relative = 1e-2
    );
}

/// Tilted step by step, so that spring and dashpot can follow: the laboratory's experiment.
#[test]
fn a_slowly_tilted_block_starts_at_mu_s() {
    let (_, mut state) = block(0.0);
    let mut started = None;
    for percent in 1..=110 {
        let tan = 0.01 * f64::from(percent) * MU_S;
        let (model, _) = block(tan);
        let now = run(&model, &state, steps_to(0.01, &model));
        // Beyond μ_s it gains a hundredth of a second times g (μ_s - μ_d) at least.
        if speed(&now) > 3e-3 {
            started = Some(percent);
            break;
        }
        state = now.state;
    }
    // Each step of 1 % overshoots by less than itself.
    let started = started.expect("it starts");
    assert!(
        (100..=101).contains(&started),
        "started at {started} % of mu_s"
    );
}

/// The slope lies between both coefficients: the block stays if at rest, goes on if it slides.
#[test]
fn between_mu_d_and_mu_s_rest_and_sliding_both_last() {
    let tan = 0.5 * (MU_D + MU_S);
    let (model, mut start) = block_in_balance(tan);
    let at_rest = run(&model, &start, steps_to(0.1, &model));
    assert!(!slides(&at_rest) && speed(&at_rest).abs() < 1e-9);

    start.grains.velocity[0].x = 0.05;
    let pushed = run(&model, &start, steps_to(0.1, &model));
    assert!(slides(&pushed));
    let gained = (speed(&pushed) - 0.05) / pushed.state.time;
    assert_relative_eq!(gained, acceleration(tan), max_relative = 1e-2);
}

#[test]
fn below_mu_d_a_sliding_block_stops_and_sticks_again() {
    let (tan, thrown) = (0.8 * MU_D, 0.05);
    let (model, mut start) = block_in_balance(tan);
    start.grains.velocity[0].x = thrown;
    let stops_at = -thrown / acceleration(tan);
    let end = run(&model, &start, steps_to(2.0 * stops_at, &model));
    assert!(!slides(&end));
    assert!(speed(&end).abs() < 1e-6 * thrown);
    let way = end.state.grains.displacement[0].x;
    assert_relative_eq!(way, 0.5 * thrown * stops_at, max_relative = 1e-2);
}
