//! Everything that must be known to go on: grains, contacts with their history, walls.

use crate::Grains;
use glam::DVec3;

/// The mechanical state of a bed at one instant, SI units, plain data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Simulated time [s].
    pub time: f64,
    /// The grains, in the order of their identities `0..n`.
    pub grains: Grains,
    /// The contacts that exist now, sorted by their two bodies.
    pub contacts: Vec<Contact>,
    /// One entry for each wall of the [`Model`](crate::Model), in its order.
    pub walls: Vec<WallState>,
}

/// The moving part of a wall, the plane { x : normal · x = offset }.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallState {
    /// Distance of the plane from the origin along its normal [m]. The normal points
    /// into the grains: a top wall at height h has normal -z and offset -h.
    pub offset: f64,
    /// Velocity along the normal [m/s]; positive towards the grains.
    pub velocity: f64,
}

/// What a grain touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Body {
    /// The grain of this identity.
    Grain(u32),
    /// The wall of this index in [`Model::walls`](crate::Model::walls).
    Wall(u32),
}

/// One contact. The normal points from `j` to `i`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Identity of the grain on which `force` acts; the smaller one of a pair.
    pub i: u32,
    /// The body that pushes it.
    pub j: Body,
    /// What the contact remembers.
    pub history: History,
    /// Force on `i` [N]; measured, not needed to go on.
    pub force: DVec3,
    /// Overlap [m]; measured.
    pub overlap: f64,
    /// From the centre of `j` (or its foot on the wall) to the centre of `i` [m]; measured.
    pub branch: DVec3,
}

/// The history of a contact, zero when it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct History {
    /// Tangential spring: elastic displacement of `i` against `j` [m].
    pub spring: DVec3,
    /// Rolling spring: elastic rolling displacement [m].
    pub rolling_spring: DVec3,
    /// Twisting spring: elastic twisting displacement [m].
    pub twisting_spring: f64,
    /// Does the contact slide, so that the dynamic limit holds?
    pub sliding: bool,
}
