//! The neighbour search finds every pair that touches, for any sizes, through periodic sides,
//! and hands the history on when it is repeated.

use std::collections::BTreeSet;

use dem::contact::{Sliding, Tension};
use dem::{Body, ContactLaw, Domain, Model, Snapshot, State};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tests::bed::Bed;
use tests::packing::{separation, touching_pairs};
use tests::{DENSITY, MIDDLE, RADIUS, friction, run, smooth, solver};

const STIFFNESS: f64 = 1e6;

/// Grains thrown at random into a box, many of which overlap.
fn thrown(count: usize, domain: Domain, height: f64, sizes: [f64; 2], seed: u64) -> (Model, State) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut state = State::default();
    for _ in 0..count {
        let place = DVec3::new(
            random.random_range(0.0..domain.size[0]),
            random.random_range(0.0..domain.size[1]),
            random.random_range(0.0..height),
        );
        // As many grains in each decade: the small are not lost among the large.
        let radius = sizes[0] * (sizes[1] / sizes[0]).powf(random.random_range(0.0..=1.0));
        state.grains.add_sphere(place, radius, DENSITY);
    }
    let mut model = tests::model(smooth(STIFFNESS, 0.0, Tension::Clip), &state.grains);
    model.domain = domain;
    (model, state)
}

fn grain_pairs(snapshot: &Snapshot) -> BTreeSet<(u32, u32)> {
    let pair = |contact: &dem::Contact| match contact.j {
        Body::Grain(j) => Some((contact.i, j)),
        Body::Wall(_) => None,
    };
    snapshot.state.contacts.iter().filter_map(pair).collect()
}

/// The pairs and the forces are those found by looking at every pair.
fn assert_all_found(model: &Model, snapshot: &Snapshot) {
    let grains = &snapshot.state.grains;
    let expected = touching_pairs(grains, &model.domain);
    let found = grain_pairs(snapshot);
    assert_eq!(found.len(), snapshot.state.contacts.len(), "a pair twice");
    assert!(
        expected.len() > grains.len() / 2,
        "{} pairs",
        expected.len()
    );
    assert_eq!(found, expected.iter().copied().collect());

    let mut force = vec![DVec3::ZERO; grains.len()];
    let mut largest: f64 = 0.0;
    for (i, j) in expected.iter().map(|&(i, j)| (i as usize, j as usize)) {
        let d = separation(grains.position[i], grains.position[j], &model.domain);
        let push = STIFFNESS * (grains.radius[i] + grains.radius[j] - d.length()) * d.normalize();
        force[i] += push;
        force[j] -= push;
        largest = largest.max(push.length());
    }
    for (k, (found, force)) in snapshot.force.iter().zip(&force).enumerate() {
        let off = (*found - *force).length();
        assert!(
            off < 1e-10 * largest,
            "grain {k}: force off by {off:e} of {largest:e} N"
        );
    }
}

#[test]
fn every_pair_is_found_for_sizes_of_one_to_ten_and_any_periodic_sides() {
    for periodic in [[true, true], [true, false], [false, true], [false, false]] {
        for (sizes, side, count) in [([1.0, 1.0], 12.0, 600), ([0.3, 3.0], 16.0, 400)] {
            for shape in [[side, side], [6.5 * sizes[1], 2.0 * side]] {
                let domain = Domain {
                    size: shape.map(|s| s * RADIUS),
                    periodic,
                };
                let sizes = sizes.map(|s| s * RADIUS);
                let (model, start) = thrown(count, domain, side * RADIUS, sizes, 1);
                assert_all_found(&model, &solver(&model, &start).snapshot());
            }
        }
    }
}

#[test]
fn no_pair_is_missed_while_grains_fly() {
    let domain = Domain {
        size: [0.12, 0.16],
        periodic: [true, true],
    };
    let (mut model, mut start) = thrown(200, domain, 0.12, [0.3 * RADIUS, 1.5 * RADIUS], 4);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for velocity in &mut start.grains.velocity {
        *velocity = DVec3::from([0, 1, 2].map(|_| random.random_range(-5.0..5.0)));
    }
    model.step *= 0.2;
    let mut solver = solver(&model, &start);
    for _ in 0..20 {
        solver.advance(7).unwrap();
        let now = solver.snapshot();
        let found = grain_pairs(&now);
        let expected = touching_pairs(&now.state.grains, &model.domain);
        assert_eq!(found, expected.into_iter().collect());
    }
    assert!(solver.searches() > 2);
}

/// A grain far larger than the rest touches more grains than any fixed table would hold.
#[test]
fn a_boulder_keeps_hundreds_of_contacts() {
    let mut grains = vec![(MIDDLE, 10.0 * RADIUS)];
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    for k in 0..350 {
        let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / 350.0;
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        grains.push((
            MIDDLE + 10.99 * RADIUS * DVec3::new(r * cos, r * sin, z),
            RADIUS,
        ));
    }
    let start = tests::state(&grains, 0);
    let model = tests::model(smooth(STIFFNESS, 0.0, Tension::Clip), &start.grains);
    let snapshot = solver(&model, &start).snapshot();
    let on_boulder = snapshot
        .state
        .contacts
        .iter()
        .filter(|contact| contact.i == 0);
    assert_eq!(on_boulder.count(), 350);
    assert_all_found(&model, &snapshot);
}

