//! Everything that must be known to go on.

use crate::Model;

/// The state of the water at one instant, SI units, one entry for each cell: x fastest, then
/// y, then z.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Simulated time [s].
    pub time: f64,
    /// Height of the cells [m].
    pub thickness: f64,
    /// Pressure beyond that at rest [Pa]; zero in solid cells.
    pub pressure: Vec<f64>,
    /// Velocity in free water, Darcy flux in a bed [m/s].
    pub flux: Vec<[f64; 3]>,
    /// The populations of each cell in lattice units, from a solver with the same model; they
    /// are what counts then. Empty: populations in equilibrium with pressure and flux.
    pub populations: Vec<[f64; 19]>,
}

impl State {
    /// Water at rest at time zero, in cubic cells.
    pub fn at_rest(model: &Model) -> Self {
        let count = model.cells.iter().product();
        Self {
            time: 0.0,
            thickness: model.spacing,
            pressure: vec![0.0; count],
            flux: vec![[0.0; 3]; count],
            populations: Vec::new(),
        }
    }
}
