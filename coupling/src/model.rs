//! The checked description of the water in a bed, in SI numbers.

use crate::Resistance;
use lbm::{Fluid, Side};

/// Everything about the water that is not its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Number of cells along x, y and, between the walls, along z. Cells are square; about two
    /// grain diameters are right, with which a kernel of one cell goes.
    pub cells: [usize; 3],
    /// What fills the pores.
    pub fluid: Fluid,
    /// What resists its flow.
    pub resistance: Resistance,
    /// The water at the bottom and the top wall: tight is [`Side::FreeSlip`], drained
    /// [`Side::Pressure`], which acts on the wall too.
    pub sides: [Side; 2],
    /// What the stress on a wall that is pushed is meant to be.
    pub normal_stress: NormalStress,
    /// Where the water breaks; none: it bears any tension.
    pub cavitation: Option<Cavitation>,
    /// Load of a grain, over the mean one, at which it counts half: grains with less than that
    /// are loose (see `load.rs`).
    pub loose: f64,
    /// Time over which loads are averaged [s].
    pub load_memory: f64,
    /// Grain steps from one exchange between grains and water to the next; none: chosen.
    pub exchange: Option<u64>,
    /// Grain steps from one fluid step to the next, a multiple of those of an exchange; none: chosen
    /// from accuracy.
    pub interval: Option<u64>,
    /// Grain steps between two renewals of the weights, which are made at neighbour searches too;
    /// none: as many as 0.4 times that takes, and 64 at least.
    pub renewal: Option<u64>,
    /// Stiffness M of the skeleton [Pa], if it is known: for the report, and for the choice of
    /// sub-steps.
    pub stiffness: Option<f64>,
    /// Does the pressure follow the grains between two fluid steps? Without it stiff water is
    /// unstable: kept to show that.
    #[doc(hidden)]
    pub predicts: bool,
}

impl Model {
    /// Tight walls, total stress, no cavitation, and defaults that were found accurate.
    pub fn new(cells: [usize; 3], fluid: Fluid, resistance: Resistance) -> Self {
        Self {
            cells,
            fluid,
            resistance,
            sides: [Side::FreeSlip, Side::FreeSlip],
            normal_stress: NormalStress::Total,
            cavitation: None,
            loose: 1.0,
            load_memory: 1e-3,
            exchange: None,
            interval: None,
            renewal: None,
            stiffness: None,
            predicts: true,
        }
    }
}

impl Model {
    /// Grain steps of this length [s] between two renewals of the weights. Where these change because
    /// grains move there is a neighbour search; else they do with the loads, which are averaged.
    pub(crate) fn renews_every(&self, step: f64) -> u64 {
        let steps = 0.4 * self.load_memory / step;
        self.renewal.unwrap_or((steps as u64).max(64))
    }
}

/// What a normal stress on a wall is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalStress {
    /// Grains and water carry it together.
    Total,
    /// The grains carry it: the pressure at the wall, prescribed where it is drained and that of
    /// its cells where it is tight, is added to the load.
    Effective,
}

/// The least pressure of the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cavitation {
    /// Pressure at the top wall at which vapour opens [Pa], as the deviation that p is: vapour
    /// pressure less that of the water at rest there, -1e5 Pa under an open sky. Farther down it
    /// is lower by the weight of the water.
    pub pressure: f64,
}
