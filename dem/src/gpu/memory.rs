//! What a scene takes on a device, told before anything is allocated there.

use super::numbers::Numbers;
use crate::{Error, Model, State};

/// Memory of a solver on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// All arrays of the steps and the search [bytes].
    pub bytes: u64,
    /// Those that a reading needs beside them, for as long as it lasts [bytes].
    pub reading: u64,
    /// The largest array [bytes].
    pub largest: u64,
}

impl Memory {
    /// Memory of a solver for `state` under `model`, as long as its first room for neighbours
    /// suffices: 12 a grain, as in a bed of radii 1:2. The lists of wider spreads may grow.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the numbers of the GPU cannot hold the scene.
    pub fn of(model: &Model, state: &State) -> Result<Self, Error> {
        let numbers = Numbers::of(model, state, 1)?;
        let parts = &numbers.parts;
        let (grains, walls) = (parts.grains as u64, parts.walls as u64);
        let (slides, turns, ledger) = (parts.slides, parts.turns, parts.ledger);
        let (full, stress) = (parts.full_walls, parts.shear_stress);
        let remembers = slides || turns || ledger;
        let (entries, touching) = (numbers.entries as u64, numbers.touching as u64);
        // Vectors of four words.
        let four = |is: bool, count: u64| if is { 16 * count } else { 0 };
        // Histories, and rows of grains, move along with a new order through this.
        let moved = four(remembers, touching).max(four(true, grains * walls.max(2)));
        let arrays = [
            grains * (2 * 32 + 2 * 32 + 16 + 16), // places, motions, owns, remains
            four(slides, 2 * grains),             // turned, orientations
            8 * grains + 4 * entries,             // lists, neighbours
            four(slides, entries),                // springs
            four(ledger, entries),                // forces
            four(turns, entries),                 // rollings
            four(turns && ledger, entries),       // couples
            // The same at walls.
            four(ledger, grains * walls),
            four(full, grains * walls),
            four(full && turns, grains * walls),
            four(full && turns && ledger, grains * walls),
            four(stress, 2 * grains), // pushes
            // The search: places at the last one, cells and order, entries that touch.
            grains * (12 + 2 * 4 + 8 + 4 + 4 + 8) + 4 * touching,
            if remembers {
                4 * (entries + touching)
            } else {
                0
            },
            moved,
        ];
        let reading = [
            4 * entries,
            four(true, entries),
            four(slides, entries),
            four(turns, entries),
            four(true, grains * walls),
            four(full, grains * walls),
            four(full && turns, grains * walls),
            four(true, 2 * grains),
        ];
        Ok(Self {
            bytes: arrays.iter().sum(),
            reading: reading.iter().sum(),
            largest: four(true, entries).max(moved),
        })
    }

    /// How many grains would fit, where `grains` take this much, if an array holds at most
    /// `largest` [bytes].
    pub fn most_grains(&self, grains: usize, largest: u64) -> u64 {
        (largest as f64 / self.largest as f64 * grains as f64) as u64
    }
}

/// Bytes that a step cannot but read and write, for each grain with so many entries in its list
/// and so many of them in contact: every row once, though a grain's neighbours read it too.
pub fn moved_by_a_step(model: &Model, entries: f64, touching: f64) -> f64 {
    let (slides, turns, ledger) = (model.law.slides(), model.law.turns(), model.ledger);
    let is = |is: bool, bytes: f64| if is { bytes } else { 0.0 };
    // Place, motion and what remains of kicks are read and written, mass and list read.
    let own = 2.0 * (64.0 + 16.0) + 16.0 + 8.0 + is(slides, 2.0 * 16.0);
    // Springs are read and written; the ledger's forces from one side.
    let history = is(slides, 32.0) + is(turns, 32.0) + is(ledger, 16.0) + is(turns && ledger, 16.0);
    own + 4.0 * entries + history * touching
}
