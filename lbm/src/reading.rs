//! What is read from a solver. Reading never changes the run.

use crate::collide::Cell;
use crate::{Real, Snapshot, Solver, State};
use rayon::prelude::*;

impl<T: Real> Solver<T> {
    /// Pressure, flux and content now.
    pub fn snapshot(&self) -> Snapshot {
        let [nx, ny, nz] = self.model.cells;
        let layer = nx * ny;
        let mut pressure = vec![0.0; nz * layer];
        let mut flux = vec![[0.0; 3]; nz * layer];
        let read = |(z, (pressure, flux))| self.read_layer(z, pressure, flux);
        // Layer by layer, so that the sum does not depend on the number of threads.
        let contents: Vec<f64> = match &self.pool {
            None => {
                let layers = pressure.chunks_mut(layer).zip(flux.chunks_mut(layer));
                layers.enumerate().map(read).collect()
            }
            Some(pool) => pool.install(|| {
                let layers = pressure.par_chunks_mut(layer);
                let layers = layers.zip(flux.par_chunks_mut(layer));
                layers.enumerate().map(read).collect()
            }),
        };
        Snapshot {
            time: self.time(),
            thickness: self.stretch * self.model.spacing,
            pressure,
            flux,
            content: contents.iter().sum::<f64>() * self.model.spacing.powi(3),
        }
    }

    /// Pressure and flux of the cells of a layer, and what they contain, in cells.
    fn read_layer(&self, z: usize, pressure: &mut [f64], flux: &mut [[f64; 3]]) -> f64 {
        let first = z * pressure.len();
        let mut content = 0.0;
        for (cell, (pressure, flux)) in pressure.iter_mut().zip(flux).enumerate() {
            if let Some(found) = self.read_cell(first + cell) {
                (*pressure, *flux) = (found.0, found.1);
                content += found.2;
            }
        }
        content
    }

    /// Pressure and flux of a cell, and what it contains, in cells; none of a solid one.
    fn read_cell(&self, cell: usize) -> Option<(f64, [f64; 3], f64)> {
        if !self.fluid[cell] {
            return None;
        }
        let pressure_unit = self.scaling.pressure_unit();
        let flux_unit = self.scaling.flux_unit(self.stretch);
        let [nx, ny, _] = self.model.cells;
        let at = [cell % nx, cell / nx % ny, cell / (nx * ny)];
        let arrived = self.arrived(at);
        let place = self.populations.grid.place(at);
        // SAFETY: a place of the lattice.
        let (p, j) = unsafe { (self.kernels.reading)(&self.coefficients, place, &arrived) };
        let flux = [0, 1, 2].map(|axis| j[axis].double() * flux_unit[axis]);
        let pairs = arrived.forward.iter().chain(&arrived.backward);
        let content = arrived.rest.double() + pairs.map(|f| f.double()).sum::<f64>();
        Some((p.double() * pressure_unit, flux, content))
    }

    /// Mean flux along z of a layer of cells [m/s], as a volume per area and time.
    pub fn upward_flux(&self, layer: usize) -> f64 {
        let [nx, ny, _] = self.model.cells;
        let cells = layer * nx * ny..(layer + 1) * nx * ny;
        let fluxes = cells.filter_map(|cell| Some(self.read_cell(cell)?.1[2]));
        fluxes.sum::<f64>() / (nx * ny) as f64
    }

    /// Volume of water in each cell beyond that at zero pressure [m³], into `to`: x fastest, then
    /// y, then z. Far cheaper than a snapshot.
    ///
    /// # Panics
    /// If `to` has not one place for each cell.
    pub fn contents(&self, to: &mut [f64]) {
        assert_eq!(to.len(), self.fluid.len(), "one place for each cell");
        // SAFETY: no thread walks while the solver is read.
        unsafe { self.populations.contents(self.steps % 2 == 1, to) };
        let unit = self.scaling.spacing.powi(3);
        for (content, fluid) in to.iter_mut().zip(&self.fluid) {
            *content *= if *fluid { unit } else { 0.0 };
        }
    }

    /// Everything that must be known to go on: a solver that takes it over makes the same bits.
    pub fn state(&self) -> State {
        let snapshot = self.snapshot();
        let all = self.populations.grid.all();
        let populations = all.map(|at| self.arrived(at).populations());
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
