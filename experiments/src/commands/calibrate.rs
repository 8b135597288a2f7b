//! How fast this machine steps the grains of a scene, and the water between them: measured on its
//! start, or on a small cubic packing.

use crate::backend::Machine;
use crate::engine::Engine;
use crate::protocol::{self, Prepared};
use crate::scene::water::pores::Stiffness;
use crate::scene::whole::whole;
use crate::scene::{Phase, Scene};
use anyhow::Result;
use dem::{Grains, State, WallState};
use glam::DVec3;
use std::time::Instant;

/// What a grain costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Wall-clock time of a grain-step [s].
    pub grain_step: f64,
    /// Memory of the solver, on the device where there is one [bytes].
    pub bytes: f64,
}

/// Grains of the packing at most: more would not fit the caches less, and take longer.
const GRAINS: usize = 20_000;
/// Room over the height of a settled bed beyond which water stands above it: it is guessed.
const CLEAR: f64 = 1.2;
/// How long to measure [s].
const SECONDS: f64 = 0.5;

/// Measure `phase` on `machine`: the start itself, where that is what the phase meets, else a
/// packing, with as much water to a grain as there will be.
///
/// # Errors
/// Those of the solver.
pub fn calibrate(scene: &Scene, phase: &Phase, machine: &Machine) -> Result<Cost> {
    let start = &scene.start;
    let first = phase.name == scene.phases[0].name;
    // Dry grains that are thrown in do not touch yet; in water they cost what the water does.
    let is_met = !start.contacts.is_empty() || phase.water.is_some();
    if first && is_met && start.grains.len() <= GRAINS {
        let reference = scene.past.reference_of(phase);
        let Prepared { model, state, .. } =
            protocol::prepare(scene, phase, start.clone(), reference)?;
        let known = scene.past.water.as_ref().and_then(|past| past.stiffness);
        let engine = Engine::of_phase(scene, phase, machine, model, state, &scene.past, known)?;
        return measure(engine, start.grains.len());
    }
    let (engine, grains) = packing(scene, phase, machine)?;
    measure(engine, grains)
}

/// Grains of the scene's mean size on a simple cubic lattice, pressed together so that each has
/// six contacts; a sheared bed has four to five, and more pairs that are near without touching.
/// In water of a wet phase, with as many cells to a grain as in the scene. And their number.
fn packing(scene: &Scene, phase: &Phase, machine: &Machine) -> Result<(Engine, usize)> {
    let own = &scene.start.grains;
    let radius = own.mean_radius();
    let mass = own.mass.iter().sum::<f64>() / own.len() as f64;
    let side = (own.len().min(GRAINS) as f64).cbrt().round().max(3.0) as usize;
    let spacing = 2.0 * radius * (1.0 - 1e-4);
    let length = side as f64 * spacing;
    let mut grains = Grains::default();
    let density = mass / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3));
    for k in 0..side.pow(3) {
        let cell = [k % side, k / side % side, k / side / side].map(|n| (n as f64 + 0.5) * spacing);
        grains.add_sphere(DVec3::from_array(cell), radius, density);
    }
    let count = grains.len();
    let wet = scene.water.as_ref().zip(phase.water.as_ref());
    // Clear water stands above the grains as in the scene.
    let room = protocol::height_when_wet(&scene.phases, &scene.start, scene.domain.area());
    let clear = room / protocol::expected_height(scene);
    let height = match wet {
        Some(_) if clear > CLEAR => length * clear,
        _ => length,
    };
    let water = wet.map(|(water, edges)| {
        let least = water.reach.count();
        let across = ((length / water.spacing).round() as usize).max(least);
        let cells = water.cells.iter().product::<usize>() * count / own.len();
        let layers = (cells / (across * across)).max(least);
        let known = match water.stiffness {
            Stiffness::Given(stiffness) => Some(stiffness),
            Stiffness::Unknown | Stiffness::Measured => None,
        };
        let mut model = water.model(edges, known);
        model.cells = [across, across, layers];
        (water, model)
    });
    let at = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    let state = State {
        walls: vec![at(0.0), at(-height)],
        grains,
        ..State::default()
    };
    let mut model = protocol::model(scene, phase, 1.0);
    let domain = dem::Domain {
        size: [length; 2],
        periodic: [true; 2],
    };
    model.domain = whole(domain, &state.grains, Some(height), model.skin);
    model.walls.truncate(state.walls.len());
    for wall in &mut model.walls {
        wall.motion = dem::WallMotion::Held;
    }
    model.drive = None;
    let engine = match water {
        Some((water, of_packing)) => Engine::wet(machine, model, state, water, of_packing, None)?,
        None => Engine::new(machine, model, state)?,
    };
    Ok((engine, count))
}

/// Of `grains` in this engine.
fn measure(mut engine: Engine, grains: usize) -> Result<Cost> {
    let count = grains as f64;
    engine.advance(20)?;
    let (begun, mut steps, mut more) = (Instant::now(), 0, 20);
    // More and more at a time: a GPU makes steps by the hundred.
    while begun.elapsed().as_secs_f64() < SECONDS {
        engine.advance(more)?;
        steps += more;
        more += more / 2;
    }
    Ok(Cost {
        grain_step: begun.elapsed().as_secs_f64() / (steps as f64 * count),
        bytes: engine.memory() as f64 / count,
    })
}
