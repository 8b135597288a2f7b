//! What moves the water: a lattice where pressure diffuses, or its momentum where pores are open.

use crate::lattice::Lattice;
use crate::open::{Books, Open};

/// The one or the other.
#[allow(
    clippy::large_enum_variant,
    reason = "there is one of it, and neither is ever moved"
)]
pub(crate) enum Flow {
    /// Drag holds the water: Darcy's law, on the lattice of `lbm`.
    Lattice(lbm::Solver<f64>),
    /// Its own mass does.
    Open(Open),
}

impl Flow {
    /// Time [s].
    pub fn time(&self) -> f64 {
        match self {
            Self::Lattice(solver) => solver.time(),
            Self::Open(open) => open.time,
        }
    }

    /// Where the energy of open pores went; nothing where there is a lattice.
    pub fn books(&self) -> Books {
        match self {
            Self::Lattice(_) => Books::default(),
            Self::Open(open) => open.books,
        }
    }

    /// Kinetic energy of the water [J]; none where drag holds it.
    pub fn kinetic(&self, cells: &Lattice) -> f64 {
        match self {
            Self::Lattice(_) => 0.0,
            Self::Open(open) => open.kinetic(cells),
        }
    }

    /// The lattice, where there is one.
    pub fn lattice(&self) -> Option<&lbm::Solver<f64>> {
        match self {
            Self::Lattice(solver) => Some(solver),
            Self::Open(_) => None,
        }
    }
}
