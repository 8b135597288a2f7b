//! Reading a solver on a device; it never changes the run. Twin: shaders/lbm/snapshot.wgsl.

use super::solver::Solver;
use crate::{Error, Snapshot};

/// Pressure, flux, and content in two parts.
const NUMBERS: usize = 6;

impl Solver {
    /// Pressure, flux and content now.
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn snapshot(&self) -> Result<Snapshot, Error> {
        let pressure_unit = self.scaling.pressure_unit();
        let flux_unit = self.scaling.flux_unit(self.stretch);
        let mut pressure = vec![0.0; self.fluid.len()];
        let mut flux = vec![[0.0; 3]; self.fluid.len()];
        let mut content = 0.0;
        self.read_slabs(&self.see, NUMBERS, |slab| {
            for cell in slab.cells().filter(|&cell| self.fluid[cell]) {
                let number = |number| f64::from(slab.at(cell, number));
                pressure[cell] = number(0) * pressure_unit;
                flux[cell] = [0, 1, 2].map(|axis| number(1 + axis) * flux_unit[axis]);
                content += number(4) + number(5);
            }
        })?;
        Ok(Snapshot {
            time: self.time(),
            thickness: self.stretch * self.model.spacing,
            pressure,
            flux,
            content: content * self.model.spacing.powi(3),
        })
    }
}
