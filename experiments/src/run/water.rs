//! What the water of a phase begins with, and what it leaves.

use crate::engine::{self, Engine};
use crate::protocol::{Past, PastWater};
use crate::scene::water::pores::Stiffness;
use crate::scene::{Phase, Scene};
use anyhow::Result;
use dem::{Model, State};

/// Stiffness of the skeleton [Pa], given, known from before or measured now; none: it is not known,
/// or the phase is dry.
///
/// # Errors
/// Numbers that run away.
pub fn stiffness(
    scene: &Scene,
    phase: &Phase,
    model: &Model,
    state: &State,
    past: &Past,
) -> Result<Option<f64>> {
    let (Some(pores), Some(_)) = (&scene.water, &phase.water) else {
        return Ok(None);
    };
    let known = past.water.as_ref().and_then(|past| past.stiffness);
    Ok(match pores.stiffness {
        Stiffness::Unknown => None,
        Stiffness::Given(stiffness) => Some(stiffness),
        Stiffness::Measured if known.is_some() => known,
        Stiffness::Measured => engine::stiffness(model, state)?,
    })
}

/// What a phase leaves: nothing after a dry one, whose bed may be another now.
pub fn past(engine: &Engine, stiffness: Option<f64>) -> Option<PastWater> {
    match engine {
        Engine::Wet(bed) => Some(PastWater {
            cells: bed.cells(),
            state: bed.water_state(),
            stiffness,
        }),
        Engine::Cpu(_) | Engine::Gpu(_) => None,
    }
}
