//! What a device will refuse of a bed and its water, and the memory that they take there: told before
//! a grain is laid, as far as the description tells.

use super::coupled::refuse_open;
use super::numbers::both_open;
use crate::choice::{Situation, fluid_model};
use crate::{Error, Model};
use lbm::{Bed, Field};

/// Memory of the water and the coupling on a device, beside that of the grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// All arrays [bytes].
    pub bytes: u64,
    /// The largest of them, which must fit into one binding [bytes].
    pub largest: u64,
}

impl Memory {
    /// Of this water in cells of length `spacing` [m] between so many `grains`, which reach `reach`
    /// cells.
    pub fn of(model: &Model, spacing: f64, reach: usize, grains: usize) -> Self {
        let cells: usize = model.cells.iter().product();
        let bed = Bed {
            porosity: Field::Cells(Vec::new()),
            permeability: Field::Cells(Vec::new()),
            forchheimer: None,
        };
        let lattice = lbm::gpu::memory::Memory::of(&fluid_model(model, spacing, bed));
        let (cells, grains) = (cells as u64, grains as u64);
        let is = |is: bool, bytes: u64| if is { bytes } else { 0 };
        // Contents, bed, trends, five vectors of the faces, two to gather; collected, pressures, lists,
        // what is read.
        let each = 10 * 16 + 2 * 4 + 2 * 4 + 8 + 2 * 216;
        let each = each + is(reach > 3, 4 * 16 + 8) + is(model.cavitation.is_some(), 4);
        let each = each + is(both_open(model), 8);
        // Members, slots and what is in them, rows, loads; forces, what is kept, pressing.
        let each_grain = 4 + 16 + 4 + 4 + 8 + 4 + 4 + (16 + 96 + 4);
        Self {
            bytes: lattice.bytes + lattice.source + cells * each + grains * each_grain,
            largest: lattice.largest.max(216 * cells),
        }
    }
}

/// Refuse water that will be refused when the bed is there: pores so open that its own mass holds it,
/// in a bed of this `porosity` or of any looser one, in cells no larger than `spacing` [m], with grain
/// steps of `step` [s].
///
/// # Errors
/// [`Error::Invalid`] with the remedy.
pub fn foresee(model: &Model, spacing: f64, porosity: f64, step: f64) -> Result<(), Error> {
    let fluid = &model.fluid;
    // It grows or falls all the way with porosity, whatever the law is.
    let diffusivity = [porosity, LOOSEST].map(|porosity| {
        let resistance = model.resistance.at(fluid, porosity, 0.0);
        step / (resistance * porosity * fluid.compressibility * spacing * spacing)
    });
    refuse_open(&Situation {
        model,
        diffusivity: diffusivity[0].min(diffusivity[1]),
        courant: 0.0,
        storage: 0.0,
        step,
    })
}

/// The porosity of a bed in which hardly a grain is left.
const LOOSEST: f64 = 0.95;
