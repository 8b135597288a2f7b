//! What a scene takes on a device, told before anything is allocated there.

use super::numbers::Numbers;
use crate::{Error, Model, State};
use shaders::Parts;

/// Memory of a solver on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// All arrays of the steps and the search [bytes].
    pub bytes: u64,
    /// Those that a reading needs beside them, for as long as it lasts [bytes].
    pub reading: u64,
    /// The largest array that lies in one part [bytes].
    pub largest: u64,
    /// Entries of the neighbour lists. Arrays of them may lie in parts, a binding each.
    entries: u64,
    /// Arrays of a reading, which sees most: in one part, with a vector for each entry, with a word.
    arrays: [u64; 3],
}

/// What a device lets a kernel see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// Of an array through one binding [bytes].
    pub binding: u64,
    /// Arrays, or parts of them, at a time.
    pub arrays: u64,
}

impl Bounds {
    /// Those of `adapter`.
    pub fn of(adapter: &shaders::Adapter) -> Self {
        Self {
            binding: adapter.largest_binding(),
            arrays: adapter.limits.max_storage_buffers_per_shader_stage.into(),
        }
    }
}

impl Memory {
    /// Memory of a solver for `state` under `model`, as long as its first room for neighbours
    /// suffices: 12 a grain, as in a bed of radii 1:2. The lists of wider spreads may grow.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the numbers of the GPU cannot hold the scene.
    pub fn of(model: &Model, state: &State) -> Result<Self, Error> {
        let numbers = Numbers::of(model, state, 1, None)?;
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
            largest: grains * (64).max(16 * walls), // places, what grains remember of walls
            entries,
            arrays: [
                // Sums, control, bodies, places, motions, owns, lists, pushes; walls.
                8 + count(&[true, ledger, full, full])
                    + count(&[full && turns, full && turns, full && turns && ledger]),
                count(&[true, slides, slides, ledger, turns, turns, turns && ledger]),
                2,
            ],
        })
    }

    /// How many grains a device within `bounds` takes, where `grains` take this much; if it has the
    /// memory, which nobody tells.
    pub fn most_grains(&self, grains: usize, bounds: Bounds) -> u64 {
        let fits = |n: u64| {
            let times = n as f64 / grains.max(1) as f64;
            let entries = (self.entries as f64 * times) as usize;
            let parts = |size| u64::from(Parts::of(entries, size, bounds.binding).count);
            let [single, vectors, words] = self.arrays;
            self.largest as f64 * times <= bounds.binding as f64
                && single + vectors * parts(16) + words * parts(4) <= bounds.arrays
        };
        // Places of grains are numbered in 30 bits.
        let (mut fit, mut too_many) = (0u64, 1 << 30);
        while too_many - fit > 1 {
            let middle = fit.midpoint(too_many);
            match fits(middle) {
                true => fit = middle,
                false => too_many = middle,
            }
        }
        fit
    }
}

/// How many of them there are.
fn count(are: &[bool]) -> u64 {
    are.iter().filter(|is| **is).count() as u64
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
