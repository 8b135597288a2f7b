//! States come back as they were.

use super::*;
use crate::output::provenance;
use crate::protocol::PastWater;
use dem::{Body, Constraint, Contact, History, Horizontal};
use glam::{DQuat, DVec3};
use std::fs;

/// Two grains and a wall with every field different, and numbers that a detour through
/// text or single precision would change.
fn saved() -> Saved {
    let mut state = State {
        time: 0.1 + 0.2,
        walls: vec![WallState {
            offset: -0.35,
            velocity: -0.0,
        }],
        ..State::default()
    };
    let grains = &mut state.grains;
    for k in 0..2 {
        let x = f64::from(k) + 1.0 / 3.0;
        grains.add_sphere(DVec3::new(x, f64::MIN_POSITIVE / 4.0, -x), 0.1 * x, 2600.0);
        let k = k as usize;
        grains.displacement[k] = DVec3::new(7.0, 8.0, 9.0) / x;
        grains.velocity[k] = DVec3::new(1e-300, 2.0, -3.0) / x;
        grains.angular_velocity[k] = DVec3::new(4.0, 5.0, 6.0) / x;
        grains.orientation[k] = DQuat::from_rotation_x(x);
    }
    grains.id.swap(0, 1);
    grains.constraint[1] = Constraint {
        horizontal: Horizontal::Driven,
        rotation_held: true,
    };
    let contact = |j, x: f64| Contact {
        i: 0,
        j,
        history: History {
            spring: DVec3::new(1.0, 2.0, 3.0) / x,
            rolling_spring: DVec3::new(4.0, 5.0, 6.0) / x,
            twisting_spring: 7.0 / x,
            sliding: x > 4.0,
        },
        force: DVec3::new(8.0, 9.0, 10.0) / x,
        overlap: 11.0 / x,
        branch: DVec3::new(12.0, 13.0, 14.0) / x,
    };
    state.contacts = vec![contact(Body::Grain(1), 3.0), contact(Body::Wall(0), 7.0)];
    let reference = Reference {
        time: 1.0 / 7.0,
        height: 2.0 / 7.0,
        way: -3.0 / 7.0,
        strain: 4.0 / 7.0,
    };
    let unfinished = Some(Unfinished {
        phase: "scherung-süd".into(),
        reference,
    });
    let past = Past {
        strain: 5.0 / 7.0,
        unfinished,
        water: Some(PastWater {
            cells: [2, 1, 1],
            state: coupling::State {
                pressure: vec![-0.1, 1e-310],
                flux: vec![[1.0 / 3.0, -2.0, 0.5], [1e300, 0.1, -0.0]],
                vapour: vec![0.0, 1.0 / 9.0],
                loads: vec![0.1, 1.0 / 11.0],
            },
            stiffness: Some(1e8 / 3.0),
        }),
    };
    let domain = Domain {
        size: [1.0 / 3.0, 2.0 / 3.0],
        periodic: [true, false],
    };
    Saved {
        state,
        domain,
        past,
    }
}

fn empty() -> Saved {
    Saved {
        state: State::default(),
        past: Past::default(),
        ..saved()
    }
}

fn header() -> Header {
    Header {
        title: "a pair".into(),
        scene: "seed = 7\n".into(),
        seed: Some(7),
        backend: "cpu",
        device: "a processor".into(),
    }
}

#[test]
fn every_bit_of_a_state_comes_back() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("state.h5");
    let saved = saved();
    save(&path, &saved, &header()).unwrap();
    let back = load(&path).unwrap();
    assert_eq!(back, saved);
    // == does not see the sign of a zero.
    assert_eq!(back.state.walls[0].velocity.to_bits(), (-0.0_f64).to_bits());
    let names: Vec<_> = fs::read_dir(&dir).unwrap().collect();
    assert_eq!(names.len(), 1, "nothing is left beside the state");
}

#[test]
fn a_state_without_grains_and_contacts_comes_back() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("state.h5");
    save(&path, &empty(), &header()).unwrap();
    assert_eq!(load(&path).unwrap(), empty());
}

#[test]
fn saving_replaces_an_older_state() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("state.h5");
    save(&path, &empty(), &header()).unwrap();
    save(&path, &saved(), &header()).unwrap();
    assert_eq!(load(&path).unwrap(), saved());
}

#[test]
fn a_state_tells_where_it_comes_from() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("state.h5");
    save(&path, &saved(), &header()).unwrap();
    let file = File::open(&path).unwrap();
    let text = |name: &str| {
        let attribute = file.attr(name).unwrap();
        let text = attribute.read_scalar::<VarLenUnicode>().unwrap();
        text.to_string()
    };
    assert_eq!(text("scene"), "seed = 7\n");
    assert_eq!(text("title"), "a pair");
    assert_eq!(text("version"), provenance::VERSION);
    assert_eq!(text("commit"), provenance::COMMIT);
    assert_eq!(text("machine"), provenance::machine());
    let seed = file.attr("seed").unwrap();
    assert_eq!(seed.read_scalar::<u64>().unwrap(), 7);
}

#[test]
fn a_file_that_is_no_state_is_refused_with_its_name() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("other.h5");
    File::create(&path).unwrap().close().unwrap();
    let error = format!("{:#}", load(&path).unwrap_err());
    assert!(
        error.contains("other.h5") && error.contains("not a state"),
        "{error}"
    );
}

#[test]
fn a_contact_with_a_grain_that_is_not_there_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("state.h5");
    let mut saved = saved();
    saved.state.contacts[0].j = Body::Grain(2);
    save(&path, &saved, &header()).unwrap();
    let error = format!("{:#}", load(&path).unwrap_err());
    assert!(error.contains("joins 0 and 2"), "{error}");
}
