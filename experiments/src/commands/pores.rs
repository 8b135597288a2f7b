//! `esker check` of water between grains.

use super::check::line;
use super::cost::MIB;
use crate::backend::Machine;
use crate::engine::Engine;
use crate::protocol::{self, Prepared};
use crate::run::water;
use crate::scene::water::Pores;
use crate::scene::{Phase, Scene};
use anyhow::Result;

/// Porosity of the bed when it has this height [m].
fn porosity(scene: &Scene, height: f64) -> f64 {
    let grains = &scene.start.grains;
    let solid: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    (1.0 - solid / (scene.domain.area() * height)).clamp(0.05, 0.95)
}

/// What is known of the water before the bed is laid.
pub fn facts(scene: &Scene, water: &Pores, height: f64) {
    for (what, value) in water.facts(porosity(scene, height), height, scene.step) {
        line(what, &value);
    }
}

/// The water of a phase that is sheared at `rate` [1/s], if it is.
pub fn describe(scene: &Scene, water: &Pores, phase: &Phase, height: f64, rate: Option<f64>) {
    let Some(edges) = &phase.water else {
        line("  water", "none: the grains are dry");
        return;
    };
    line("  water", &edges.describe());
    if let Some(rate) = rate {
        let time = water.drainage_time(porosity(scene, height), height);
        let regime = match time * rate.abs() {
            de if de < 0.1 => "drained",
            de if de < 10.0 => "partly drained",
            _ => "undrained",
        };
        line(
            "  Deborah number",
            &format!("at least {:.2e}, {regime}", time * rate.abs()),
        );
    }
}

/// The report of the coupling at the start of the first phase, where that is wet and its bed is
/// there.
///
/// # Errors
/// Those of the solver.
pub fn report(scene: &Scene, machine: &Machine) -> Result<()> {
    let phase = &scene.phases[0];
    if phase.water.is_none() || scene.start.contacts.is_empty() {
        return Ok(());
    }
    let reference = scene.past.reference_of(phase);
    let Prepared { model, state, .. } =
        protocol::prepare(scene, phase, scene.start.clone(), reference)?;
    let stiffness = water::stiffness(scene, phase, &model, &state, &scene.past)?;
    let engine = Engine::of_phase(scene, phase, machine, model, state, &scene.past, stiffness)?;
    if let (Engine::Wet(_), Machine::Gpu(_)) = (&engine, machine) {
        let mebibytes = engine.memory() as f64 / MIB;
        line(
            "memory of the GPU",
            &format!("{mebibytes:.1} MiB with the water"),
        );
    }
    if let Engine::Wet(bed) = &engine {
        println!("{}", water::describe(engine.model(), &bed.report()?));
    }
    Ok(())
}
