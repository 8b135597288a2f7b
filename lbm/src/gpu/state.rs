//! Populations to a device and back. Twin: shaders/lbm/state.wgsl.

use super::bindings::POPULATIONS;
use super::solver::Solver;
use crate::start::Start;
use crate::{Error, State};

impl Solver {
    /// Begin with `state`, before step zero.
    pub(super) fn fill(&self, state: &State) -> Result<(), Error> {
        let start = Start {
            model: &self.model,
            scaling: &self.scaling,
            coefficients: &self.coefficients,
            state,
        };
        self.write_slabs(&self.give, POPULATIONS, |slab| {
            for cell in slab.cells().filter(|&cell| self.fluid[cell]) {
                let arrived = start.arrived(cell, self.place(cell));
                let pairs = arrived.forward.iter().chain(&arrived.backward);
                for (number, f) in [arrived.rest].iter().chain(pairs).enumerate() {
                    *slab.at_mut(cell, number) = *f;
                }
            }
        })
    }

    /// Everything that must be known to go on: a solver that takes it over on the same device
    /// makes the same bits. It may also go on on the CPU.
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn state(&self) -> Result<State, Error> {
        let snapshot = self.snapshot()?;
        let mut populations = vec![[0.0; POPULATIONS]; self.fluid.len()];
        self.read_slabs(&self.take, POPULATIONS, |slab| {
            for cell in slab.cells().filter(|&cell| self.fluid[cell]) {
                for (number, f) in populations[cell].iter_mut().enumerate() {
                    *f = slab.at(cell, number).into();
                }
            }
        })?;
        Ok(State {
            time: snapshot.time,
            thickness: snapshot.thickness,
            pressure: snapshot.pressure,
            flux: snapshot.flux,
            populations,
        })
    }

    /// The place of a cell in the lattice.
    fn place(&self, cell: usize) -> usize {
        let [nx, ny, _] = self.grid.cells;
        self.grid.place([cell % nx, cell / nx % ny, cell / nx / ny])
    }
}
