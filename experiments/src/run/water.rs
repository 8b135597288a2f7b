//! What the water of a phase begins with, and what it leaves.

use crate::engine::{self, Engine};
use crate::protocol::{Past, PastWater};
use crate::scene::water::pores::Stiffness;
use crate::scene::{Phase, Scene};
use anyhow::Result;
use coupling::Report;
use dem::{Drive, Model, State};

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

/// What is said of the coupling before the first step of a phase.
pub fn describe(model: &Model, report: &Report) -> String {
    let sheared = match model.drive {
        Some(Drive::Velocity(velocity)) => {
            let rate = velocity.abs() / report.height;
            format!(
                "\n  Deborah number {:.2e}, drainage time over that of shear at {rate:.2e} 1/s",
                report.deborah(rate)
            )
        }
        Some(Drive::ShearStress(_)) | None => String::new(),
    };
    format!("{report}{sheared}")
}

/// What a phase leaves: nothing after a dry one, whose bed may be another now.
///
/// # Errors
/// A device that fails.
pub fn past(engine: &Engine, stiffness: Option<f64>) -> Result<Option<PastWater>> {
    Ok(match engine {
        Engine::Wet(bed) => Some(PastWater {
            cells: bed.cells(),
            state: bed.water_state()?,
            stiffness,
        }),
        Engine::Cpu(_) | Engine::Gpu(_) => None,
    })
}
