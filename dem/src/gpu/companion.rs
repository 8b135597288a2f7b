//! What goes along with the grains on the device and pushes them in every step: pore water, for one.
//!
//! A solver [with a companion](Solver::with_companion) reads in each step what pushes its grains
//! (`companions`, by row) and its walls (`sums` from the slot COMPANION on, and `reliefs`: how much
//! of that moves a wall). Who goes along fills these in an exchange between two steps, by dispatches of
//! its own in the same recording, from the solver's own arrays ([`Solver::arrays`]); nothing is copied.
//! What it has filled is held until the next exchange: a step without one is a step of dry
//! grains that reads 16 bytes more for each. A
//! search reorders the rows of `companions` and of `kept`, which is the companion's own.
//!
//! A group of steps is recorded by [`begin`](Solver::begin_group), [`record_next`](Solver::record_next)
//! for each, and [`end`](Solver::end_group); the host hears how far it went
//! ([`hear`](Solver::hear)) before it records the next one. Where lists end before the group does,
//! the steps left over do nothing: a companion's dispatches must look at `may_step` too.
//!
//! Twins: `COMPANION` in shaders/dem/step.wgsl and boundary.wgsl. Without a companion none of this
//! is compiled or allocated.

use super::arrays::Arrays;
use super::control::Control;
use super::fixed::Grid;
use super::look::Look;
use super::numbers;
use super::scene::Relief;
use super::search::Search;
use super::solver::Solver;
use super::steps::GROUP;
use super::wide::Wide;
use crate::{Error, Model, State};
use glam::DVec3;
use shaders::{Array, Bindable, Device, Part, Reading, Recording};

/// Arrays of a companion.
pub(super) struct Companion {
    /// Force on each grain [N].
    pub forces: Array<[f32; 4]>,
    /// The companion's own, some vectors a grain.
    pub kept: Array<[u32; 4]>,
    pub width: u32,
    /// Normal forces of the contacts of each grain [N].
    pub loads: Array<f32>,
    /// Of each wall, in the last exchange and the one before.
    pub reliefs: Array<Relief>,
}

impl Companion {
    pub fn new(
        device: &Device,
        grains: usize,
        walls: usize,
        width: usize,
    ) -> Result<Self, shaders::Error> {
        Ok(Self {
            forces: device.array("companions", grains)?,
            kept: device.array("kept", width * grains)?,
            width: width as u32,
            loads: device.array("loads", grains)?,
            reliefs: device.array("reliefs", 2 * walls)?,
        })
    }

    pub fn named(&self) -> [(&'static str, &dyn Bindable); 4] {
        [
            ("companions", &self.forces),
            ("kept", &self.kept),
            ("loads", &self.loads),
            ("reliefs", &self.reliefs),
        ]
    }
}

/// A reading of how far the device is.
pub struct Progress(Part<Control>);

impl Solver {
    /// Take over `state` under `model` on `device`, together with something that keeps `kept`
    /// vectors of four words for each grain. Its forces are zero until it writes them.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn with_companion(
        device: &Device,
        model: Model,
        state: State,
        kept: usize,
    ) -> Result<Self, Error> {
        let lanes = numbers::lanes(device, state.grains.len());
        Self::build(device, lanes, Some(kept), model, state)
    }

    /// The arrays that a companion may read, and fill where they are its own, by name.
    pub fn arrays(&self) -> Vec<(&'static str, &dyn Bindable)> {
        self.arrays.named()
    }

    /// The grid of positions.
    pub fn grid(&self) -> &Grid {
        &self.numbers.grid
    }

    /// Number of grains.
    pub fn grains(&self) -> usize {
        self.numbers.parts.grains
    }

    /// Force of the companion on each wall along minus its normal, of its last exchange [N].
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn forces_of_companion(&self) -> Result<Vec<f64>, Error> {
        let slots = self.numbers.slots;
        let first = slots.held_companion();
        let mut reading = self.device.reading();
        let part = reading.add(&self.arrays.sums, first..first + slots.walls);
        let words = reading.wait()?.take(part);
        let force = |&[hi, lo]: &[u32; 2]| {
            let units = Wide { hi: hi as i32, lo }.units();
            units * self.numbers.units.force
        };
        Ok(words.iter().map(force).collect())
    }

