//! The checked description of what acts on the grains, in SI numbers.

use crate::contact::ContactLaw;
use glam::DVec3;

/// Everything about a run that is not its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The box along x and y.
    pub domain: Domain,
    /// Acceleration of gravity [m/s²].
    pub gravity: DVec3,
    /// How grains push each other and the walls.
    pub law: ContactLaw,
    /// The walls.
    pub walls: Vec<Wall>,
    /// What moves the grains whose constraint is `Driven`; none: they stand still.
    pub drive: Option<Drive>,
    /// Time step [s].
    pub step: f64,
    /// Surplus of the neighbour search over touching [m]; none: chosen and adapted
    /// from the way grains travel between searches.
    pub skin: Option<f64>,
    /// Keep the sums of dissipated energy? Costs a tenth of the step.
    pub ledger: bool,
}

/// The box along x and y, from 0 to `size`. Along z only walls bound the grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Length along x and y [m].
    pub size: [f64; 2],
    /// Is the box periodic along x and y?
    pub periodic: [bool; 2],
}

impl Domain {
    /// Horizontal area of the box [m²].
    pub fn area(&self) -> f64 {
        self.size[0] * self.size[1]
    }
}

/// A plane with grains on one side.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Name in outputs: `top`, `bottom`.
    pub name: String,
    /// Unit normal, pointing into the grains.
    pub normal: DVec3,
    /// How it touches grains.
    pub surface: Surface,
    /// How it moves along its normal.
    pub motion: WallMotion,
}

/// How a wall touches grains; stiffness and damping are those of the contact law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Surface {
    /// Only the normal part of the law.
    #[default]
    Frictionless,
    /// The whole law.
    Full,
}

/// How a wall moves along its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WallMotion {
    /// Stands still.
    Held,
    /// Moves at this velocity [m/s], positive towards the grains.
    Velocity(f64),
    /// Pushed against the grains by a stress, it moves as a body:
    /// M dv/dt = σ(t) A - F - c v, with F the force of the grains.
    Stress(StressLoad),
}

/// A normal stress on a wall, σ(t) = mean + amplitude sin(2π frequency t), with t the
/// time of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressLoad {
    /// Mean stress [Pa], positive in compression.
    pub mean: f64,
    /// Amplitude of the modulation [Pa].
    pub amplitude: f64,
    /// Frequency of the modulation [Hz].
    pub frequency: f64,
    /// Area on which the stress acts [m²].
    pub area: f64,
    /// Mass of the wall M [kg].
    pub mass: f64,
    /// Damping of the wall c [N s/m].
    pub damping: f64,
}

impl StressLoad {
    /// Stress at time `t` [s], in Pa.
    pub fn stress(&self, t: f64) -> f64 {
        // No sine for a constant load: the product would still be exact, the cost is not nil.
        if self.amplitude == 0.0 {
            return self.mean;
        }
        self.mean + self.amplitude * (std::f64::consts::TAU * self.frequency * t).sin()
    }
}

/// What moves the driven layer along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Every driven grain has this velocity [m/s].
    Velocity(f64),
    /// The layer moves as one rigid body under its contact forces and this shear
    /// stress [Pa] times the area of the box.
    ShearStress(f64),
}
