//! The water of a bed, and its own steps.

mod companion;
mod reading;
mod weigh;

pub use reading::{Snapshot, State};

use crate::choice::{Situation, Steps, fluid_model};
use crate::exchange::Exchange;
use crate::faces::{Fields, Frozen, Pass, drags};
use crate::lattice::Lattice;
use crate::load::Loads;
use crate::report::Events;
use crate::{Error, Model};
use weigh::{span, volume};

/// Pore water that goes along with the grains of a `dem` solver, through a kernel that reaches
/// `N` cells along each axis: 3, a hat of half width one cell, or 5, one of two.
pub struct Water<const N: usize> {
    pub(crate) model: Model,
    pub(crate) lattice: Lattice,
    /// Grain step [s].
    step: f64,
    /// Steps made when the fluid stepped last, and when weights were renewed last.
    fluid_at: u64,
    renewed_at: u64,
    pub(crate) steps: Steps,
    /// Indices of the bottom and the top wall in the grains' model.
    walls: [usize; 2],
    pub(crate) loads: Loads,
    exchange: Exchange<N>,
    frozen: Frozen,
    fields: Fields,
    pub(crate) fluid: lbm::Solver<f64>,
    /// Content of the lattice [m³], in the order here.
    content: Vec<f64>,
    /// Volume of vapour [m³]: it stands in the content of the lattice, but is no water.
    vapour: Vec<f64>,
    /// Least pressure [Pa]; minus infinity without cavitation.
    least: Vec<f64>,
    /// Volume of solid [m³], and β V_p [m³/Pa].
    pub(crate) solid: Vec<f64>,
    storage: Vec<f64>,
    /// Weight of the displaced water along -z of each grain, in the solver's order [N].
    lift: Vec<f64>,
    /// Mean density of the grains [kg/m³].
    pub(crate) density: f64,
    pub(crate) events: Events,
    scratch: Scratch,
}

/// Arrays that would else be allocated again and again.
#[derive(Default)]
struct Scratch {
    loads: Vec<f64>,
    rates: Vec<f64>,
    of_lbm: Vec<f64>,
}

impl<const N: usize> Water<N> {
    /// Water in the bed of `grains` as it is now, with `state`, or at rest.
    ///
    /// # Errors
    /// [`Error`] for a description that cannot be right, or stable, or accurate.
    pub fn new(model: Model, grains: &dem::Solver, state: Option<&State>) -> Result<Self, Error> {
        let bed = grains.bed();
        let (walls, mut lattice) = crate::check::check::<N>(&model, bed.model)?;
        span(&mut lattice, walls, &bed);
        let count = lattice.count();
        let volume: f64 = (0..bed.id.len()).map(|k| volume(bed.position[k])).sum();
        let porosity = (1.0 - volume / (count as f64 * lattice.volume())).clamp(0.05, 0.95);
        // A first lattice of any permeability: the renewal below lays the right one.
        let uniform = lbm::Bed {
            porosity: lbm::Field::Uniform(porosity),
            permeability: lbm::Field::Uniform(1e-12),
            forchheimer: None,
        };
        let first = fluid_model(&model, lattice.spacing, uniform);
        let at_rest = lbm::State {
            thickness: lattice.height,
            ..lbm::State::at_rest(&first)
        };
        let mut water = Self {
            step: bed.model.step,
            fluid_at: 0,
            renewed_at: 0,
            steps: Steps {
                interval: 1,
                sub_steps: 1,
            },
            walls,
            loads: Loads::default(),
            exchange: Exchange::new(&lattice, Vec::new(), Vec::new()),
            frozen: Frozen::default(),
            fields: Fields::new(&lattice),
            fluid: lbm::Solver::new(first, at_rest, 1)?,
            content: vec![0.0; count],
            vapour: vec![0.0; count],
            least: vec![f64::NEG_INFINITY; count],
            solid: vec![0.0; count],
            storage: vec![0.0; count],
            lift: Vec::new(),
            density: bed.mass.iter().sum::<f64>() / volume,
            events: Events::default(),
            scratch: Scratch::default(),
            model,
            lattice,
        };
        if let Some(state) = state {
            water.loads.mean.clone_from(&state.loads);
            water.loads.read_at = bed.time;
        }
        water.fluid_at = bed.step;
        water.renewed_at = bed.step;
        water.weigh(&bed)?;
        water.begin(&bed, state)?;
        Ok(water)
    }

