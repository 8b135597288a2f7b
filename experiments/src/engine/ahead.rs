//! What a graphics device will refuse of a scene, told before the first phase begins.

use super::too_little;
use crate::protocol;
use crate::scene::{Pores, Scene};
use anyhow::{Context, Result, ensure};
use coupling::gpu;
use dem::gpu::memory::{Bounds, Memory};
use shaders::Adapter;

const MIB: f64 = 1_048_576.0;

/// Memory that the water between the grains of `scene` takes on `adapter` [bytes]; none: it is dry.
///
/// # Errors
/// Beds that the device cannot hold, and water that it will not compute when the bed is laid, as far
/// as the scene tells; with the remedy.
pub fn see_water(scene: &Scene, adapter: &Adapter) -> Result<Option<u64>> {
    let Some(pores) = &scene.water else {
        return Ok(None);
    };
    let grains = scene.start.grains.len();
    let bounds = Bounds::of(adapter);
    for model in protocol::models(scene) {
        let memory = Memory::of(&model, &scene.start)?;
        let fits = grains as u64 <= memory.most_grains(grains, bounds);
        ensure!(fits, too_little(grains, &memory, adapter));
    }
    let mut most = 0;
    for phase in &scene.phases {
        let Some(edges) = &phase.water else {
            continue;
        };
        let model = pores.model(edges, None);
        gpu::foresee(&model, pores.spacing, densest(scene), scene.step)
            .with_context(|| format!("phase {}", phase.name))?;
        let memory = gpu::Memory::of(&model, pores.spacing, pores.reach.count(), grains);
        ensure!(
            memory.largest <= bounds.binding,
            too_many(pores, &memory, bounds.binding)
        );
        most = most.max(memory.bytes);
    }
    Ok(Some(most))
}

/// Porosity of the bed once it is loaded, as far as it can be guessed.
fn densest(scene: &Scene) -> f64 {
    let grains = &scene.start.grains;
    let solid: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    let room = scene.domain.area() * protocol::expected_height(scene);
    (1.0 - solid / room).clamp(0.05, 0.95)
}

fn too_many(pores: &Pores, memory: &gpu::Memory, binding: u64) -> String {
    format!(
        "{:?} cells of water take {:.0} MiB on the GPU, {:.0} MiB of it in one binding, and the \
         device holds {:.0} MiB in one; write a larger water.spacing, or use the CPU with --backend \
         cpu",
        pores.cells,
        memory.bytes as f64 / MIB,
        memory.largest as f64 / MIB,
        binding as f64 / MIB
    )
}
