//! What is read from a solver.

/// The water at one instant, SI units; fields have one entry for each cell, x fastest, then y,
/// then z, zero in solid ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Simulated time [s].
    pub time: f64,
    /// Height of the cells [m].
    pub thickness: f64,
    /// Pressure beyond that at rest [Pa].
    pub pressure: Vec<f64>,
    /// Velocity in free water, Darcy flux in a bed [m/s].
    pub flux: Vec<[f64; 3]>,
    /// Volume of water in all cells beyond that at zero pressure [m³]: what the sides and the
    /// sources brought, to rounding. (In the incompressible regime it has no meaning but this.)
    pub content: f64,
}
