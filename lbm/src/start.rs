//! From a state to what arrived at the cells.

use crate::collide::{Cell, Coefficients, equilibrium};
use crate::lanes::Real;
use crate::{Model, Scaling, State};

/// What is needed to read a state.
pub(crate) struct Start<'a, T> {
    pub model: &'a Model,
    pub scaling: &'a Scaling,
    pub coefficients: &'a Coefficients<T>,
    pub state: &'a State,
}

impl<T: Real> Start<'_, T> {
    /// What arrived at `cell`, which lies at `place` of the lattice.
    pub fn arrived(&self, cell: usize, place: usize) -> Cell<T> {
        if let Some(populations) = self.state.populations.get(cell) {
            return Cell::of_populations(populations);
        }
        let stretch = self.state.thickness / self.model.spacing;
        let pressure = self.state.pressure[cell] / self.scaling.pressure_unit();
        let unit = self.scaling.flux_unit(stretch);
        let j = [0, 1, 2].map(|axis| self.state.flux[cell][axis] / unit[axis]);
        equilibrium(self.coefficients, self.model, place, pressure, j)
    }
}
