//! The solver on a device: it is told to advance by n steps, and is then read.

use super::arrays::Arrays;
use super::bindings::Bindings;
use super::flags::{check_groups, flags};
use super::memory::{self, Memory};
use super::rows::Rows;
use super::setting::Setting;
use super::sides::Given;
use crate::check::{check_state, check_thickness};
use crate::clock::Clock;
use crate::collide::Coefficients;
use crate::grid::Grid;
use crate::{Bed, Error, Model, Scaling, State};
use shaders::{Bound, Device, Flags, compose};

/// Water on a lattice of `f32` on a device.
pub struct Solver {
    pub(super) device: Device,
    pub(super) model: Model,
    pub(super) scaling: Scaling,
    pub(super) clock: Clock,
    pub(super) steps: u64,
    /// Height of the cells over the spacing.
    pub(super) stretch: f64,
    /// Is there fluid in a cell?
    pub(super) fluid: Vec<bool>,
    pub(super) grid: Grid,
    pub(super) coefficients: Coefficients<f32>,
    pub(super) flags: Flags,
    pub(super) arrays: Arrays,
    /// What the sides gave to what was emitted last.
    pub(super) last: Given,
    pub(super) step: Bound,
    /// Once there were sources.
    pub(super) step_with_source: Option<Bound>,
    pub(super) finite: Bound,
    pub(super) see: Bound,
    pub(super) take: Bound,
    pub(super) give: Bound,
}

impl Solver {
    /// Take over `state` under `model` on `device`.
    ///
    /// The same state gives the same bits on the same device, however many steps are asked for
    /// at a time.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a description or state that cannot be right, for what cannot be
    /// stable or accurate in `f32`, and for more cells than the device can address;
    /// [`Error::Device`] if the device fails or has too little memory
    /// ([`Memory`] tells beforehand).
    pub fn new(device: &Device, model: Model, state: State) -> Result<Self, Error> {
        let limits = &device.adapter.limits;
        let largest = limits
            .max_buffer_size
            .min(limits.max_storage_buffer_binding_size);
        Self::with_largest(device, largest, model, state)
    }

    /// The same with arrays of the populations of at most `largest` bytes. The bits do not depend
    /// on it.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn with_largest(
        device: &Device,
        largest: u64,
        model: Model,
        state: State,
    ) -> Result<Self, Error> {
        crate::check::check(&model)?;
        check_state(&model, &state)?;
        let scaling = Scaling::choose::<f32>(&model, state.thickness)?;
        let stretch = state.thickness / model.spacing;
        let grid = memory::grid(&model);
        let count = device.adapter.limits.max_storage_buffers_per_shader_stage;
        let bindings = Bindings::new(&model, grid.places(), largest, count)?;
        check_groups(&model)?;
        let fluid = model.fluid_cells();
        let mut coefficients = Coefficients::default();
        coefficients.fill_constants(&model, &scaling, stretch);
        coefficients.fill_fields(&model, &scaling, &grid);

        let rows = Rows::new(&model, &grid, &fluid);
        let arrays = Arrays::new(device, (&model, &grid), bindings, &rows, &coefficients);
        let arrays = arrays.map_err(|error| Memory::of(&model).too_little(&model, error))?;
        let flags = flags(&model, &grid, bindings, &rows);
        let named = arrays.named();
        let bind = |path: &str, entry: &str| {
            let kernel = device.kernel(&compose(path, &flags)?, entry)?;
            kernel.bind(device, &named)
        };
        let solver = Self {
            device: device.clone(),
            scaling,
            clock: Clock::new(state.time, scaling.step),
            steps: 0,
            stretch,
            fluid,
            grid,
            coefficients,
            last: Given::fresh(),
            step: bind("lbm/step.wgsl", "time_step")?,
            step_with_source: None,
            finite: bind("lbm/finite.wgsl", "finite")?,
            see: bind("lbm/snapshot.wgsl", "see")?,
            take: bind("lbm/state.wgsl", "take")?,
            give: bind("lbm/state.wgsl", "give")?,
            model,
            arrays,
            flags,
        };
        solver.fill(&state)?;
        Ok(solver)
    }

    /// The numbers of the lattice.
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }

    /// The description.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Steps made since the solver began.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.clock.after(self.steps as f64)
    }

    /// Memory in use on the device [bytes].
    pub fn memory(&self) -> u64 {
        self.arrays.bytes()
    }

    /// What the scene compiles in.
    pub fn flags(&self) -> &Flags {
        &self.flags
    }

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// [`Error::Unstable`] when the numbers run away, [`Error::Device`] when the device fails.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        self.walk(self.step.clone(), steps)
    }

    /// Advance by `steps` time steps with a constant source of water: volume per volume of the
    /// bed and time [1/s], for each cell. A bed whose grains move apart with velocity v has the
    /// source -∇·v.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance), and [`Error::Invalid`] for sources that are not one
    /// for each cell, or no numbers, or in free water.
    pub fn advance_with(&mut self, steps: u64, source: &[f64]) -> Result<(), Error> {
        crate::check::check_source(&self.model, source)?;
        self.coefficients
            .fill_source(source, &self.scaling, self.stretch, &self.grid);
        self.arrays.write_source(&self.device, &self.coefficients)?;
        let step = match &self.step_with_source {
            Some(step) => step.clone(),
            None => {
                let module = compose("lbm/step.wgsl", &self.flags.clone().set("SOURCE"))?;
                let kernel = self.device.kernel(&module, "time_step")?;
                let step = kernel.bind(&self.device, &self.arrays.named())?;
                self.step_with_source.insert(step).clone()
            }
        };
        self.walk(step, steps)
    }

    /// Change the height of all cells to `thickness` [m]; each keeps its content, and pressure
    /// follows. For slow changes: the lattice needs some steps to settle.
    ///
    /// # Errors
    /// [`Error::Invalid`] in free water, with squares of the flux, or for cells too flat for
    /// this lattice.
    pub fn set_thickness(&mut self, thickness: f64) -> Result<(), Error> {
        check_thickness(&self.model, thickness)?;
        let stretch = thickness / self.model.spacing;
        self.scaling.judge_stretch(stretch)?;
        self.stretch = stretch;
        self.write_constants();
        Ok(())
    }

    fn write_constants(&mut self) {
        let k = &mut self.coefficients;
        k.fill_constants(&self.model, &self.scaling, self.stretch);
        let setting = Setting::new(&self.model, &self.grid, k);
        self.device.write(&self.arrays.setting, 0, &[setting]);
    }

    /// Change the bed; each cell keeps its content, and pressure follows.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a bed that cannot be right, or for which this lattice is not
    /// stable or accurate.
    pub fn set_bed(&mut self, bed: Bed) -> Result<(), Error> {
        crate::check::check_other_bed(&self.model, &bed)?;
        let old = self.model.bed.replace(bed);
        let scaling = crate::check::check(&self.model)
            .and_then(|()| self.scaling.with_bed::<f32>(&self.model, self.stretch));
        match scaling {
            Ok(scaling) => {
                self.scaling = scaling;
                self.write_constants();
                self.coefficients
                    .fill_fields(&self.model, &self.scaling, &self.grid);
                self.arrays.write_bed(&self.device, &self.coefficients)
            }
            Err(error) => {
                self.model.bed = old;
                Err(error)
            }
        }
    }
}
