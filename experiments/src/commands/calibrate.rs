//! How fast this machine steps the grains of a scene: measured on a small cubic packing.

use crate::backend::Machine;
use crate::engine::Engine;
use crate::protocol;
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
/// How long to measure [s].
const SECONDS: f64 = 0.5;

/// Measure `phase` on `machine` with grains of the scene's mean size on a
/// simple cubic lattice, pressed together so that each has six contacts; a sheared bed has
/// four to five, and more pairs that are near without touching.
///
/// # Errors
/// Those of the solver.
pub fn calibrate(scene: &Scene, phase: &Phase, machine: &Machine) -> Result<Cost> {
    let radius = scene.start.grains.mean_radius();
    let mass = scene.start.grains.mass.iter().sum::<f64>() / scene.start.grains.len() as f64;
    let side = (scene.start.grains.len().min(GRAINS) as f64)
        .cbrt()
        .round()
        .max(3.0) as usize;
    let spacing = 2.0 * radius * (1.0 - 1e-4);
    let length = side as f64 * spacing;
    let mut grains = Grains::default();
    let density = mass / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3));
    for k in 0..side.pow(3) {
        let cell = [k % side, k / side % side, k / side / side].map(|n| (n as f64 + 0.5) * spacing);
        grains.add_sphere(DVec3::from_array(cell), radius, density);
    }
    let count = grains.len() as f64;
    let at = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    let state = State {
        walls: vec![at(0.0), at(-length)],
        grains,
        ..State::default()
    };
    let mut model = protocol::model(scene, phase, 1.0);
    let domain = dem::Domain {
        size: [length; 2],
        periodic: [true; 2],
    };
    model.domain = whole(domain, &state.grains, Some(length), model.skin);
    model.walls.truncate(state.walls.len());
    for wall in &mut model.walls {
        wall.motion = dem::WallMotion::Held;
    }
    model.drive = None;
    let mut engine = match (&scene.water, &phase.water) {
        (Some(water), Some(edges)) => {
            // As many cells for each grain as in the scene.
            let least = water.reach.count() as f64;
            let across = (length / water.spacing).round().max(least) as usize;
            let mut of_packing = water.model(edges, None);
            of_packing.cells = [across; 3];
            Engine::wet(machine, model, state, water, of_packing, None)?
        }
        _ => Engine::new(machine, model, state)?,
    };
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