    /// Lay the lattice for the bed that has been weighed.
    fn begin(&mut self, bed: &dem::Bed, state: Option<&State>) -> Result<(), Error> {
        let none = vec![[0.0; 3]; self.lattice.count()];
        let flux = state.map_or(&none, |state| &state.flux);
        for cell in 0..self.lattice.count() {
            let of_lbm = self.lattice.cell_of_lbm(cell);
            let pressure = state.map_or(0.0, |state| state.pressure[of_lbm]);
            self.vapour[cell] = state.map_or(0.0, |state| state.vapour[of_lbm]);
            self.content[cell] = self.storage[cell] * pressure + self.vapour[cell];
        }
        self.lay(bed.time, flux)?;
        for cell in 0..self.lattice.count() {
            let pressure = self.pressure_of(cell, 0.0);
            self.fields.pressure.get_mut()[cell] = pressure;
        }
        Ok(())
    }

    /// A new lattice with steps chosen anew, the content of each cell kept.
    fn lay(&mut self, time: f64, flux: &[[f64; 3]]) -> Result<(), Error> {
        let bed = self.bed_of_lbm(flux);
        let mut fluid = fluid_model(&self.model, self.lattice.spacing, bed);
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
        self.steps = situation.choose(&mut fluid, self.lattice.height)?;
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
        self.fluid = lbm::Solver::new(fluid, state, 0)?;
        self.read_content();
        Ok(())
    }

    /// Greatest diffusivity in one grain step, and least storage φβ.
    fn extremes(&self, fluid: &lbm::Model) -> (f64, f64) {
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

    /// Speed of undrained sound [m/s], with a soft skeleton where its stiffness is not known.
    fn sound(&self, storage: f64) -> f64 {
        let stiffness = self.model.stiffness.unwrap_or(0.0) + 1.0 / storage;
        let solid: f64 = self.solid.iter().sum();
        let share = solid / (self.lattice.count() as f64 * self.lattice.volume());
        (stiffness / (share * self.density)).sqrt()
    }

    /// Porosity and permeability of the cells, in `lbm`'s order.
    fn bed_of_lbm(&self, flux: &[[f64; 3]]) -> lbm::Bed {
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

    fn resistance(&self, porosity: f64, flux: [f64; 3]) -> f64 {
        let flux = flux.iter().map(|q| q * q).sum::<f64>().sqrt();
        self.model.resistance.at(&self.model.fluid, porosity, flux)
    }

    /// The pressure of a cell from which this volume [m³] has gone.
    #[inline]
    fn pressure_of(&self, cell: usize, gone: f64) -> f64 {
        let water = self.content[cell] - self.vapour[cell] - gone;
        (water / self.storage[cell]).max(self.least[cell])
    }

    /// The water's own step: what has been collected is drained.
    fn drain(&mut self, step: u64) -> Result<(), Error> {
        let lattice = &self.lattice;
        let passed = (step - self.fluid_at) as f64 * self.step;
        let collected = self.fields.collected.get_mut();
        self.scratch.rates.resize(lattice.count(), 0.0);
        let mut open = 0.0;
        for (cell, collected) in collected.iter_mut().enumerate() {
            // Vapour opens where the pressure would fall below the least, and closes again.
            let held = self.storage[cell] * self.least[cell];
            let opens = match held.is_finite() {
                true => (held - (self.content[cell] - *collected)).max(-self.vapour[cell]),
                false => 0.0,
            };
            self.vapour[cell] += opens;
            open += self.vapour[cell];
            let rate = (opens - *collected) / (lattice.volume() * passed);
            self.scratch.rates[lattice.cell_of_lbm(cell)] = rate;
            *collected = 0.0;
        }
        self.events.see_vapour(open, passed);
        self.fluid
            .advance_with(self.steps.sub_steps, &self.scratch.rates)?;
        self.read_content();
        self.fluid_at = step;
        Ok(())
    }

    fn read_content(&mut self) {
        self.scratch.of_lbm.resize(self.lattice.count(), 0.0);
        self.fluid.contents(&mut self.scratch.of_lbm);
        for cell in 0..self.lattice.count() {
            self.content[cell] = self.scratch.of_lbm[self.lattice.cell_of_lbm(cell)];
        }
    }

    fn drains(&self, step: u64) -> bool {
        step - self.fluid_at >= self.steps.interval
    }

    /// Not where loose grains are dragged: what faces have taken with the old weights would be
    /// given with the new ones.
    fn renews(&self, step: u64) -> bool {
        step >= self.renewed_at + self.model.renewal && !drags(step)
    }

    fn pass(&self) -> Pass<'_, N> {
        Pass {
            lattice: &self.lattice,
            exchange: &self.exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
        }
    }
}
