//! What needs no device: structs of the time step lie alike on both sides, and every
//! composition that a scene can ask for is valid.

use super::arrays::Parts;
use super::fixed::Place;
use super::numbers::flags;
use super::scene::{Body, Motion, Own, Scene, WallScene};
use crate::contact::{Linear, LinearLammps, Sliding, Tension, Turning};
use crate::{ContactLaw, Domain, Model};
use glam::DVec3;
use rayon::prelude::*;
use shaders::naga::Module;
use shaders::naga::valid::{Capabilities, ValidationFlags, Validator};
use shaders::{Flags, compose, layout};
use std::mem::offset_of;

fn laws() -> [ContactLaw; 4] {
    let turning = Turning {
        stiffness: 1e5,
        damping: 1.0,
        friction: 0.1,
    };
    let sliding = Sliding {
        stiffness: 1e6,
        damping: 1.0,
        friction_static: 0.5,
        friction_dynamic: 0.4,
    };
    let linear = |sliding, turning| {
        ContactLaw::Linear(Linear {
            normal_stiffness: 1e6,
            normal_damping: 1.0,
            tension: Tension::Clip,
            sliding,
            rolling: turning,
            twisting: turning,
        })
    };
    let lammps = LinearLammps {
        normal_stiffness: 1e6,
        normal_damping: 1.0,
        tangential_stiffness: 1e6,
        tangential_damping: 1.0,
        friction: 0.5,
    };
    [
        linear(None, None),
        linear(Some(sliding), None),
        linear(Some(sliding), Some(turning)),
        ContactLaw::LinearLammps(lammps),
    ]
}

fn model(law: ContactLaw, ledger: bool) -> Model {
    Model {
        domain: Domain {
            size: [1.0; 2],
            periodic: [true; 2],
        },
        gravity: DVec3::ZERO,
        law,
        walls: Vec::new(),
        drive: None,
        step: 1e-6,
        skin: None,
        ledger,
    }
}

/// The flags of every scene, and words for messages.
fn scenes() -> Vec<(String, Flags)> {
    let mut scenes = Vec::new();
    for law in laws() {
        for bits in 0..16u32 {
            let bit = |k: u32| bits >> k & 1 == 1;
            let (ledger, full_walls, shear_stress, shared) = (bit(0), bit(1), bit(2), bit(3));
            if full_walls && !law.slides() {
                continue;
            }
            let parts = Parts {
                grains: 10,
                walls: if full_walls { 2 } else { bits as usize % 3 },
                slides: law.slides(),
                turns: law.turns(),
                ledger,
                full_walls,
                shear_stress,
                companion: (bits & !1 == 0).then_some(1),
            };
            let lanes = if shared { 4 } else { 1 };
            let flags = flags(&model(law, ledger), &parts, lanes);
            scenes.push((format!("{law:?}, {parts:?}, {lanes} lanes"), flags));
        }
    }
    scenes
}

/// Validate with no capability: what every device has.
fn validate(what: &str, module: &Module) {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    if let Err(error) = validator.validate(module) {
        panic!("{what}: {}", error.emit_to_string(""));
    }
}

#[test]
fn every_time_step_that_a_scene_can_ask_for_is_valid() {
    scenes().into_par_iter().for_each(|(scene, flags)| {
        // The step, with forces from outside, and a reading.
        let variants = [
            flags.clone(),
            flags.clone().set("OUTSIDE"),
            flags.clone().set("READ").set("APART"),
            flags.set("LOADS"),
        ];
        for flags in variants {
            let what = format!("{scene}, {flags:?}");
            let module = compose("dem/step.wgsl", &flags);
            validate(
                &what,
                &module.unwrap_or_else(|error| panic!("{what}: {error}")),
            );
        }
    });
}

#[test]
fn structs_of_the_time_step_lie_alike_on_both_sides() {
    let (_, flags) = scenes().pop().unwrap();
    let module = compose("dem/step.wgsl", &flags).unwrap();
    macro_rules! same {
        ($rust:ty, $($member:ident),*) => {
            let name = stringify!($rust);
            let (size, found) = layout::of(&module, name).unwrap_or_else(|| panic!("no {name}"));
            let expected = vec![
                $((stringify!($member).to_string(), offset_of!($rust, $member) as u32)),*
            ];
            assert_eq!(found, expected, "{name}");
            assert_eq!(size as usize, size_of::<$rust>(), "{name}");
        };
    }
    same!(Place, hi, radius_hi, lo, radius_lo);
    same!(Motion, velocity, radius, spin, id);
    same!(Own, kick, twist, flags, image);
    same!(Body, offset, velocity, unused);
    same!(
        Scene,
        law,
        gravity,
        step,
        length,
        unit,
        count,
        way,
        force_scale,
        energy_scale,
        drive_velocity,
        drive_force,
        drive_kick,
        part,
        parts,
        work_scale,
        unused_a,
        unused_b,
        walls
    );
    // Pairs of words on one side are two numbers on the other.
    let (size, found) = layout::of(&module, "WallScene").unwrap();
    assert_eq!(size as usize, size_of::<WallScene>());
    let at = |name: &str| found.iter().find(|(n, _)| n == name).unwrap().1 as usize;
    for (name, offset) in [
        ("axis", offset_of!(WallScene, axis)),
        ("side", offset_of!(WallScene, side)),
        ("kick", offset_of!(WallScene, kick)),
        ("damping", offset_of!(WallScene, damping)),
        ("push", offset_of!(WallScene, push)),
        ("amplitude", offset_of!(WallScene, amplitude)),
        ("turn_hi", offset_of!(WallScene, turn)),
        ("turn_lo", offset_of!(WallScene, turn) + 4),
        ("start_hi", offset_of!(WallScene, start)),
        ("start_lo", offset_of!(WallScene, start) + 4),
        ("full", offset_of!(WallScene, full)),
    ] {
        assert_eq!(at(name), offset, "{name}");
    }
}
