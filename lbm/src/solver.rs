//! The solver: it is told to advance by n steps, and is then read.

use crate::check::{check_state, refuse};
use crate::collide::{Cell, Coefficients, equilibrium};
use crate::grid::Grid;
use crate::kernels::{Kernels, Parts};
use crate::lanes::Real;
use crate::lattice::PAIRS;
use crate::links::Links;
use crate::populations::Populations;
use crate::step::{Crew, shares, spans};
use crate::{Bed, Ends, Model, Scaling, State};
use std::sync::Barrier;

/// Water on a lattice of `f32` or `f64`.
pub struct Solver<T: Real> {
    pub(crate) model: Model,
    pub(crate) scaling: Scaling,
    /// None: the caller's thread does all.
    pool: Option<rayon::ThreadPool>,
    /// Time of step zero [s].
    start: f64,
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
    /// The numbers ran away.
    #[error("step {step}: {what}")]
    Unstable {
        /// Steps made since the solver began.
        step: u64,
        /// What was seen, and the remedy.
        what: String,
    },
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
        let walled = [0, 1, 2].map(|axis| matches!(model.ends[axis], Ends::Walls(..)));
        let grid = Grid::new(model.cells, walled);
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
        let fluid: Vec<bool> = match model.solid.is_empty() {
            true => vec![true; count],
            false => model.solid.iter().map(|solid| !solid).collect(),
        };
        let parts = Parts {
            porous: model.bed.is_some(),
            inertia: model.inertia,
            force: model.acceleration != [0.0; 3],
            forchheimer: model
                .bed
                .as_ref()
                .is_some_and(|bed| bed.forchheimer.is_some()),
            source: false,
        };
        let mut solver = Self {
            scaling,
            pool,
            start: state.time,
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
        self.start + self.steps as f64 * self.scaling.step
    }

    /// Memory of the populations for each cell of the domain.
    pub fn bytes_per_cell(&self) -> f64 {
        self.populations.bytes() as f64 / self.fluid.len() as f64
    }

    /// What follows from the height of the cells.
    fn fill_constants(&mut self) {
        let (scaling, stretch) = (&self.scaling, self.stretch);
        let k = &mut self.coefficients;
        k.omega_even = T::of(1.0 / scaling.tau_even);
        k.omega_odd = T::of(1.0 / scaling.tau_odd);
        let force = scaling.force(self.model.acceleration, stretch);
        k.half_force = force.map(|f| T::of(0.5 * f));
        k.drag_stretch = [T::of(1.0 / stretch), T::of(stretch)];
        k.flatness = T::of(1.0 / stretch);
    }

    /// What follows from the bed.
    fn fill_fields(&mut self) {
        let scaling = &self.scaling;
        let k = &mut self.coefficients;
        let Some(bed) = &self.model.bed else {
            return;
        };
        let grid = self.populations.grid;
        let fill = |to: &mut Vec<T>, of: &dyn Fn(usize) -> f64| {
            // Places between rows are never read, but must be numbers.
            to.resize(grid.places(), T::default());
            for (cell, at) in grid.all().enumerate() {
                to[grid.place(at)] = T::of(of(cell));
            }
        };
        fill(&mut k.inverse_storage, &|cell| {
            1.0 / scaling.storage(bed.porosity.at(cell))
        });
        fill(&mut k.half_drag, &|cell| {
            0.5 * scaling.drag(bed.permeability.at(cell))
        });
        if let Some(b) = &bed.forchheimer {
            fill(&mut k.half_forchheimer, &|cell| {
                0.5 * scaling.forchheimer(b.at(cell))
            });
        }
        if self.model.inertia {
            fill(&mut k.inverse_porosity, &|cell| 1.0 / bed.porosity.at(cell));
        }
    }

    fn fill_populations(&mut self, state: &State) {
        let pressure_unit = self.scaling.pressure_unit();
        let flux_unit = self.scaling.flux_unit(self.stretch);
        let grid = self.populations.grid;
        for (cell, at) in grid.all().enumerate() {
            if !self.fluid[cell] {
                continue;
            }
            let arrived = match state.populations.get(cell) {
                Some(populations) => {
                    let mut next = populations.iter().map(|&f| T::of(f));
                    let mut take = || next.next().expect("a cell has 19 populations");
                    Cell {
                        rest: take(),
                        forward: [(); PAIRS].map(|()| take()),
                        backward: [(); PAIRS].map(|()| take()),
                    }
                }
                None => {
                    let pressure = state.pressure[cell] / pressure_unit;
                    let j = [0, 1, 2].map(|axis| state.flux[cell][axis] / flux_unit[axis]);
                    equilibrium(&self.coefficients, &self.model, grid.place(at), pressure, j)
                }
            };
            self.populations.write(at, self.steps % 2 == 1, &arrived);
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
        if self.model.bed.is_none() {
            return refuse("free water takes no sources: describe a bed of porosity 1".into());
        }
        if source.len() != self.fluid.len() || !source.iter().all(|rate| rate.is_finite()) {
            return refuse(format!(
                "{} sources for {} cells: there must be a finite one for each",
                source.len(),
                self.fluid.len()
            ));
        }
        let grid = self.populations.grid;
        let to = &mut self.coefficients.source;
        to.resize(grid.places(), T::default());
        for (&rate, at) in source.iter().zip(grid.all()) {
            to[grid.place(at)] = T::of(self.scaling.source(rate, self.stretch));
        }
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
            start: self.start,
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
            false => Err(Error::Unstable {
                step: self.steps,
                what: format!(
                    "populations are no numbers any more; give a step shorter than {:.3e} s or a \
                     finer spacing",
                    self.scaling.step
                ),
            }),
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
        let same = |old: &Bed| old.forchheimer.is_some() == bed.forchheimer.is_some();
        if !self.model.bed.as_ref().is_some_and(same) {
            return refuse("a bed, or its Forchheimer's drag, cannot come or go".into());
        }
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
