//! What resists the water: -∇p = R(φ, |q|) q, one law a file.
//!
//! The same number is the force on the grains: φ R q of drag per volume of bed, beside the
//! pressure on them. Where pores are open, laws that are not linear enter with the flux of the last
//! step; on the lattice with that of the last renewal, which finds its way to the right one under
//! any pressure: a departure of R = a + b q comes back as less than itself, by b q/(a + b q).

mod di_felice;
mod ergun;
mod permeability;

pub use permeability::Permeability;

use lbm::Fluid;

/// A law of resistance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resistance {
    /// Darcy's law, R = μ/k.
    Darcy(Permeability),
    /// Ergun's law, for packed grains of this diameter [m] at any speed.
    Ergun {
        /// Diameter of the grains [m].
        diameter: f64,
    },
    /// Di Felice's law, from packed grains of this diameter [m] to a single one that settles.
    DiFelice {
        /// Diameter of the grains [m].
        diameter: f64,
    },
}

/// A law as kernels know it: shaders/coupling/resistance.wgsl.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Law {
    /// Permeability, and its bounds [m²].
    Constant([f64; 3]),
    /// Prefactor, and bounds of the permeability [m²].
    Porosity([f64; 3]),
    /// Diameter [m].
    Ergun(f64),
    DiFelice(f64),
}

impl Law {
    /// Its numbers, zero where there are fewer.
    pub fn numbers(self) -> [f64; 3] {
        match self {
            Self::Constant(numbers) | Self::Porosity(numbers) => numbers,
            Self::Ergun(diameter) | Self::DiFelice(diameter) => [diameter, 0.0, 0.0],
        }
    }
}

impl Resistance {
    /// What kernels must know.
    pub(crate) fn law(&self) -> Law {
        match self {
            Self::Darcy(permeability) => permeability.law(),
            Self::Ergun { diameter } => Law::Ergun(*diameter),
            Self::DiFelice { diameter } => Law::DiFelice(*diameter),
        }
    }

    /// R [Pa s/m²] at porosity `porosity` and flux `flux` [m/s].
    pub fn at(&self, fluid: &Fluid, porosity: f64, flux: f64) -> f64 {
        match *self {
            Self::Darcy(permeability) => fluid.viscosity / permeability.at(porosity),
            Self::Ergun { diameter } => ergun::resistance(fluid, porosity, flux, diameter),
            Self::DiFelice { diameter } => di_felice::resistance(fluid, porosity, flux, diameter),
        }
    }

    /// Does it depend on the flux?
    pub fn nonlinear(&self) -> bool {
        !matches!(self, Self::Darcy(_))
    }

    /// What is wrong with its numbers, if anything.
    pub(crate) fn fault(&self) -> Option<String> {
        match self {
            Self::Darcy(permeability) => permeability.fault(),
            Self::Ergun { diameter } | Self::DiFelice { diameter } => {
                let fine = *diameter > 0.0 && diameter.is_finite();
                (!fine).then(|| format!("diameter {diameter} m must be positive"))
            }
        }
    }
}
