//! The water of a bed, and its own steps.

mod companion;
mod drain;
mod flow;
mod lay;
mod pending;
mod reading;
mod weigh;

pub(crate) use pending::Pending;
pub use reading::{Snapshot, State};

use crate::choice::{Steps, fluid_model};
use crate::drift::Drift;
use crate::exchange::Exchange;
use crate::faces::{DRAG_EVERY, Fields, Frozen, Pass};
use crate::kernels::Kernels;
use crate::lattice::Lattice;
use crate::ledger::Books;
use crate::load::Loads;
use crate::report::Events;
use crate::softness::Softness;
use crate::trend::Times;
use crate::{Error, Model};
use flow::Flow;
use weigh::span;
pub(crate) use weigh::volume;

/// Pore water that goes along with the grains of a `dem` solver, through a kernel that reaches
/// `N` cells along each axis: 3, a hat of half width one cell, or 5, one of two.
pub struct Water<const N: usize> {
    pub(crate) model: Model,
    pub(crate) lattice: Lattice,
    /// Grain step [s].
    pub(crate) step: f64,
    /// Steps made when the fluid stepped last, and when weights were renewed last.
    fluid_at: u64,
    renewed_at: u64,
    pub(crate) steps: Steps,
    /// Indices of the bottom and the top wall in the grains' model.
    pub(crate) walls: [usize; 2],
    pub(crate) loads: Loads,
    /// Part of their drag that loose grains get.
    towed: f64,
    pub(crate) kernels: Kernels<N>,
    pub(crate) exchange: Exchange,
    pub(crate) frozen: Frozen,
    pub(crate) fields: Fields,
    pub(crate) books: Books,
    pub(crate) drift: Drift,
    pub(crate) flow: Flow,
    /// What went wrong with it.
    fault: Option<Error>,
    /// The cells of `lbm`, in the order here.
    order: Vec<u32>,
    /// Content of the lattice [m³], in the order here.
    pub(crate) content: Vec<f64>,
    /// Volume of vapour [m³]: it stands in the content of the lattice, but is no water.
    pub(crate) vapour: Vec<f64>,
    /// Least pressure [Pa]; minus infinity without cavitation.
    pub(crate) least: Vec<f64>,
    /// Volume of solid [m³], and β V_p [m³/Pa].
    pub(crate) solid: Vec<f64>,
    pub(crate) storage: Vec<f64>,
    /// Weight of the displaced water along -z of each grain, in the solver's order [N].
    pub(crate) lift: Vec<f64>,
    /// Volume that left through the bottom and the top since it was made [m³].
    left: [f64; 2],
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
            steps: Steps::EVERY_ONE,
            walls,
            loads: Loads::default(),
            towed: model.towed(porosity),
            kernels: Kernels::choose(),
            exchange: Exchange::default(),
            frozen: Frozen::default(),
            fields: Fields::new::<N>(&lattice),
            books: Books::new(bed.model.ledger),
            drift: Drift::default(),
            flow: Flow::Lattice(lbm::Solver::new(first, at_rest, 1)?),
            fault: None,
            order: (0..count).map(|k| lattice.cell_of_lbm(k) as u32).collect(),
            content: vec![0.0; count],
            vapour: vec![0.0; count],
            least: vec![f64::NEG_INFINITY; count],
            solid: vec![0.0; count],
            storage: vec![0.0; count],
            lift: Vec::new(),
            left: [0.0; 2],
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
        Softness::judge(&water.model, water.porosity())?;
        water.begin(&bed, state)?;
        water.open_books(&bed);
        Ok(water)
    }

    /// Mean of the bed.
    pub(crate) fn porosity(&self) -> f64 {
        1.0 - self.solid.iter().sum::<f64>() / (self.lattice.area() * self.height())
    }

    /// From the bottom to the top wall [m].
    fn height(&self) -> f64 {
        self.lattice.height * self.lattice.cells[2] as f64
    }

    /// Flux at the last fluid step [m/s], one entry a cell in the order of `lbm`.
    pub(crate) fn flux(&self) -> Vec<[f64; 3]> {
        match &self.flow {
            Flow::Lattice(solver) => solver.snapshot().flux,
            Flow::Open(open) => open.flux_of_cells(&self.lattice),
        }
    }

    /// Are the pores open, so that the water's own mass holds it?
    pub(crate) fn is_open(&self) -> bool {
        matches!(self.flow, Flow::Open(_))
    }

    pub(crate) fn resistance(&self, porosity: f64, flux: [f64; 3]) -> f64 {
        let flux = flux.iter().map(|q| q * q).sum::<f64>().sqrt();
        self.model.resistance.at(&self.model.fluid, porosity, flux)
    }

    /// The pressure of a cell from which this volume [m³] has gone.
    #[inline]
    pub(crate) fn pressure_of(&self, cell: usize, gone: f64) -> f64 {
        let water = self.content[cell] - self.vapour[cell] - gone;
        (water / self.storage[cell]).max(self.least[cell])
    }

    pub(crate) fn drains(&self, step: u64) -> bool {
        step - self.fluid_at >= self.steps.interval
    }

    fn renews(&self, step: u64) -> bool {
        step >= self.renewed_at + self.model.renews_every(self.step)
    }

    /// Steps from one drag of loose grains to the next.
    fn drags_every(&self) -> u64 {
        self.steps.exchange.max(DRAG_EVERY)
    }

    /// Are loose grains dragged at the exchange of this step? Not with the forces at which water
    /// joins, nor with weights that faces had not when they took.
    fn drags(&self, step: u64) -> bool {
        step > 0 && step.is_multiple_of(self.drags_every()) && self.renewed_at != step
    }

    pub(crate) fn pass(&self) -> Pass<'_, N> {
        self.pass_over(&self.exchange)
    }

    fn pass_over<'a>(&'a self, exchange: &'a Exchange) -> Pass<'a, N> {
        Pass {
            lattice: &self.lattice,
            kernels: &self.kernels,
            exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
            step: self.step,
            share: None,
        }
    }

    /// At the exchange of this step.
    fn pass_at(&self, step: u64) -> Pass<'_, N> {
        let share = 1.0 / self.steps.exchange as f64;
        Pass {
            share: self.drags(step).then_some(share),
            ..self.pass()
        }
    }

    /// Times of the exchange of this step.
    fn times(&self, moved: &dem::Moved) -> Times {
        Times {
            passed: moved.passed.map(|steps| steps as f64 * self.step),
            ahead: self.steps_ahead(moved.step) * self.step,
        }
    }

    /// Steps from the exchange of this one to the middle of the kicks that it makes.
    fn steps_ahead(&self, step: u64) -> f64 {
        let every = self.steps.exchange;
        0.5 * (every - step % every - 1) as f64
    }
}
