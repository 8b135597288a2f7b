//! The solver of a run of water: all that the rest of the program knows of it.

use crate::backend::Machine;
use crate::scene::water::{Precision, Water};
use anyhow::{Result, ensure};
use lbm::{Error, Snapshot, Solver, State, gpu};

/// Water in motion.
pub enum Engine {
    /// On the CPU, in single precision.
    F32(Box<Solver<f32>>),
    /// On the CPU, in double precision.
    F64(Box<Solver<f64>>),
    /// On a GPU, in single precision.
    Gpu(Box<gpu::Solver>),
}

impl Engine {
    /// Take over the start of `water`.
    ///
    /// # Errors
    /// What cannot be computed, or not on this machine, with the remedy.
    pub fn new(machine: &Machine, water: &Water) -> Result<Self> {
        let (model, state) = (water.model.clone(), water.start.clone());
        Ok(match (machine, water.precision) {
            (Machine::Cpu { threads }, Precision::F32) => {
                Self::F32(Box::new(Solver::new(model, state, *threads)?))
            }
            (Machine::Cpu { threads }, Precision::F64) => {
                Self::F64(Box::new(Solver::new(model, state, *threads)?))
            }
            (Machine::Gpu(device), precision) => {
                ensure!(
                    precision == Precision::F32,
                    "a GPU computes water in f32 alone"
                );
                Self::Gpu(Box::new(gpu::Solver::new(device, model, state)?))
            }
        })
    }

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// Numbers that run away, a device that fails.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        match self {
            Self::F32(solver) => solver.advance(steps),
            Self::F64(solver) => solver.advance(steps),
            Self::Gpu(solver) => solver.advance(steps),
        }
    }

    /// Pressure, flux and content now.
    ///
    /// # Errors
    /// A device that fails.
    pub fn snapshot(&self) -> Result<Snapshot, Error> {
        match self {
            Self::F32(solver) => Ok(solver.snapshot()),
            Self::F64(solver) => Ok(solver.snapshot()),
            Self::Gpu(solver) => solver.snapshot(),
        }
    }

    /// Everything that must be known to go on.
    ///
    /// # Errors
    /// A device that fails.
    pub fn state(&self) -> Result<State, Error> {
        match self {
            Self::F32(solver) => Ok(solver.state()),
            Self::F64(solver) => Ok(solver.state()),
            Self::Gpu(solver) => solver.state(),
        }
    }

    /// Memory of the populations, or of all arrays on the device where there is one [bytes].
    pub fn memory(&self) -> u64 {
        let cells = |model: &lbm::Model| model.cells.iter().product::<usize>() as f64;
        match self {
            Self::F32(solver) => (solver.bytes_per_cell() * cells(solver.model())) as u64,
            Self::F64(solver) => (solver.bytes_per_cell() * cells(solver.model())) as u64,
            Self::Gpu(solver) => solver.memory(),
        }
    }
}
