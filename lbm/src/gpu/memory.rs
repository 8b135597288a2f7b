//! What a scene takes on a device, told before anything is allocated there.

use super::slab::SLAB;
use super::steps::TICKS;
use crate::grid::Grid;
use crate::kernels::Parts;
use crate::{Error, Model};

/// Memory of a solver on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// All arrays [bytes].
    pub bytes: u64,
    /// What sources take beside them, once there are any [bytes].
    pub source: u64,
    /// What a device must hold in one array [bytes]: one population of all cells.
    pub largest: u64,
}

impl Memory {
    /// Memory of a solver for `model`.
    pub fn of(model: &Model) -> Self {
        let cells: usize = model.cells.iter().product();
        let one = 4 * grid(model).places() as u64;
        let solids = if model.has_solids() { one } else { 0 };
        // What a reading passes through, and numbers and sides of the steps.
        let slab = 19 * 4 * SLAB.min(cells) as u64;
        let steps = TICKS as u64 * (256 + 112);
        Self {
            bytes: (19 + bed_arrays(model)) * one + solids + slab + steps,
            source: if model.bed.is_some() { one } else { 0 },
            largest: one,
        }
    }

    /// What to say when a device has less.
    pub(super) fn too_little(&self, model: &Model, error: Error) -> Error {
        match error {
            Error::Device(shaders::Error::Memory(what)) => shaders::Error::Memory(format!(
                "{:?} cells of water take {:.2} GiB on the GPU, and it has less: {what}. Use fewer \
                 cells, or the CPU",
                model.cells,
                self.bytes as f64 / GIB
            ))
            .into(),
            other => other,
        }
    }
}

/// Bytes that a step cannot but read and write for each cell that is not solid: all populations
/// once each way, and what the law knows of the cell. A source has 4 more.
pub fn moved_by_a_step(model: &Model) -> f64 {
    let solids = if model.has_solids() { 4.0 } else { 0.0 };
    2.0 * 19.0 * 4.0 + 4.0 * bed_arrays(model) as f64 + solids
}

/// Fields of the bed that a step reads.
fn bed_arrays(model: &Model) -> u64 {
    let parts = Parts::of(model);
    match parts.porous {
        true => 2 + u64::from(parts.forchheimer) + u64::from(parts.inertia),
        false => 0,
    }
}

/// Places of the lattice on a device: rows begin where a sector of the memory does, unless they
/// are so short that this would cost much.
pub(super) fn grid(model: &Model) -> Grid {
    let grid = Grid::new(model.cells, model.walled());
    let row = grid.extent[0];
    Grid {
        stride: if row < 32 {
            row
        } else {
            row.next_multiple_of(8)
        },
        ..grid
    }
}

const GIB: f64 = 1_073_741_824.0;