    /// Force of the companion on each grain, of its last exchange [N], in the order of the rows.
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn pushes_of_companion(&self) -> Result<Vec<DVec3>, Error> {
        let rows = self.device.read(&self.companion().forces)?;
        let force = |&[x, y, z, _]: &[f32; 4]| DVec3::new(x.into(), y.into(), z.into());
        Ok(rows.iter().map(force).collect())
    }

    /// Where the walls are along their axes [m], without the rest of a snapshot.
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn wall_coordinates(&self) -> Result<Vec<f64>, Error> {
        let arrays = &self.arrays;
        let mut reading = self.device.reading();
        let control = reading.add(&arrays.control, 0..1);
        let sums = reading.add(&arrays.sums, 0..arrays.sums.len());
        let bodies = reading.add(&arrays.bodies, 0..arrays.bodies.len());
        let reliefs = reading.add(&self.companion().reliefs, 0..self.companion().reliefs.len());
        let arrived = reading.wait()?;
        let look = Look {
            control: arrived.take(control)[0],
            sums: arrived.take(sums),
            bodies: arrived.take(bodies),
            reliefs: arrived.take(reliefs),
            ..Look::default()
        };
        let walls = look.bodies_now(self).into_iter().take(arrays.parts.walls);
        Ok(walls.map(|(coordinate, _)| coordinate).collect())
    }

    /// The array that a search reorders for a companion.
    ///
    /// # Panics
    /// If there is no companion.
    pub fn kept(&self) -> &Array<[u32; 4]> {
        &self.companion().kept
    }

    fn companion(&self) -> &Companion {
        let companion = self.arrays.companion.as_ref();
        companion.expect("the solver was made with a companion")
    }

    /// Steps that may be recorded between [`begin_group`](Self::begin_group) and
    /// [`end_group`](Self::end_group).
    pub const GROUP: usize = GROUP;

    /// Steps made, as last heard of.
    pub fn steps_made(&self) -> u64 {
        self.control.base.into()
    }

    /// Ask for no more than `end` steps since the solver began.
    ///
    /// # Errors
    /// [`Error::Unstable`] for more steps than are counted.
    pub fn ask_until(&self, end: u64) -> Result<(), Error> {
        self.write_end(self.count(end)?);
        Ok(())
    }

    /// Record the check of the lists, and the search that may follow.
    pub fn begin_group(&self, recording: &mut Recording) {
        self.search.record(recording);
    }

    /// Record step `tick` of a group; where `loads`, it leaves how hard grains are pressed.
    pub fn record_next(&self, recording: &mut Recording, tick: u32, loads: bool) {
        self.record_step(recording, tick, loads);
    }

    /// Record the end of a group: from here on the device counts its steps as made.
    pub fn end_group(&self, recording: &mut Recording) {
        Search::settle(&self.search, recording);
    }

    /// Ask how far the device is.
    pub fn ask_progress(&self, reading: &mut Reading) -> Progress {
        Progress(reading.add(&self.arrays.control, 0..1))
    }

    /// Hear how far the device is. True if it stood still for want of room, which it now has.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    pub fn hear(&mut self, arrived: &shaders::Arrived, progress: Progress) -> Result<bool, Error> {
        let before = self.steps_made();
        let crowded = self.heed(arrived.take(progress.0)[0])?;
        self.made(self.steps_made() - before)?;
        Ok(crowded)
    }

    /// See that the lists hold for the places of now, as readings need it.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    pub fn see_to_lists(&mut self) -> Result<(), Error> {
        self.find_neighbours()
    }
}

impl Arrays {
    /// Rows of a companion that a search must carry along, with their width in vectors.
    pub(super) fn companion_rows(&self) -> Vec<(&dyn Bindable, u32)> {
        self.companion.as_ref().map_or_else(Vec::new, |companion| {
            vec![
                (&companion.forces as &dyn Bindable, 1),
                (&companion.kept, companion.width),
            ]
        })
    }
}
