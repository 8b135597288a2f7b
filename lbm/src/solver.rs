//! The solver: it is told to advance by n steps, and is then read.

use crate::check::{check_state, refuse};
use crate::clock::Clock;
use crate::collide::Coefficients;
use crate::grid::Grid;
use crate::kernels::{Kernels, Parts};
use crate::lanes::Real;
use crate::links::Links;
use crate::populations::Populations;
use crate::start::Start;
use crate::step::{Crew, shares, spans};
use crate::{Bed, Model, Scaling, State};
use std::sync::Barrier;

/// Water on a lattice of `f32` or `f64`.
pub struct Solver<T: Real> {
    pub(crate) model: Model,
    pub(crate) scaling: Scaling,
    /// None: the caller's thread does all.
    pub(crate) pool: Option<rayon::ThreadPool>,
    clock: Clock,
    pub(crate) steps: u64,
    /// Height of the cells over the spacing.
    pub(crate) stretch: f64,
    /// Is there fluid in a cell?
    pub(crate) fluid: Vec<bool>,
    pub(crate) populations: Populations<T>,
    /// What each thread sweeps.
    shares: Vec<Vec<crate::populations::Span>>,
    links: Links,
    pub(crate) coefficients: Coefficients<T>,
    pub(crate) kernels: Kernels<T>,
    kernels_with_source: Kernels<T>,
}

/// Why a solver was not made, or stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The description or the state cannot be right, or what they ask for cannot be had.
    #[error("{0}")]
    Invalid(String),
    /// The device of a solver on the GPU fails.
    #[error(transparent)]
    Device(#[from] shaders::Error),
    /// The numbers ran away.
    #[error("step {step}: {what}")]
    Unstable {
        /// Steps made since the solver began.
        step: u64,
        /// What was seen, and the remedy.
        what: String,
    },
}

impl Error {
    /// Populations are no numbers.
    pub(crate) fn run_away(step: u64, scaling: &Scaling) -> Self {
        Self::Unstable {
            step,
            what: format!(
                "populations are no numbers any more; give a step shorter than {:.3e} s or a \
                 finer spacing",
                scaling.step
            ),
        }
    }
}

/// Cells below which another thread costs more than it brings.
const CELLS_PER_THREAD: usize = 4096;

impl<T: Real> Solver<T> {
    /// Take over `state` under `model`, on up to `threads` threads (0: one for each core).
    ///
    /// The same state gives the same bits whatever `threads` is.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a description or state that cannot be right, and for what cannot
    /// be stable or accurate, with the remedy.
    pub fn new(model: Model, state: State, threads: usize) -> Result<Self, Error> {
        crate::check::check(&model)?;
        check_state(&model, &state)?;
        let scaling = Scaling::choose::<T>(&model, state.thickness)?;
        let grid = Grid::new(model.cells, model.walled());
        let count = model.cells.iter().product::<usize>();
        if u32::try_from(grid.places()).is_err() {
            return refuse(format!("{:?} cells are too many", model.cells));
        }
        let cores = || std::thread::available_parallelism().map_or(1, |n| n.get());
        let threads = if threads == 0 { cores() } else { threads };
        let threads = threads.min(count.div_ceil(CELLS_PER_THREAD));
        let pool = match threads {
            1 => None,
            _ => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                Some(pool.map_err(|e| Error::Invalid(format!("no {threads} threads: {e}")))?)
            }
        };
        let fluid = model.fluid_cells();
        let parts = Parts::of(&model);
        let mut solver = Self {
            scaling,
            pool,
            clock: Clock::new(state.time, scaling.step),
            steps: 0,
            stretch: state.thickness / model.spacing,
            populations: Populations::new(grid),
            shares: shares(&spans(&grid, &fluid), threads),
            links: Links::new(&model, &grid, &fluid),
            fluid,
            coefficients: Coefficients::default(),
            kernels: Kernels::choose(parts),
            kernels_with_source: Kernels::choose(Parts {
                source: true,
                ..parts
            }),
            model,
        };
        solver.fill_constants();
        solver.fill_fields();
        solver.fill_populations(&state);
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

    /// Memory of the populations for each cell of the domain.
    pub fn bytes_per_cell(&self) -> f64 {
        self.populations.bytes() as f64 / self.fluid.len() as f64
    }

    /// What follows from the height of the cells.
    fn fill_constants(&mut self) {
        self.coefficients
            .fill_constants(&self.model, &self.scaling, self.stretch);
    }

    /// What follows from the bed.
    fn fill_fields(&mut self) {
        self.coefficients
            .fill_fields(&self.model, &self.scaling, &self.populations.grid);
    }

    fn fill_populations(&mut self, state: &State) {
        let start = Start {
            model: &self.model,
            scaling: &self.scaling,
            coefficients: &self.coefficients,
            state,
        };
        let grid = self.populations.grid;
        for (cell, at) in grid.all().enumerate() {
            if self.fluid[cell] {
                let arrived = start.arrived(cell, grid.place(at));
                self.populations.write(at, self.steps % 2 == 1, &arrived);
            }
        }
    }

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// [`Error::Unstable`] when the numbers run away.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        self.walk(self.kernels, steps)
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
        let grid = &self.populations.grid;
        self.coefficients
            .fill_source(source, &self.scaling, self.stretch, grid);
        self.walk(self.kernels_with_source, steps)
    }

    fn walk(&mut self, kernels: Kernels<T>, steps: u64) -> Result<(), Error> {
        let barrier = Barrier::new(self.shares.len());
        let crew = Crew {
            kernels,
            populations: &self.populations,
            coefficients: &self.coefficients,
            shares: &self.shares,
            links: &self.links,
            model: &self.model,
            scaling: &self.scaling,
            stretch: self.stretch,
            clock: self.clock,
            barrier: &barrier,
        };
        let range = self.steps..self.steps + steps;
        match &self.pool {
            None => crew.walk(0, range),
            Some(pool) => {
                pool.broadcast(|context| crew.walk(context.index(), range.clone()));
            }
        }
        self.steps += steps;
        match self.populations.finite() {
            true => Ok(()),
            false => Err(Error::run_away(self.steps, &self.scaling)),
        }
    }

    /// Change the height of all cells to `thickness` [m]; each keeps its content, and pressure
    /// follows. For slow changes: the lattice needs some steps to settle.
    ///
    /// # Errors
    /// [`Error::Invalid`] in free water, with squares of the flux, or for cells too flat for
    /// this lattice.
    pub fn set_thickness(&mut self, thickness: f64) -> Result<(), Error> {
        crate::check::check_thickness(&self.model, thickness)?;
        let stretch = thickness / self.model.spacing;
        self.scaling.judge_stretch(stretch)?;
        self.stretch = stretch;
        self.fill_constants();
        Ok(())
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
            .and_then(|()| self.scaling.with_bed::<T>(&self.model, self.stretch));
        match scaling {
            Ok(scaling) => {
                self.scaling = scaling;
                self.fill_constants();
                self.fill_fields();
                Ok(())
            }
            Err(error) => {
                self.model.bed = old;
                Err(error)
            }
        }
    }
}
