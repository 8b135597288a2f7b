//! The solver on a device: it is told to advance by n steps, and is then read.

use super::arrays::Arrays;
use super::control::Control;
use super::numbers::{self, Numbers};
use super::search::{self, Search};
use super::steps::{self, Dispatches, Step, bind_search};
use super::sums::Totals;
use crate::{Error, Ledger, Model, Outside, State};
use glam::DVec3;
use shaders::{Device, Flags, Kernel};

/// Grains in motion on a device.
pub struct Solver {
    pub(super) device: Device,
    pub(super) model: Model,
    pub(super) numbers: Numbers,
    /// The state that it began with.
    pub(super) start: State,
    pub(super) arrays: Arrays,
    pub(super) flags: Flags,
    /// The same, with the parts that arrays lie in: what `step` and `measure` are compiled with.
    pub(super) compiled: Flags,
    pub(super) search_kernels: search::Kernels,
    pub(super) search: Search,
    pub(super) touching_room: usize,
    pub(super) step: Step,
    pub(super) measure: Kernel,
    /// Forces and torques from outside, by identity, while there are any.
    pub(super) outside: Option<Vec<[DVec3; 2]>>,
    /// The dispatches of a step.
    pub(super) dispatches: Option<Dispatches>,
    /// As last heard of.
    pub(super) control: Control,
    /// Forces of the start on the walls, the held and the driven layer [N].
    pub(super) forces_at_start: Vec<f64>,
    /// Sums that were taken off the device.
    pub(super) totals: Totals,
    /// Steps since sums were taken.
    pub(super) since_taken: u64,
    pub(super) ledger_start: Ledger,
}

impl Solver {
    /// Take over `state` under `model` on `device`.
    ///
    /// Periodic lengths become whole units of the positions, at most half a unit longer or
    /// shorter ([`Grid::domain`](super::fixed::Grid::domain)): ask [`model`](Self::model). The same state gives the same
    /// bits on the same device, however many steps are asked for at a time.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a description or state that cannot be right, or that the
    /// numbers of the GPU cannot hold; [`Error::Device`] if the device fails or has too
    /// little memory.
    pub fn new(device: &Device, model: Model, state: State) -> Result<Self, Error> {
        let lanes = numbers::lanes(device, state.grains.len());
        Self::with_lanes(device, lanes, model, state)
    }

    /// The same with `lanes` threads for each grain: 1, 2, 4 or 8. Sums of forces depend on it by
    /// rounding.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn with_lanes(
        device: &Device,
        lanes: u32,
        model: Model,
        state: State,
    ) -> Result<Self, Error> {
        Self::build(device, lanes, None, model, state)
    }

    pub(super) fn build(
        device: &Device,
        lanes: u32,
        companion: Option<usize>,
        mut model: Model,
        mut state: State,
    ) -> Result<Self, Error> {
        crate::check::check(&model, &state)?;
        let drive = crate::start::constrain(&model, &mut state);
        let numbers = Numbers::of(&model, &state, lanes, companion)?;
        model.domain = numbers.grid.domain(&model.domain);
        let arrays = Arrays::new(device, &numbers, &model, &state, drive)?;
        let histories = arrays.entries.histories().count() > 0;
        let mut search_kernels = search::Kernels::new(device, histories)?;
        let touching = numbers.touching;
        let setting = numbers.setting(&model);
        let search = bind_search(device, &mut search_kernels, &setting, &arrays, touching)?;
        let flags = numbers.flags(&model);
        let compiled = arrays.entries.flags(device, &flags);
        let step = Step::new(device, &compiled)?;
        let measure = steps::measure(device, &compiled)?;
        let mut solver = Self {
            device: device.clone(),
            model,
            start: state,
            arrays,
            flags,
            compiled,
            search_kernels,
            search,
            touching_room: touching,
            step,
            measure,
            outside: None,
            dispatches: None,
            control: Control::default(),
            forces_at_start: Vec::new(),
            totals: Totals::new(numbers.slots),
            numbers,
            since_taken: 0,
            ledger_start: Ledger::default(),
        };
        solver.bind_steps()?;
        solver.begin()?;
        Ok(solver)
    }

    /// Find neighbours and measure the forces of the start.
    fn begin(&mut self) -> Result<(), Error> {
        self.find_neighbours()?;
        if self.control.lost > 0 {
            return Err(Error::Invalid(format!(
                "{} contacts of the state join grains that are not near each other",
                self.control.lost
            )));
        }
        let reading = self.look()?;
        // Sums over steps leave out the forces of the start.
        self.forces_at_start = reading.forces_now(self);
        self.ledger_start = reading.energies_at_start(self);
        Ok(())
    }

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// [`Error::Unstable`] when the numbers run away, [`Error::Device`] when the device fails.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        // Forces from outside are those of the steps made.
        if steps == 0 {
            return Ok(());
        }
        self.change_outside(None)?;
        self.walk(steps)
    }

    /// Advance by `steps` time steps under constant `outside` forces.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance), and [`Error::Invalid`] for forces that are not one
    /// for each grain, or no numbers.
    pub fn advance_with(&mut self, steps: u64, outside: Outside) -> Result<(), Error> {
        outside.check(self.start.grains.len())?;
        if steps == 0 {
            return Ok(());
        }
        let constraints = &self.start.grains.constraint;
        let rows = constraints.iter().enumerate().map(|(k, constraint)| {
            let [free, turns] = constraint.freedom();
            [free * outside.force[k], turns * outside.torque[k]]
        });
        self.change_outside(Some(rows.collect()))?;
        self.walk(steps)
    }

    /// The description it was made with, periodic lengths in whole units.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Number of neighbour searches so far.
    pub fn searches(&self) -> u64 {
        u64::from(self.control.searches)
    }

    /// Number of near pairs that each step looks at.
    pub fn near_pairs(&self) -> usize {
        self.control.entries as usize / 2
    }

    /// Memory in use on the device [bytes].
    pub fn memory(&self) -> u64 {
        self.arrays.bytes() + self.search.bytes()
    }

    /// Threads that share a grain.
    pub fn lanes(&self) -> u32 {
        self.numbers.lanes
    }

    /// What the scene compiles in.
    pub fn flags(&self) -> &Flags {
        &self.flags
    }
}
