//! What cells are told from outside, from the description.

use super::Coefficients;
use crate::grid::Grid;
use crate::lanes::Real;
use crate::{Model, Scaling};

impl<T: Real> Coefficients<T> {
    /// What follows from the height of the cells.
    pub fn fill_constants(&mut self, model: &Model, scaling: &Scaling, stretch: f64) {
        self.omega_even = T::of(1.0 / scaling.tau_even);
        self.omega_odd = T::of(1.0 / scaling.tau_odd);
        let force = scaling.force(model.acceleration, stretch);
        self.half_force = force.map(|f| T::of(0.5 * f));
        self.drag_stretch = [T::of(1.0 / stretch), T::of(stretch)];
        self.flatness = T::of(1.0 / stretch);
    }

    /// What follows from the bed.
    pub fn fill_fields(&mut self, model: &Model, scaling: &Scaling, grid: &Grid) {
        let Some(bed) = &model.bed else {
            return;
        };
        let fill = |to: &mut Vec<T>, of: &dyn Fn(usize) -> f64| {
            // Places between rows are never read, but must be numbers.
            to.resize(grid.places(), T::default());
            for (cell, at) in grid.all().enumerate() {
                to[grid.place(at)] = T::of(of(cell));
            }
        };
        fill(&mut self.inverse_storage, &|cell| {
            1.0 / scaling.storage(bed.porosity.at(cell))
        });
        fill(&mut self.half_drag, &|cell| {
            0.5 * scaling.drag(bed.permeability.at(cell))
        });
        if let Some(b) = &bed.forchheimer {
            fill(&mut self.half_forchheimer, &|cell| {
                0.5 * scaling.forchheimer(b.at(cell))
            });
        }
        if model.inertia {
            fill(&mut self.inverse_porosity, &|cell| {
                1.0 / bed.porosity.at(cell)
            });
        }
    }

    /// Content that comes in per step for sources of so much per volume and time [1/s].
    pub fn fill_source(&mut self, source: &[f64], scaling: &Scaling, stretch: f64, grid: &Grid) {
        self.source.resize(grid.places(), T::default());
        for (&rate, at) in source.iter().zip(grid.all()) {
            self.source[grid.place(at)] = T::of(scaling.source(rate, stretch));
        }
    }
}
