//! One machine, one result: the same bits for any number of threads, however often the solver is
//! read, and whether or not it was stopped.

use dem::contact::{Linear, Sliding};
use dem::{Body, ContactLaw, Model, Snapshot, State};
use glam::DVec3;
use tests::bed::Bed;
use tests::{run, solver_on, turning};

/// A sheared bed of the whole law. Dashpots at the slider leave springs stretched where a contact
/// parts, so that the order in which their energy is booked is at stake as well.
fn case() -> (Model, State) {
    let (mut model, start) = Bed::new(600, 6.0, 0.5, 11).sheared(0.05);
    model.gravity = DVec3::new(0.0, 0.0, -0.01);
    let law = law(&mut model);
    law.sliding = law.sliding.map(|sliding| Sliding {
        friction_static: 0.7,
        damping: 0.3 * law.normal_damping,
        ..sliding
    });
    (model, start)
}

/// The same with resistance to rolling and twisting.
fn turning_case() -> (Model, State) {
    let (mut model, start) = case();
    let law = law(&mut model);
    let (stiffness, damping) = (0.1 * law.normal_stiffness, 0.1 * law.normal_damping);
    law.rolling = turning(stiffness, damping, 0.1);
    law.twisting = turning(stiffness, damping, 0.1);
    (model, start)
}

fn law(model: &mut Model) -> &mut Linear {
    match &mut model.law {
        ContactLaw::Linear(law) => law,
        ContactLaw::LinearLammps(_) => unreachable!("beds have the linear law"),
    }
}

/// All bits: a comparison by value would take -0 for 0.
fn bits(snapshot: &Snapshot) -> String {
    format!("{snapshot:?}")
}

fn assert_same(a: &Snapshot, b: &Snapshot, what: &str) {
    assert!(
        a.state.grains.position.iter().all(|x| x.is_finite()),
        "the numbers ran away"
    );
    assert!(a.state.contacts.len() > 500, "the bed fell apart");
    assert!(bits(a) == bits(b), "{what}");
}

fn after(steps: u64, threads: usize) -> Snapshot {
    run_on(&case(), steps, threads)
}

fn run_on((model, start): &(Model, State), steps: u64, threads: usize) -> Snapshot {
    let mut solver = solver_on(model, start, threads);
    solver.advance(steps).unwrap();
    solver.snapshot()
}

