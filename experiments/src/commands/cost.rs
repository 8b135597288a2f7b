//! What a run costs, in time and memory, and how exact a GPU is.

use super::calibrate::calibrate;
use super::check::line;
use crate::backend::Machine;
use crate::engine::see_water;
use crate::protocol;
use crate::run::expected_steps;
use crate::scene::Scene;
use crate::scene::whole::grid;
use anyhow::Result;
use dem::WallMotion;
use dem::gpu::memory::{Bounds, Memory};

pub const MIB: f64 = 1_048_576.0;

/// How long `scene` takes on `machine`, and how much memory of this computer.
///
/// # Errors
/// Those of the solver.
pub fn time_and_memory(scene: &Scene, machine: &Machine) -> Result<()> {
    let count = scene.start.grains.len() as f64;
    let mut seconds = 0.0;
    let mut bytes: f64 = 0.0;
    for phase in &scene.phases {
        let cost = calibrate(scene, phase, machine)?;
        seconds += cost.grain_step * count * expected_steps(scene, phase) as f64;
        bytes = bytes.max(cost.bytes);
    }
    // Beside the solver: the state it began with, and some copies on their way to the files.
    let copies = 6.0 * 250.0;
    let own = match machine {
        Machine::Cpu { .. } => bytes,
        Machine::Gpu(_) => 0.0,
    };
    line(
        "memory",
        &format!("about {:.1} MiB", count * (own + copies) / MIB),
    );
    let any = scene.phases.iter().any(|phase| phase.end.at_rest.is_some());
    let most = if any { "at most " } else { "" };
    line(
        "run time",
        &format!("{most}about {} there", duration(seconds)),
    );
    Ok(())
}

pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// What the scene takes on the device, and what would fit.
///
/// # Errors
/// A box that is too large for the GPU, water that it will refuse.
pub fn memory_on_device(scene: &Scene, adapter: &shaders::Adapter) -> Result<()> {
    let each = protocol::models(scene).map(|model| Memory::of(&model, &scene.start));
    let each = each.collect::<Result<Vec<_>, _>>()?;
    let Some(memory) = each.iter().max_by_key(|memory| memory.bytes) else {
        return Ok(());
    };
    let count = scene.start.grains.len();
    let bounds = Bounds::of(adapter);
    line(
        "memory of the GPU",
        &format!(
            "about {:.1} MiB, {} bytes a grain, and {:.1} MiB while outputs are read; {} grains \
             at most, by bindings of {:.0} MiB, if its memory suffices",
            memory.bytes as f64 / MIB,
            memory.bytes / count as u64,
            memory.reading as f64 / MIB,
            memory.most_grains(count, bounds),
            bounds.binding as f64 / MIB
        ),
    );
    if let Some(bytes) = see_water(scene, adapter)? {
        let mebibytes = bytes as f64 / MIB;
        line("  with the water", &format!("{mebibytes:.1} MiB more"));
    }
    Ok(())
}

/// The grid of positions, and what it makes of the overlaps of grains of this mean `diameter` [m].
///
/// # Errors
/// A box that has no grid.
pub fn accuracy(scene: &Scene, diameter: f64) -> Result<()> {
    let height = protocol::start_height(scene);
    let grid = grid(&scene.domain, &scene.start.grains, Some(height), scene.skin)?;
    // A 2^-23rd of the unit, and the roundings of single precision.
    let fault = grid.unit * 2f64.powi(-23);
    let overlaps = scene.phases.iter().filter_map(|phase| match phase.top {
        WallMotion::Stress(load) if load.mean > 0.0 => {
            Some(load.mean * diameter.powi(2) / phase.law.normal_stiffness())
        }
        _ => None,
    });
    let least = overlaps.fold(f64::INFINITY, f64::min);
    let share = match least.is_finite() {
        true => format!(
            ", {:.0e} of the overlap {least:.1e} m under the load, beside the 6e-8 of single \
             precision",
            fault / least
        ),
        false => String::new(),
    };
    line(
        "positions",
        &format!(
            "whole numbers of 2^{:.0} m / 2^32; overlaps to {fault:.1e} m{share}",
            grid.unit.log2()
        ),
    );
    Ok(())
}
