//! The solver beside the CPU's: every law, wall, side, drive and load, from states with history,
//! after some steps, and again in a second phase.

use crate::beside::{Way, compare, compare_as};
use crate::lab::Suite;
use dem::contact::{Linear, LinearLammps, Sliding, Tension};
use dem::{ContactLaw, Drive, Model, State, StressLoad, Surface, Wall, WallMotion, WallState};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::Device;
use tests::bed::Bed;
use tests::{friction, smooth, solver, turning};

pub fn list(suite: &mut Suite) {
    suite.gpu("beside_the_cpu_frictionless", frictionless);
    suite.gpu("beside_the_cpu_friction_driven_at_a_velocity", driven);
    suite.gpu("beside_the_cpu_without_a_ledger", without_ledger);
    suite.gpu("beside_the_cpu_pulling_and_sliding", pulling);
    suite.gpu("beside_the_cpu_turning_under_a_shear_stress", turning_bed);
    suite.gpu("beside_the_cpu_turning_at_rough_walls", turning_walls);
    suite.gpu("beside_the_cpu_as_lammps", as_lammps);
    suite.gpu("beside_the_cpu_between_side_walls", between_side_walls);
    suite.gpu("beside_the_cpu_in_a_closed_box", closed_box);
    suite.gpu("beside_the_cpu_radii_of_1_to_10", many_radii);
    suite.gpu("beside_the_cpu_several_threads_a_grain", shared);
    suite.gpu("beside_the_cpu_pushed_from_outside", pushed);
}

/// What `steps` steps on the CPU make of a case: contacts with a history.
///
/// Walls under stress lose their damping: at the start of a phase the CPU evaluates it at a
/// velocity half a step behind, the GPU at that of the state, a difference of second order.
fn aged(mut model: Model, state: &State, steps: u64) -> (Model, State) {
    for wall in &mut model.walls {
        if let WallMotion::Stress(load) = &mut wall.motion {
            load.damping = 0.0;
        }
    }
    let mut solver = solver(&model, state);
    solver.advance(steps).unwrap();
    let state = solver.snapshot().state;
    assert!(state.contacts.len() > 100, "{}", state.contacts.len());
    (model, state)
}

fn bed() -> Bed {
    Bed::new(150, 5.0, 0.5, 3)
}

fn linear(model: &mut Model) -> &mut Linear {
    match &mut model.law {
        ContactLaw::Linear(law) => law,
        ContactLaw::LinearLammps(_) => unreachable!("beds have the linear law"),
    }
}

fn load(model: &mut Model) -> &mut StressLoad {
    match &mut model.walls[1].motion {
        WallMotion::Stress(load) => load,
        _ => unreachable!("beds have a wall under stress"),
    }
}

fn wall(name: &str, normal: DVec3, surface: Surface) -> Wall {
    Wall {
        name: name.into(),
        normal,
        surface,
        motion: WallMotion::Held,
    }
}

/// Grains without friction, gravity tilted, the stress modulated.
fn frictionless(device: &Device) {
    let (mut model, state) = bed().compressed();
    model.gravity = DVec3::new(0.02, -0.01, -0.1);
    linear(&mut model).sliding = None;
    let load = load(&mut model);
    load.amplitude = 0.5;
    load.frequency = 0.9;
    let (model, state) = aged(model, &state, 100);
    compare(device, &model, &state);
}

/// The bed of the plane shear, with a search every few steps.
fn sheared() -> (Model, State) {
    let (mut model, state) = bed().sheared(0.05);
    model.skin = Some(0.005);
    aged(model, &state, 500)
}

fn driven(device: &Device) {
    let (model, state) = sheared();
    compare(device, &model, &state);
}

/// Several threads a grain, as hardware is given where grains are few.
fn shared(device: &Device) {
    for lanes in [2, 8] {
        let (model, state) = sheared();
        let lanes = Some(lanes);
        compare_as(
            Way {
                lanes,
                ..Way::default()
            },
            device,
            &model,
            &state,
        );
        let (model, state) = turning_case();
        compare_as(
            Way {
                lanes,
                ..Way::default()
            },
            device,
            &model,
            &state,
        );
    }
}

/// Under forces from outside, which change, also on held and driven grains.
fn pushed(device: &Device) {
    let way = Way {
        pushed: true,
        ..Way::default()
    };
    let (model, state) = sheared();
    compare_as(way, device, &model, &state);
    let (model, state) = turning_case();
    compare_as(way, device, &model, &state);
}

fn without_ledger(device: &Device) {
    let (mut model, state) = sheared();
    model.ledger = false;
    compare(device, &model, &state);
}

/// Static above dynamic friction, dashpots along both directions, tension kept, rough walls,
/// gravity tilted.
fn pulling(device: &Device) {
    let (mut model, state) = bed().sheared(0.05);
    let law = linear(&mut model);
    law.tension = Tension::Keep;
    law.sliding = Some(Sliding {
        stiffness: 300.0,
        damping: 0.3 * law.normal_damping,
        friction_static: 0.58,
        friction_dynamic: 0.47,
    });
    model.gravity = DVec3::new(0.1, 0.05, -0.2);
    model.walls[0].surface = Surface::Full;
    let (model, state) = aged(model, &state, 500);
    compare(device, &model, &state);
}

