//! What several tests need: models and states of few parts, beds of many grains, reference data.

use dem::contact::{Linear, Sliding, Tension, Turning};
use dem::{
    ContactLaw, Domain, Error, Grains, Model, Snapshot, Solver, State, Surface, Wall, WallMotion,
    WallState,
};
use glam::DVec3;

pub mod bed;
pub mod packing;
pub mod table;
pub mod wet;

/// Density of the grains [kg/m³].
pub const DENSITY: f64 = 3600.0;
/// Radius of most grains [m].
pub const RADIUS: f64 = 1e-2;
/// Middle of the [`model`]'s box, at z = 0 [m].
pub const MIDDLE: DVec3 = DVec3::new(0.5, 0.5, 0.0);
/// Gravity [m/s²].
pub const GRAVITY: f64 = 9.81;

/// Mass of a solid sphere [kg].
pub fn mass(radius: f64) -> f64 {
    DENSITY * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

/// A law with the normal part only: stiffness [N/m], damping [N s/m].
pub fn smooth(stiffness: f64, damping: f64, tension: Tension) -> Linear {
    Linear {
        normal_stiffness: stiffness,
        normal_damping: damping,
        tension,
        sliding: None,
        rolling: None,
        twisting: None,
    }
}

/// Friction with one coefficient, k_t = 2/7 `stiffness` and no tangential dashpot.
pub fn friction(stiffness: f64, coefficient: f64) -> Option<Sliding> {
    Some(Sliding {
        stiffness: 2.0 / 7.0 * stiffness,
        damping: 0.0,
        friction_static: coefficient,
        friction_dynamic: coefficient,
    })
}

/// Resistance to rolling or twisting.
pub fn turning(stiffness: f64, damping: f64, friction: f64) -> Option<Turning> {
    Some(Turning {
        stiffness,
        damping,
        friction,
    })
}

/// A closed box of 1 m² without walls, gravity and drive; the step [s] is the default one.
pub fn model(law: Linear, grains: &Grains) -> Model {
    let mut model = Model {
        domain: Domain {
            size: [1.0, 1.0],
            periodic: [false, false],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::Linear(law),
        walls: vec![],
        drive: None,
        step: f64::NAN,
        skin: None,
        ledger: true,
    };
    model.step = dem::stability::default_step(&model, grains);
    model
}

/// A wall at rest below the grains.
pub fn floor(surface: Surface) -> Wall {
    Wall {
        name: "bottom".into(),
        normal: DVec3::Z,
        surface,
        motion: WallMotion::Held,
    }
}

/// Grains at rest at `position` [m] with `radius` [m], and `walls` planes through the origin.
pub fn state(grains: &[(DVec3, f64)], walls: usize) -> State {
    let mut state = State {
        walls: vec![WallState::default(); walls],
        ..State::default()
    };
    for &(position, radius) in grains {
        state.grains.add_sphere(position, radius, DENSITY);
    }
    state
}

/// One grain that rests on a floor under gravity with components `along` x and `down` -z
/// [m/s²], its normal spring in balance.
pub fn resting(law: Linear, along: f64, down: f64) -> (Model, State) {
    let overlap = mass(RADIUS) * down / law.normal_stiffness;
    let state = state(&[(MIDDLE + DVec3::Z * (RADIUS - overlap), RADIUS)], 1);
    let mut model = model(law, &state.grains);
    model.walls = vec![floor(Surface::Full)];
    model.gravity = DVec3::new(along, 0.0, -down);
    (model, state)
}

/// A solver on one thread.
pub fn solver(model: &Model, state: &State) -> Solver {
    solver_on(model, state, 1)
}

/// A solver on `threads` threads.
pub fn solver_on(model: &Model, state: &State, threads: usize) -> Solver {
    Solver::new(model.clone(), state.clone(), threads)
        .unwrap_or_else(|error| panic!("the solver refused the case: {error}"))
}

/// What is found after `steps` steps.
pub fn run(model: &Model, state: &State, steps: u64) -> Snapshot {
    let mut solver = solver(model, state);
    solver.advance(steps).expect("the case is stable");
    solver.snapshot()
}

/// Number of steps that end nearest to `time` [s].
pub fn steps_to(time: f64, model: &Model) -> u64 {
    (time / model.step).round() as u64
}

/// Order of convergence from the errors of two runs, the second with steps half as long.
pub fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).abs().log2()
}

/// Did the solver notice that the numbers ran away?
pub fn ran_away(result: Result<(), Error>) -> bool {
    matches!(result, Err(Error::Unstable { .. }))
}
