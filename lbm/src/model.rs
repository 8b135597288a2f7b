//! The checked description of the water and of what bounds it, in SI numbers.

use crate::Signal;

/// Everything about a run that is not its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Number of cells along x, y, z.
    pub cells: [usize; 3],
    /// Length of a cell along x and y [m].
    pub spacing: f64,
    /// What fills the pores.
    pub fluid: Fluid,
    /// The bed; none: free water everywhere.
    pub bed: Option<Bed>,
    /// What is at the ends of x, y and z.
    pub ends: [Ends; 3],
    /// Is a cell solid? One entry for each cell, x fastest, then y, then z; or empty.
    pub solid: Vec<bool>,
    /// Acceleration of the fluid by a body force, such as gravity [m/s²].
    pub acceleration: [f64; 3],
    /// Do the squares of the velocity count? They cost arithmetic, and are for free water that
    /// is not slow.
    pub inertia: bool,
    /// What the lattice must get right; none: chosen from the numbers.
    pub regime: Option<Regime>,
    /// Time step [s]; none: chosen from the numbers.
    pub step: Option<f64>,
    /// The highest speed that is expected [m/s], for the Mach number; 0 where it does not matter.
    pub speed: f64,
}

impl Model {
    /// Is there fluid in a cell? One entry for each.
    pub(crate) fn fluid_cells(&self) -> Vec<bool> {
        match self.solid.is_empty() {
            true => vec![true; self.cells.iter().product()],
            false => self.solid.iter().map(|solid| !solid).collect(),
        }
    }

    /// Is there a solid cell?
    pub(crate) fn has_solids(&self) -> bool {
        self.solid.contains(&true)
    }

    /// Are there walls at the ends of x, y and z?
    pub(crate) fn walled(&self) -> [bool; 3] {
        [0, 1, 2].map(|axis| matches!(self.ends[axis], Ends::Walls(..)))
    }
}

/// A liquid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// Density [kg/m³].
    pub density: f64,
    /// Dynamic viscosity [Pa s].
    pub viscosity: f64,
    /// Compressibility [1/Pa]; not used by [`Regime::Incompressible`].
    pub compressibility: f64,
}

impl Fluid {
    /// Water near its freezing point.
    /// Source: IAPWS-95 at 0 °C and 0.1 MPa, rounded.
    pub const COLD_WATER: Self = Self {
        density: 999.8,
        viscosity: 1.792e-3,
        compressibility: 5.09e-10,
    };
}

/// A porous bed.
#[derive(Clone, Debug, PartialEq)]
pub struct Bed {
    /// Porosity φ.
    pub porosity: Field,
    /// Permeability k [m²]; infinite in cells of free water.
    pub permeability: Field,
    /// Forchheimer's coefficient b [1/m] in -∇p = μ/k q + ρ b |q| q; none: Darcy alone. After
    /// Ergun it is 1.75 (1 - φ) / (φ³ d) for grains of diameter d.
    pub forchheimer: Option<Field>,
}

/// A quantity that may vary from cell to cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// The same everywhere.
    Uniform(f64),
    /// One value for each cell, x fastest, then y, then z.
    Cells(Vec<f64>),
}

impl Field {
    /// The value of one cell.
    pub fn at(&self, cell: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Cells(values) => values[cell],
        }
    }

    /// The least and the greatest value.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Uniform(value) => [*value; 2],
            Self::Cells(values) => values
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &x| {
                    [low.min(x), high.max(x)]
                }),
        }
    }
}

/// What is at the two ends of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Ends {
    /// The last cell is a neighbour of the first.
    Periodic,
    /// Something at the lower and at the upper end, half a cell beyond the last centres.
    Walls(Side, Side),
}

/// One side of the box.
#[derive(Clone, Debug, PartialEq)]
pub enum Side {
    /// Water sticks to a plane that moves with this velocity along itself [m/s].
    NoSlip([f64; 3]),
    /// A plane, or one of symmetry: nothing passes, nothing sticks.
    FreeSlip,
    /// Pressure on the side [Pa]; water comes and goes, and no shear stress acts on it, so
    /// that viscous flow needs about a width to take its shape. Right to ρu²/2.
    Pressure(Signal),
    /// Flux through the side into the box [m/s], as a volume per area and time.
    Flux(Signal),
}

/// What the lattice must get right. Where it has a choice, it takes the fastest one that does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// Flow of a liquid that is slow against sound: waves of pressure are numerical, and only
    /// have to be fast. The choice for free water.
    Incompressible,
    /// Waves of pressure as they are, with the true compressibility; in a bed they are damped.
    Acoustic,
    /// Pressure diffuses: drag is so strong that inertia does not matter, and the density of
    /// the lattice is free. The choice for a bed of low permeability.
    Diffusive,
}
