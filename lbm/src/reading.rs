//! What is read from a solver. Reading never changes the run.

use crate::collide::Cell;
use crate::{Real, Snapshot, Solver, State};

impl<T: Real> Solver<T> {
    /// Pressure, flux and content now.
    pub fn snapshot(&self) -> Snapshot {
        let pressure_unit = self.scaling.pressure_unit();
        let flux_unit = self.scaling.flux_unit(self.stretch);
        let grid = self.populations.grid;
        let mut pressure = vec![0.0; self.fluid.len()];
        let mut flux = vec![[0.0; 3]; self.fluid.len()];
        let mut content = 0.0;
        for (cell, at) in grid.all().enumerate() {
            if !self.fluid[cell] {
                continue;
            }
            let arrived = self.arrived(at);
            // SAFETY: a place of the lattice.
            let (p, j) =
                unsafe { (self.kernels.reading)(&self.coefficients, grid.place(at), &arrived) };
            pressure[cell] = p.double() * pressure_unit;
            flux[cell] = [0, 1, 2].map(|axis| j[axis].double() * flux_unit[axis]);
            let pairs = arrived.forward.iter().chain(&arrived.backward);
            content += arrived.rest.double() + pairs.map(|f| f.double()).sum::<f64>();
        }
        Snapshot {
            time: self.time(),
            thickness: self.stretch * self.model.spacing,
            pressure,
            flux,
            content: content * self.model.spacing.powi(3),
        }
    }

    /// Everything that must be known to go on: a solver that takes it over makes the same bits.
    pub fn state(&self) -> State {
        let snapshot = self.snapshot();
        let populations = self.populations.grid.all().map(|at| {
            let arrived = self.arrived(at);
            let pairs = arrived.forward.iter().chain(&arrived.backward);
            let mut populations = [arrived.rest.double(); 19];
            for (to, f) in populations[1..].iter_mut().zip(pairs) {
                *to = f.double();
            }
            populations
        });
        State {
            time: snapshot.time,
            thickness: snapshot.thickness,
            populations: populations.collect(),
            pressure: snapshot.pressure,
            flux: snapshot.flux,
        }
    }

    fn arrived(&self, at: [usize; 3]) -> Cell<T> {
        // SAFETY: no thread walks while the solver is read.
        unsafe { self.populations.read(at, self.steps % 2 == 1) }
    }
}