/// The ledger first, which names the entry that differs.
fn assert_same_on_threads(case: &(Model, State)) {
    let one = run_on(case, 3000, 1);
    assert!(one.ledger.dissipated_friction > 0.0, "nothing slides");
    let entries = |s: &Snapshot| format!("{:?}", s.ledger);
    for threads in [2, 3, 7] {
        let other = run_on(case, 3000, threads);
        assert_eq!(entries(&one), entries(&other), "{threads} threads");
        assert_same(&one, &other, &format!("{threads} threads differ from one"));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    assert_same_on_threads(&case());
}

#[test]
fn any_number_of_threads_gives_the_same_bits_with_rolling_resistance() {
    assert_same_on_threads(&turning_case());
}

#[test]
fn a_repeated_run_gives_the_same_bits() {
    assert_same(&after(3000, 2), &after(3000, 2), "a second run differs");
}

#[test]
fn reading_often_does_not_change_the_trajectory() {
    let (model, start) = case();
    let mut solver = solver_on(&model, &start, 2);
    for _ in 0..430 {
        solver.advance(7).unwrap();
        let _ = solver.snapshot();
        let _ = solver.snapshot();
    }
    assert_same(
        &after(3010, 2),
        &solver.snapshot(),
        "reading changed the trajectory",
    );
}

#[test]
fn two_advances_are_one_advance() {
    let (model, start) = case();
    let mut solver = solver_on(&model, &start, 2);
    solver.advance(1700).unwrap();
    solver.advance(0).unwrap();
    solver.advance(1300).unwrap();
    assert_same(&after(3000, 2), &solver.snapshot(), "the cut is seen");
}

/// At a phase's end the solver is made anew from the state, whether the program stopped or not.
#[test]
fn going_on_from_a_state_gives_the_same_bits_on_any_number_of_threads() {
    let (model, _) = case();
    let saved = after(1500, 2).state;
    let on = |threads| {
        let mut solver = solver_on(&model, &saved, threads);
        solver.advance(1500).unwrap();
        solver.snapshot()
    };
    let first = on(1);
    assert_same(&first, &on(2), "going on differs with the threads");
    assert_same(&first, &on(1), "going on twice differs");
}

/// Nothing of the state is lost or changed by handing it on: springs, flags and places come back.
#[test]
fn a_new_solver_holds_the_state_it_was_given() {
    let (model, start) = case();
    let saved = run(&model, &start, 1500).state;
    let sliding = saved.contacts.iter().filter(|c| c.history.sliding).count();
    assert!(sliding > 20, "only {sliding} contacts slide");
    let held = solver_on(&model, &saved, 1).snapshot().state;
    let way = |state: &State, k: usize| state.grains.displacement[k];
    assert_eq!(held.contacts.len(), saved.contacts.len());
    let springs = saved
        .contacts
        .iter()
        .filter(|c| c.history.spring != DVec3::ZERO)
        .count();
    assert!(springs > 300, "history is at stake");
    for (held, saved) in held.contacts.iter().zip(&saved.contacts) {
        assert_eq!((held.i, held.j), (saved.i, saved.j));
        let stretched = (held.history.spring - saved.history.spring).length();
        assert_eq!(stretched, 0.0);
        assert_eq!(held.history.sliding, saved.history.sliding);
    }
    for k in 0..saved.grains.len() {
        let change = held.grains.velocity[k] - saved.grains.velocity[k];
        assert!(change.length() < 1e-14);
        assert!(held.grains.position[k] == saved.grains.position[k]);
        assert!((way(&held, k) - way(&saved, k)).length() < 1e-14);
        let turned = held.grains.orientation[k].angle_between(saved.grains.orientation[k]);
        assert!(turned < 1e-7, "turned by {turned}");
    }
}

/// Energy [J] of what a cut does to the motion. The dashpots of the first evaluation see
/// velocities of whole steps, half a step later than without the cut: their force is off by
/// γ h/2 times the acceleration a of the surfaces against each other, half a step long.
fn energy_of_a_cut(model: &Model, at: &Snapshot) -> f64 {
    let grains = &at.state.grains;
    let half = 0.5 * model.step;
    let acceleration = |k: usize| {
        let turning = at.torque[k].length() / grains.moment_of_inertia[k] * grains.radius[k];
        at.force[k].length() / grains.mass[k] + turning
    };
    let mut impulse = vec![0.0; grains.len()];
    for contact in &at.state.contacts {
        let i = contact.i as usize;
        let j = match contact.j {
            Body::Grain(j) => Some(j as usize),
            Body::Wall(_) => None,
        };
        let relative = acceleration(i) + j.map_or(0.0, acceleration);
        for k in [Some(i), j].into_iter().flatten() {
            impulse[k] += half * model.law.normal_damping() * half * relative;
        }
    }
    // Of translation and, with the moment of inertia of a sphere, of rotation.
    let each = |k: usize| 0.5 * (1.0 + 2.5) * impulse[k].powi(2) / grains.mass[k];
    (0..grains.len()).map(each).sum()
}

/// Springs, dashpots and sliders only spread or consume what a cut adds to the motion: at the worst
/// all of its energy meets in the lightest grain and carries it the whole time. Lost springs
/// would move grains by the square of the time, 1e-2 d.
#[test]
fn a_cut_is_small_in_the_trajectory() {
    let (model, _) = case();
    let whole = after(1600, 1);
    let at = after(1500, 1);
    let mut solver = solver_on(&model, &at.state, 1);
    solver.advance(100).unwrap();
    let cut = solver.snapshot();
    let off = |k: usize| {
        let grains = [&whole, &cut].map(|s| s.state.grains.displacement[k]);
        (grains[0] - grains[1]).length()
    };
    let worst = (0..whole.state.grains.len()).map(off).fold(0.0, f64::max);
    let lightest = at
        .state
        .grains
        .mass
        .iter()
        .fold(f64::INFINITY, |a, &b| a.min(b));
    let fastest = (2.0 * energy_of_a_cut(&model, &at) / lightest).sqrt();
    let allowed = fastest * 100.0 * model.step;
    println!("a grain is off by {worst:.1e} d of {allowed:.1e} d");
    assert!(allowed < 1e-3, "the bound {allowed:e} d tells nothing");
    assert!(worst < allowed, "off by {worst:e} d of {allowed:e} d");
}

#[test]
fn the_clock_counts_steps() {
    let (model, mut start) = case();
    start.time = 7.0;
    let end = run(&model, &start, 3000);
    let expected = 7.0 + 3000.0 * model.step;
    assert!((end.state.time / expected - 1.0).abs() < 1e-14);
    assert_eq!(end.sums.steps, 3000);
}
