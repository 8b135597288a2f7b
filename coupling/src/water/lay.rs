//! A lattice for the bed as it is: how many cells and steps, with which numbers; or none, where pores
//! are open.

use super::Water;
use super::flow::Flow;
use super::reading::State;
use crate::Error;
use crate::choice::{Situation, Steps, fluid_model};
use crate::drag::Law;
use crate::drift::Drift;
use crate::open::Open;

/// Solid fraction below which a layer of cells counts as empty.
const EMPTY: f64 = 1e-3;

impl<const N: usize> Water<N> {
    /// Lay the lattice for the bed that has been weighed.
    pub(super) fn begin(&mut self, bed: &dem::Bed, state: Option<&State>) -> Result<(), Error> {
        for cell in 0..self.lattice.count() {
            let of_lbm = self.lattice.cell_of_lbm(cell);
            let pressure = state.map_or(0.0, |state| state.pressure[of_lbm]);
            self.vapour[cell] = state.map_or(0.0, |state| state.vapour[of_lbm]);
            self.content[cell] = self.storage[cell] * pressure + self.vapour[cell];
        }
        self.lay(bed, bed.time, state.map(|state| &state.flux[..]))?;
        for cell in 0..self.lattice.count() {
            let pressure = self.pressure_of(cell, 0.0);
            self.fields.pressure.get_mut()[cell] = pressure;
            self.fields.trends.get_mut()[cell].before = pressure;
        }
        Ok(())
    }

    /// A new lattice with steps chosen anew, the content of each cell kept.
    pub(super) fn lay(
        &mut self,
        bed: &dem::Bed,
        time: f64,
        known: Option<&[[f64; 3]]>,
    ) -> Result<(), Error> {
        let none = vec![[0.0; 3]; self.lattice.count()];
        let flux = known.unwrap_or(&none);
        let pores = self.bed_of_lbm(flux);
        let mut fluid = fluid_model(&self.model, self.lattice.spacing, pores);
        let (diffusivity, storage) = self.extremes(&fluid);
        let courant =
            self.sound(storage) * self.step / self.lattice.height.min(self.lattice.spacing);
        let situation = Situation {
            model: &self.model,
            diffusivity,
            courant,
            storage: self.model.stiffness.map_or(0.0, |m| storage * m),
            step: self.step,
        };
        if situation.is_open() {
            return self.open(bed, time, known);
        }
        self.find_grains_everywhere()?;
        let height = self.lattice.height;
        self.steps = situation.choose(&mut fluid, |fluid| {
            lbm::Scaling::choose::<f64>(fluid, height)
        })?;
        self.events.diffusivity = diffusivity * self.steps.interval as f64;
        self.events.courant = courant * self.steps.interval as f64;
        let mut state = lbm::State {
            time,
            thickness: self.lattice.height,
            ..lbm::State::at_rest(&fluid)
        };
        state.flux.copy_from_slice(flux);
        for cell in 0..self.lattice.count() {
            let pressure = self.content[cell] / self.storage[cell];
            state.pressure[self.lattice.cell_of_lbm(cell)] = pressure;
        }
        self.flow = Flow::Lattice(lbm::Solver::new(fluid, state, 0)?);
        self.read_content();
        Ok(())
    }

    /// A layer of cells without a grain has no permeability of its own, and under one that is the same
    /// everywhere what it pushes falls on the few grains that touch it.
    fn find_grains_everywhere(&self) -> Result<(), Error> {
        if !matches!(self.model.resistance.law(), Law::Constant(_)) {
            return Ok(());
        }
        let nz = self.lattice.cells[2];
        let least = EMPTY * self.lattice.volume() * (self.lattice.count() / nz) as f64;
        let of_layer = |k: usize| self.solid.iter().skip(k).step_by(nz).sum::<f64>();
        let Some(empty) = (0..nz).find(|&k| of_layer(k) < least) else {
            return Ok(());
        };
        Err(Error::Invalid(format!(
            "layer {} of the {nz} layers of cells holds no grain, and yet has the permeability of a \
             bed: let the top wall down to the grains, or give a permeability or drag that follows \
             from porosity",
            empty + 1
        )))
    }

    /// The pores are open: the water's momentum from now on, the content of each cell kept.
    pub(super) fn open(
        &mut self,
        bed: &dem::Bed,
        time: f64,
        flux: Option<&[[f64; 3]]>,
    ) -> Result<(), Error> {
        crate::choice::open_is_possible(&self.model, self.density)?;
        self.steps = Steps::EVERY_ONE;
        let each = self.content.iter().zip(&self.storage);
        let pressure = each.map(|(content, storage)| content / storage).collect();
        let kept = self.books.kept;
        self.close_lattice_books();
        let open = Open::new(
            &self.model,
            &self.lattice,
            self.step,
            time,
            flux,
            pressure,
            kept,
        );
        self.flow = Flow::Open(open);
        self.drift = Drift::default();
        self.weigh(bed)
    }

    /// Greatest diffusivity in one grain step, and least storage φβ.
    pub(super) fn extremes(&self, fluid: &lbm::Model) -> (f64, f64) {
        let Some(bed) = &fluid.bed else {
            return (0.0, 0.0);
        };
        let size = self.lattice.height.min(self.lattice.spacing);
        let unit = self.step / (fluid.fluid.viscosity * size * size);
        let (mut most, mut least) = (0.0f64, f64::INFINITY);
        for cell in 0..self.lattice.count() {
            let storage = bed.porosity.at(cell) * fluid.fluid.compressibility;
            most = most.max(unit * bed.permeability.at(cell) / storage);
            least = least.min(storage);
        }
        (most, least)
    }

    /// Of the grains alone [kg/m³].
    fn bulk_density(&self) -> f64 {
        let solid: f64 = self.solid.iter().sum();
        self.density * solid / (self.lattice.count() as f64 * self.lattice.volume())
    }

    /// Speed of undrained sound [m/s], with a soft skeleton where its stiffness is not known.
    pub(super) fn sound(&self, storage: f64) -> f64 {
        let stiffness = self.model.stiffness.unwrap_or(0.0) + 1.0 / storage;
        (stiffness / self.bulk_density()).sqrt()
    }

    /// Porosity and permeability of the cells, in `lbm`'s order.
    pub(super) fn bed_of_lbm(&self, flux: &[[f64; 3]]) -> lbm::Bed {
        let count = self.lattice.count();
        let (mut porosity, mut permeability) = (vec![0.0; count], vec![0.0; count]);
        for cell in 0..count {
            let at = self.lattice.cell_of_lbm(cell);
            porosity[at] = 1.0 - self.solid[cell] / self.lattice.volume();
            let resistance = self.resistance(porosity[at], flux[at]);
            permeability[at] = self.model.fluid.viscosity / resistance;
        }
        lbm::Bed {
            porosity: lbm::Field::Cells(porosity),
            permeability: lbm::Field::Cells(permeability),
            forchheimer: None,
        }
    }
}
