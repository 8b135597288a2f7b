//! A bed of a thousand grains of about two centimetres, pressed by 100 kPa, and its water.

use coupling::{Model, Permeability, Resistance};
use dem::contact::{Linear, Sliding, Tension};
use dem::{ContactLaw, Domain, Solver, State, StressLoad, Surface, Wall, WallMotion, WallState};
use glam::DVec3;
use lbm::{Fluid, Side, Signal};
use std::sync::OnceLock;

/// Side of the square box [m].
pub const SIDE: f64 = 0.2;
pub const AREA: f64 = SIDE * SIDE;
/// Density of the grains [kg/m³].
pub const DENSITY: f64 = 3600.0;
/// Stress on the top wall [Pa].
pub const STRESS: f64 = 1e5;
/// Grain step [s].
pub const STEP: f64 = 6.6e-6;
/// Water near its freezing point.
pub const WATER: Fluid = Fluid {
    density: 1000.0,
    viscosity: 1.8e-3,
    compressibility: 4.5e-10,
};

/// The contact law of the runs: k_n = 1e7 N/m.
pub fn law() -> Linear {
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

/// A floor, and a wall that a stress pushes onto the grains.
pub fn model(law: Linear, stress: f64) -> dem::Model {
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
        mass: 15.5,
        damping: 0.0,
    };
    dem::Model {
        domain: Domain {
            size: [SIDE; 2],
            periodic: [true, true],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::Linear(law),
        walls: vec![
            wall("bottom", DVec3::Z, WallMotion::Held),
            wall("top", -DVec3::Z, WallMotion::Stress(load)),
        ],
        drive: None,
        step: STEP,
        skin: None,
        ledger: true,
    }
}

/// The same bed with other loads or damping of its top wall.
pub fn with_load(model: &dem::Model, change: impl Fn(StressLoad) -> StressLoad) -> dem::Model {
    let mut model = model.clone();
    if let WallMotion::Stress(load) = model.walls[1].motion {
        model.walls[1].motion = WallMotion::Stress(change(load));
    }
    model
}

/// Numbers between 0 and 1 without structure, the same each time.
pub fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut x = 0x2545_f491_4f6c_dd1d ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    move || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A thousand grains that carry the wall, at rest.
pub fn pressed() -> State {
    static BED: OnceLock<State> = OnceLock::new();
    BED.get_or_init(|| pressed_from(1)).clone()
}

/// The same of other grains at other places.
pub fn pressed_from(seed: u64) -> State {
    let count: usize = 1000;
    let mut random = random(seed);
    let across = 8;
    let spacing = SIDE / across as f64;
    let mut state = State::default();
    for k in 0..count {
        let site = [k % across, k / across % across, k / (across * across)];
        let place = site.map(|s| (s as f64 + 0.5 + 0.1 * (random() - 0.5)) * spacing);
        let radius = 1e-2 * (0.9 + 0.2 * random());
        let id = state.grains.add_sphere(DVec3::from(place), radius, DENSITY) as usize;
        state.grains.velocity[id] = DVec3::new(random(), random(), random()) - 0.5;
    }
    let top = count.div_ceil(across * across) as f64 * spacing;
    let wall = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    state.walls = vec![wall(0.0), wall(-top)];
    let damped = Linear {
        normal_damping: 300.0,
        sliding: law().sliding.map(|sliding| Sliding {
            friction_static: 0.05,
            friction_dynamic: 0.05,
            ..sliding
        }),
        ..law()
    };
    let model = with_load(&model(damped, STRESS), |load| StressLoad {
        damping: 3000.0,
        ..load
    });
    for (steps, _) in [(40_000, "sink"), (10_000, "settle"), (10_000, "settle")] {
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
        sides: [Side::FreeSlip, drained()],
        ..Model::new([5, 5, 4], WATER, law)
    }
}

/// No pressure beyond hydrostatic.
pub fn drained() -> Side {
    Side::Pressure(Signal::Steady(0.0))
}
