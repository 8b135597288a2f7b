//! A bed of 300 grains of about two centimetres, pressed by 100 kPa, and its water.

use coupling::{Model, Permeability, Resistance};
use dem::contact::{Linear, Sliding, Tension};
use dem::{
    Constraint, ContactLaw, Domain, Drive, Horizontal, Solver, State, StressLoad, Surface, Wall,
    WallMotion, WallState,
};
use glam::DVec3;
use lbm::{Fluid, Side, Signal};
use std::sync::OnceLock;

/// Side of the square box [m], six grains.
pub const SIDE: f64 = 0.12;
pub const AREA: f64 = SIDE * SIDE;
/// Stress on the top wall [Pa], and a tenth more.
pub const STRESS: f64 = 1e5;
pub const LOADED: f64 = 1.1e5;
/// Grain step [s].
pub const STEP: f64 = 6.6e-6;
const WATER: Fluid = Fluid::COLD_WATER;

/// Grains and the water between them.
pub struct Bed {
    pub grains: dem::Model,
    pub state: State,
    pub water: Model,
}

/// The same with weight.
pub fn gravity(model: dem::Model) -> dem::Model {
    dem::Model {
        gravity: DVec3::new(0.0, 0.0, -9.81),
        ..model
    }
}

/// Grains at the bottom held, those at the top driven at a strain a second.
pub fn sheared() -> (dem::Model, State) {
    let mut state = pressed();
    let mut model = model(STRESS);
    let top = -state.walls[1].offset;
    let speed = top - 0.04;
    model.drive = Some(Drive::Velocity(speed));
    let grains = &mut state.grains;
    for k in 0..grains.len() {
        let z = grains.position[k].z;
        let horizontal = match z {
            z if z < 0.02 => Horizontal::Held,
            z if z > top - 0.02 => Horizontal::Driven,
            _ => Horizontal::Free,
        };
        grains.constraint[k] = Constraint {
            horizontal,
            rotation_held: horizontal != Horizontal::Free,
        };
        grains.velocity[k].x = speed * ((z - 0.02) / (top - 0.04)).clamp(0.0, 1.0);
    }
    // Wide enough for one search: the CPU renews weights with each, the GPU does not.
    model.skin = Some(4e-3);
    (model, state)
}

fn law() -> Linear {
    Linear {
        normal_stiffness: 1e7,
        normal_damping: 78.0,
        tension: Tension::Clip,
        sliding: Some(Sliding {
            stiffness: 1e6,
            damping: 78.0,
            friction_static: 0.5,
            friction_dynamic: 0.5,
        }),
        rolling: None,
        twisting: None,
    }
}

/// A floor, and a wall that a stress [Pa] pushes onto the grains.
pub fn model(stress: f64) -> dem::Model {
    let wall = |name: &str, normal, motion| Wall {
        name: name.into(),
        normal,
        surface: Surface::Frictionless,
        motion,
    };
    let load = StressLoad {
        mean: stress,
        amplitude: 0.0,
        frequency: 0.0,
        area: AREA,
        mass: 5.6,
        damping: 0.0,
    };
    dem::Model {
        domain: Domain {
            size: [SIDE; 2],
            periodic: [true, true],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::Linear(law()),
        walls: vec![
            wall("bottom", DVec3::Z, WallMotion::Held),
            wall("top", -DVec3::Z, WallMotion::Stress(load)),
        ],
        drive: None,
        step: STEP,
        skin: None,
        ledger: false,
    }
}

/// Grains that carry the wall, at rest, on the grid of a GPU's positions.
pub fn pressed() -> State {
    static BED: OnceLock<State> = OnceLock::new();
    BED.get_or_init(press).clone()
}

fn press() -> State {
    let mut x = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    let across: usize = 5;
    let spacing = SIDE / across as f64;
    let count: usize = 300;
    let mut state = State::default();
    for k in 0..count {
        let site = [k % across, k / across % across, k / (across * across)];
        let place = site.map(|s| (s as f64 + 0.5 + 0.1 * (random() - 0.5)) * spacing);
        let radius = 1e-2 * (0.9 + 0.2 * random());
        let id = state.grains.add_sphere(DVec3::from(place), radius, 3600.0) as usize;
        state.grains.velocity[id] = DVec3::new(random(), random(), random()) - 0.5;
    }
    let top = count.div_ceil(across * across) as f64 * spacing;
    let wall = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    state.walls = vec![wall(0.0), wall(-top)];
    let mut model = model(STRESS);
    model.law = ContactLaw::Linear(Linear {
        normal_damping: 300.0,
        sliding: law().sliding.map(|sliding| Sliding {
            friction_static: 0.05,
            friction_dynamic: 0.05,
            ..sliding
        }),
        ..law()
    });
    if let WallMotion::Stress(load) = &mut model.walls[1].motion {
        load.damping = 1000.0;
    }
    for steps in [40_000, 10_000, 10_000] {
        let mut solver = Solver::new(model.clone(), state, 1).expect("a loose bed is possible");
        solver.advance(steps).expect("a stable step");
        state = solver.snapshot().state;
        state.grains.velocity.fill(DVec3::ZERO);
        state.grains.angular_velocity.fill(DVec3::ZERO);
        state.walls[1].velocity = 0.0;
    }
    state.time = 0.0;
    state
}

/// Water in cells of two diameters, drained at the top.
pub fn water(permeability: f64) -> Model {
    let law = Resistance::Darcy(Permeability::constant(permeability));
    Model {
        sides: [Side::FreeSlip, Side::Pressure(Signal::Steady(0.0))],
        ..Model::new([3, 3, 3], WATER, law)
    }
}