/// The skin decides how often is searched, not what is computed: a bed with a tiny skin, searched
/// at nearly each step, follows that with a large one to round-off grown over a short run.
#[test]
fn history_survives_search_and_reordering() {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 9).sheared(0.1);
    if let ContactLaw::Linear(law) = &mut model.law {
        law.sliding = law.sliding.map(|sliding| Sliding {
            friction_static: 0.7,
            ..sliding
        });
    }
    let sheared = |skin: f64| {
        let mut solver = solver(
            &Model {
                skin: Some(skin),
                ..model.clone()
            },
            &start,
        );
        solver.advance(400).unwrap();
        (solver.snapshot(), solver.searches())
    };
    let (often, many) = sheared(1e-3);
    let (seldom, few) = sheared(0.3);
    assert!(many > 20 && few < many / 10, "{many} and {few} searches");
    let springs = |s: &Snapshot| {
        s.state
            .contacts
            .iter()
            .filter(|c| c.history.spring != DVec3::ZERO)
            .count()
    };
    assert!(springs(&often) > 300, "history is at stake");
    for k in 0..start.grains.len() {
        let way = often.state.grains.displacement[k] - seldom.state.grains.displacement[k];
        assert!(
            way.length() < 1e-10,
            "grain {k} is off by {:e} d",
            way.length()
        );
    }
    assert_eq!(grain_pairs(&often), grain_pairs(&seldom));
    let sliding = |s: &Snapshot| {
        let contacts = s.state.contacts.iter();
        let sliding = contacts.filter(|c| c.history.sliding);
        sliding.map(|c| (c.i, c.j)).collect::<Vec<_>>()
    };
    assert!(sliding(&often).len() > 30, "the flag is at stake");
    assert_eq!(sliding(&often), sliding(&seldom));
}

#[test]
fn a_collision_across_a_periodic_side_is_that_in_the_middle() {
    let law = dem::contact::Linear {
        sliding: friction(STIFFNESS, 0.5),
        ..smooth(STIFFNESS, 5.0, Tension::Clip)
    };
    let side = 0.25;
    let collide = |centre: DVec3| {
        let wrap = |x: DVec3| DVec3::new(x.x.rem_euclid(side), x.y.rem_euclid(side), x.z);
        let half = DVec3::new(0.8, 0.6, 0.0) * (RADIUS * 1.001);
        let grains = [(wrap(centre - half), RADIUS), (wrap(centre + half), RADIUS)];
        let mut start = tests::state(&grains, 0);
        start.grains.velocity = vec![DVec3::new(0.3, 0.5, 0.1), DVec3::new(-0.2, -0.4, 0.0)];
        let mut model = tests::model(law, &start.grains);
        model.domain = Domain {
            size: [side; 2],
            periodic: [true, true],
        };
        run(&model, &start, 200).state.grains
    };
    let middle = collide(DVec3::new(0.5 * side, 0.5 * side, 0.0));
    assert!(middle.angular_velocity[0].length() > 1.0, "they met");
    for centre in [
        DVec3::ZERO,
        DVec3::new(0.0, 0.1, 0.0),
        DVec3::new(0.1, 0.0, 0.0),
    ] {
        let edge = collide(centre);
        for k in 0..2 {
            assert!((edge.displacement[k] - middle.displacement[k]).length() < 1e-12);
            assert!((edge.velocity[k] - middle.velocity[k]).length() < 1e-9);
            let inside = |x: f64| (0.0..side).contains(&x);
            assert!(inside(edge.position[k].x) && inside(edge.position[k].y));
        }
    }
}

/// Displacement counts the way through periodic sides.
#[test]
fn displacement_does_not_wrap() {
    let mut start = tests::state(&[(MIDDLE, RADIUS)], 0);
    start.grains.velocity[0] = DVec3::new(3.0, -2.0, 1.0);
    let mut model = tests::model(smooth(STIFFNESS, 0.0, Tension::Clip), &start.grains);
    model.domain.periodic = [true, true];
    let end = run(&model, &start, tests::steps_to(1.0, &model)).state;
    let way = end.time * DVec3::new(3.0, -2.0, 1.0);
    assert!((end.grains.displacement[0] - way).length() < 1e-9);
    let unwrapped = MIDDLE + way - end.grains.position[0];
    assert!((unwrapped.x - unwrapped.x.round()).abs() < 1e-9 && unwrapped.x.round() == 3.0);
    assert!((unwrapped.y - unwrapped.y.round()).abs() < 1e-9 && unwrapped.y.round() == -2.0);
}
