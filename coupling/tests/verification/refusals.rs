//! What is refused or warned of, and with which words.

use crate::bed::*;
use coupling::{Coupled, Model, Permeability, Resistance};
use dem::WallMotion;

/// What makes a description impossible.
type Spoil = fn(&mut dem::Model, &mut Model);

fn refusal(grains: dem::Model, water: Model) -> String {
    match Coupled::<3>::new(grains, pressed(), water, None, 1) {
        Ok(_) => panic!("it was not refused"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn an_interval_that_invents_strength_is_refused_and_a_long_one_warned_of() {
    let mut long = water(1e-10);
    long.interval = Some(64);
    let said = refusal(model(law(), STRESS), long);
    assert!(
        said.contains("invents strength") && said.contains("give an interval of 1 steps"),
        "{said}"
    );
    let mut longish = water(1e-12);
    longish.interval = Some(64);
    let bed = Coupled::<3>::new(model(law(), STRESS), pressed(), longish, None, 1).unwrap();
    let warnings = bed.report().warnings();
    assert!(
        warnings.len() == 1 && warnings[0].contains("cells²"),
        "{warnings:?}"
    );
}

#[test]
fn an_exchange_that_feeds_waves_or_does_not_fit_is_refused() {
    let mut long = water(1e-12);
    long.exchange = Some(4);
    let said = refusal(model(law(), STRESS), long.clone());
    assert!(
        said.contains("feeds waves") && said.contains("give an exchange of 2 steps"),
        "{said}"
    );
    long.exchange = Some(2);
    long.interval = Some(3);
    let said = refusal(model(law(), STRESS), long);
    assert!(said.contains("no multiple of an exchange of 2"), "{said}");
}

/// S M = 1.6 of stiff grains and real water: ten times softer, it takes 6 % of a load, not 38 %.
#[test]
fn water_softened_until_it_changes_the_answer_is_refused_and_told_before() {
    let softened = |times: f64, stiffness: f64| {
        let mut water = water(1e-12);
        water.fluid.compressibility = times * lbm::Fluid::COLD_WATER.compressibility;
        water.stiffness = Some(stiffness);
        water
    };
    let said = refusal(model(law(), STRESS), softened(10.0, 8e9));
    assert!(
        said.contains("10.0 times softer") && said.contains("5.8 % of a load"),
        "{said}"
    );
    // Soft grains bear it longer.
    for (times, parts) in [(1.0, 0), (3.0, 0), (10.0, 1)] {
        let water = softened(times, 2e8);
        let bed = Coupled::<3>::new(model(law(), STRESS), pressed(), water, None, 1).unwrap();
        let warnings = bed.report().warnings();
        assert_eq!(warnings.len(), parts, "{times}: {warnings:?}");
        assert!(warnings.iter().all(|w| w.contains("at once instead of 96")));
    }
    // Where nothing is known of the skeleton, nothing can be said.
    let mut unknown = softened(10.0, 8e9);
    unknown.stiffness = None;
    assert!(Coupled::<3>::new(model(law(), STRESS), pressed(), unknown, None, 1).is_ok());
}

#[test]
fn boxes_and_beds_that_cannot_hold_the_water_are_refused() {
    let cases: [(&str, Spoil); 6] = [
        ("periodic along x and y", |grains, _| {
            grains.domain.periodic[1] = false
        }),
        ("gravity must be along z", |grains, _| {
            grains.gravity.x = 0.1
        }),
        ("at least 3", |_, water| water.cells[2] = 2),
        ("not square: give 5 along y", |_, water| water.cells[1] = 6),
        ("must be positive", |_, water| {
            water.resistance = Resistance::Darcy(Permeability::constant(-1.0));
        }),
        ("a bottom and a top", |grains, _| {
            grains.walls[1].normal = glam::DVec3::X
        }),
    ];
    for (part, spoil) in cases {
        let (mut grains, mut water) = (model(law(), STRESS), water(1e-12));
        grains.walls[1].motion = WallMotion::Held;
        spoil(&mut grains, &mut water);
        let said = refusal(grains, water);
        assert!(said.contains(part), "{said}");
    }
}
