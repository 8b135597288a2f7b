//! `esker check` of water between grains.

use super::check::line;
use super::cost::MIB;
use crate::backend::Machine;
use crate::engine::Engine;
use crate::protocol::{self, Prepared};
use crate::run::water;
use crate::scene::water::Pores;
use crate::scene::water::pores::{DILATION, Suction};
use crate::scene::{Phase, Scene};
use anyhow::Result;
use dem::WallMotion;

/// Height from wall to wall when the water comes [m].
fn height(scene: &Scene) -> f64 {
    protocol::height_when_wet(&scene.phases, &scene.start, scene.domain.area())
}

/// Porosity of the bed when it has this height [m].
fn porosity(scene: &Scene, height: f64) -> f64 {
    let grains = &scene.start.grains;
    let solid: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    (1.0 - solid / (scene.domain.area() * height)).clamp(0.05, 0.95)
}

/// What is known of the water before the bed is laid.
pub fn facts(scene: &Scene, water: &Pores) {
    let height = height(scene);
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
    let Some(rate) = rate else {
        return;
    };
    let porosity = porosity(scene, height);
    let deborah = water.drainage_time(porosity, height) * rate.abs();
    line(
        "  Deborah number",
        &format!("at least {deborah:.2e}, drainage time over that of shear"),
    );
    let load = match phase.top {
        WallMotion::Stress(load) => Some(load.mean),
        WallMotion::Held | WallMotion::Velocity(_) => None,
    };
    let suction = water.suction(edges, porosity, height, rate);
    line("  suction", &describe_suction(suction, load));
}

/// Suction, not the Deborah number, tells whether water matters: skeleton and water are stiff beside
/// the load, and a bed that drains a hundred times faster than it deforms may still be sucked
/// together.
fn describe_suction(suction: Suction, load: Option<f64>) -> String {
    let dilates = format!("where a bed dilates by {DILATION} of its strain, as dense ones do");
    match (suction, load) {
        (Suction::Grows(per_strain), _) => format!(
            "undrained: it grows by up to {:.2e} Pa for each percent of strain {dilates}, until the \
             water breaks or the bed cannot dilate",
            0.01 * per_strain
        ),
        (Suction::Steady(suction), None) => format!("up to {suction:.2e} Pa {dilates}"),
        (Suction::Steady(suction), Some(load)) => {
            let share = suction / load;
            let meaning = match share {
                s if s < 0.05 => "as good as drained",
                s if s < 1.0 => "the bed hardens",
                _ => "more than the load: it hardens until the water breaks, or dilation ends",
            };
            format!("up to {suction:.2e} Pa, {share:.2} of the load, {dilates}: {meaning}")
        }
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
