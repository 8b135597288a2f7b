//! Millimetre grains in water, far from each other or loosely on the ground.

use coupling::{Coupled, Model, Resistance};
use dem::contact::{Linear, Sliding, Tension};
use dem::{ContactLaw, Domain, Solver, State, Surface, Wall, WallMotion, WallState};
use glam::DVec3;
use lbm::Fluid;

/// Diameter [m] and density [kg/m³] of the grains, gravity [m/s²].
pub const DIAMETER: f64 = 1e-3;
pub const DENSITY: f64 = 2600.0;
pub const GRAVITY: f64 = 9.81;
/// Grain step [s].
pub const STEP: f64 = 2e-5;
/// Water at 20 °C, as it is.
pub const WATER: Fluid = Fluid {
    density: 1000.0,
    viscosity: 1e-3,
    compressibility: 4.6e-10,
};

/// Syrup: three hundred times as viscous. Grains settle in it as Stokes says, at a Reynolds number of
/// 0.01.
pub const SYRUP: Fluid = Fluid {
    viscosity: 0.3,
    ..WATER
};

/// A box of `width` [m] across and `height` between two walls that are held.
pub fn model(width: [f64; 2]) -> dem::Model {
    let wall = |name: &str, normal| Wall {
        name: name.into(),
        normal,
        surface: Surface::Frictionless,
        motion: WallMotion::Held,
    };
    dem::Model {
        domain: Domain {
            size: width,
            periodic: [true, true],
        },
        gravity: DVec3::new(0.0, 0.0, -GRAVITY),
        law: ContactLaw::Linear(Linear {
            normal_stiffness: 100.0,
            normal_damping: 2e-3,
            tension: Tension::Clip,
            sliding: Some(Sliding {
                stiffness: 50.0,
                damping: 1e-3,
                friction_static: 0.4,
                friction_dynamic: 0.4,
            }),
            rolling: None,
            twisting: None,
        }),
        walls: vec![wall("bottom", DVec3::Z), wall("top", -DVec3::Z)],
        drive: None,
        step: STEP,
        skin: None,
        ledger: false,
    }
}

/// Grains at rest at `places` below a lid at `height` [m].
pub fn grains(places: &[DVec3], height: f64) -> State {
    let mut state = State::default();
    for place in places {
        state.grains.add_sphere(*place, 0.5 * DIAMETER, DENSITY);
    }
    let wall = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    state.walls = vec![wall(0.0), wall(-height)];
    state
}

/// Grains in a closed box of `fluid`, with books of the energy.
pub fn closed(
    fluid: Fluid,
    law: Resistance,
    places: &[DVec3],
    size: [f64; 3],
    cells: [usize; 3],
) -> Coupled<3> {
    let water = Model::new(cells, fluid, law);
    let mut model = model([size[0], size[1]]);
    model.ledger = true;
    Coupled::new(model, grains(places, size[2]), water, None, 1).unwrap()
}

/// Velocity at which the drag of `law` holds grains of this solid fraction in suspension [m/s]:
/// R q = c Δρ g.
pub fn balance(law: Resistance, solid: f64) -> f64 {
    balance_in(WATER, law, solid)
}

/// The same in any `fluid`.
pub fn balance_in(fluid: Fluid, law: Resistance, solid: f64) -> f64 {
    let weight = (DENSITY - fluid.density) * GRAVITY;
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..100 {
        let q = 0.5 * (low + high);
        let more = law.at(&fluid, 1.0 - solid, q) * q < solid * weight;
        *if more { &mut low } else { &mut high } = q;
    }
    low
}

/// Numbers of places for grains of this solid fraction in a box, none nearer than a diameter.
pub fn scattered(size: [f64; 3], solid: f64, seed: u64) -> Vec<DVec3> {
    let volume = std::f64::consts::PI / 6.0 * DIAMETER.powi(3);
    let count = (solid * size.iter().product::<f64>() / volume).round() as usize;
    let mut random = crate::bed::random(seed);
    let mut places: Vec<DVec3> = Vec::new();
    let domain = model([size[0], size[1]]).domain;
    while places.len() < count {
        let room = size[2] - DIAMETER;
        let z = 0.5 * DIAMETER + room * random();
        let place = DVec3::new(size[0] * random(), size[1] * random(), z);
        let far = |other: &DVec3| domain.nearest_image(place - *other).length() > DIAMETER;
        if places.iter().all(far) {
            places.push(place);
        }
    }
    places
}

/// A bed of `count` grains that has fallen dry into a box with a lid at `height` [m].
pub fn laid(count: usize, width: f64, height: f64) -> State {
    let solid = 0.25;
    let volume = std::f64::consts::PI / 6.0 * DIAMETER.powi(3);
    let loose = count as f64 * volume / (solid * width * width);
    let places = scattered([width, width, loose], solid, 5);
    let mut state = grains(&places, height.max(loose));
    for _ in 0..12 {
        let mut solver = Solver::new(model([width; 2]), state, 1).unwrap();
        solver.advance(2000).unwrap();
        state = solver.snapshot().state;
        state.grains.velocity.fill(DVec3::ZERO);
        state.grains.angular_velocity.fill(DVec3::ZERO);
    }
    state.walls[1].offset = -height;
    state.time = 0.0;
    state
}