fn turns(law: &mut Linear) {
    let (stiffness, damping) = (0.1 * law.normal_stiffness, 0.1 * law.normal_damping);
    law.rolling = turning(stiffness, damping, 0.05);
    law.twisting = turning(stiffness, damping, 0.03);
}

/// The layer is driven by a shear stress.
fn turning_case() -> (Model, State) {
    let (mut model, state) = bed().sheared(0.05);
    turns(linear(&mut model));
    model.drive = Some(Drive::ShearStress(0.8));
    aged(model, &state, 500)
}

fn turning_bed(device: &Device) {
    let (model, state) = turning_case();
    compare(device, &model, &state);
}

/// No layers: grains slide down the floor and along the wall above, both rough; a floor that moves.
fn turning_walls(device: &Device) {
    let (mut model, state) = bed().compressed();
    turns(linear(&mut model));
    model.gravity = DVec3::new(0.3, 0.1, -0.2);
    for wall in &mut model.walls {
        wall.surface = Surface::Full;
    }
    model.walls[0].motion = WallMotion::Velocity(0.01);
    let (model, state) = aged(model, &state, 500);
    compare(device, &model, &state);
}

/// The law as LAMMPS computes it, a wall that moves and a rough floor.
fn as_lammps(device: &Device) {
    let (mut model, state) = bed().sheared(0.05);
    let law = *linear(&mut model);
    model.law = ContactLaw::LinearLammps(LinearLammps {
        normal_stiffness: law.normal_stiffness,
        normal_damping: law.normal_damping,
        tangential_stiffness: 0.3 * law.normal_stiffness,
        tangential_damping: 0.5 * law.normal_damping,
        friction: 0.5,
    });
    model.gravity = DVec3::new(0.0, 0.0, -0.1);
    model.walls[0].surface = Surface::Full;
    model.walls[1].motion = WallMotion::Velocity(0.02);
    let (model, state) = aged(model, &state, 500);
    compare(device, &model, &state);
}

/// Walls across y, periodic along x.
fn between_side_walls(device: &Device) {
    let (mut model, mut state) = bed().sheared(0.05);
    model.domain.periodic = [true, false];
    add_sides(&mut model, &mut state, DVec3::Y, Surface::Full);
    let (model, state) = aged(model, &state, 500);
    compare(device, &model, &state);
}

/// Walls on all sides, and gravity towards a corner.
fn closed_box(device: &Device) {
    let (mut model, mut state) = bed().compressed();
    model.domain.periodic = [false, false];
    model.gravity = DVec3::new(-0.1, 0.1, -0.2);
    add_sides(&mut model, &mut state, DVec3::X, Surface::Frictionless);
    add_sides(&mut model, &mut state, DVec3::Y, Surface::Full);
    let (model, state) = aged(model, &state, 4000);
    compare(device, &model, &state);
}

/// Walls across `axis`, so that all grains of a bed that was periodic are inside.
fn add_sides(model: &mut Model, state: &mut State, axis: DVec3, surface: Surface) {
    let size = bed().side;
    for (name, normal) in [("low", axis), ("high", -axis)] {
        model.walls.push(wall(name, normal, surface));
        state.walls.push(WallState {
            offset: if normal == axis { -0.55 } else { -size - 0.55 },
            velocity: 0.0,
        });
    }
    // Contacts through the sides that are now closed.
    let grains = &state.grains;
    state.contacts.retain(|c| match c.j {
        dem::Body::Grain(j) => {
            let (i, j) = (c.i as usize, j as usize);
            let reach = grains.radius[i] + grains.radius[j];
            grains.position[i].distance(grains.position[j]) < reach
        }
        dem::Body::Wall(_) => true,
    });
}

/// Log-normal radii, the largest ten times the smallest, thrown into a periodic box and fallen
/// onto its floor.
fn many_radii(device: &Device) {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let radii = (0..200).map(|_| {
        // A sum of twelve is normal enough.
        let normal = (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
        0.5 * (0.9 * normal).exp()
    });
    let mut radii: Vec<f64> = radii.map(|r| r.clamp(0.12, 1.2)).collect();
    radii.sort_by(|a, b| b.total_cmp(a));
    let side = 6.0;
    let mut state = State::default();
    let mut height = 3.0;
    for radius in radii {
        loop {
            let place = [side, side, height].map(|to| random.random_range(0.0..to));
            let place = DVec3::from(place) + radius * DVec3::Z;
            let grains = &state.grains;
            let free = |k: usize| {
                let mut d = place - grains.position[k];
                d.x -= side * (d.x / side).round();
                d.y -= side * (d.y / side).round();
                d.length() > radius + grains.radius[k]
            };
            if (0..grains.len()).all(free) {
                state.grains.add_sphere(place, radius, 1.0);
                break;
            }
            height += 0.02;
        }
    }
    state.walls = vec![WallState::default()];
    let ratio = state.grains.radius[0] / state.grains.radius[199];
    assert!(ratio == 10.0, "radii of 1 to {ratio}");
    let law = Linear {
        sliding: friction(1000.0, 0.3),
        ..smooth(1000.0, 1.0, Tension::Clip)
    };
    let mut model = tests::model(law, &state.grains);
    model.domain = dem::Domain {
        size: [side; 2],
        periodic: [true; 2],
    };
    model.gravity = -5.0 * DVec3::Z;
    model.walls = vec![wall("bottom", DVec3::Z, Surface::Full)];
    let (model, state) = aged(model, &state, 20_000);
    compare(device, &model, &state);
}
