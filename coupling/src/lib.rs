//! Grains and the water between them: drag, pressure, and the order of a coupled step.
//!
//! The water is that of `lbm`, in cells of about two grain diameters; its pressure p is the
//! deviation from hydrostatic, and buoyancy is added to the grains. The grains are those of
//! `dem`. Neither knows of the other; here they meet, in the memory where they live.
//!
//! # What is solved
//! Balance of water in a cell with solid flux v (volume per area), Darcy flux q, content
//! N = β V_p p beyond that at rest:
//!
//! > dN/dt = -∮(v + q) dA,   q = -∇p / R,
//!
//! and on the grains, per volume of bed, -(1 - φ) ∇p of pressure and φ R q of drag: with q
//! without inertia -∇p together, which is -V ∇p/(1 - φ) on a grain.
//!
//! That is where drag holds the water, as in tills. Where pores are open, in gravel, suspensions and
//! clear water, its own mass does: then its momentum is solved (`open/mod.rs`), and drag and pressure
//! reach the grains as they are.
//!
//! # The path of one step
//! 1. `dem` kicks and moves grains and walls: v(t + dt/2), x(t + dt). What the water pushes with is held
//!    for m steps (`choice.rs`), and what follows, up to contacts, happens in every m-th one, and at each
//!    neighbour search: an exchange.
//! 2. `exchange.rs`: ways since the last exchange are scattered to the faces of the cells, each the mean
//!    over the grains near it, by weights that are frozen for a while (`kernel.rs`): grains to
//!    moments of their cells (`scatter.rs`), these to faces (`nodes.rs`).
//! 3. The pressure that follows at once, undrained, p = (N - ∫∮v dA dt) / (β V_p): without it
//!    stiff water blows up, and it must cover the whole force. Held is what it will be in the middle
//!    of the kicks to come (`trend.rs`).
//! 4. Every n steps the lattice takes what has been collected as a source and drains it.
//!    n follows from accuracy (`choice.rs`); at each search, and every 64 steps or more, weights, porosity and
//!    permeability are renewed, the content of each cell kept.
//! 5. Pressure differences across faces are gathered to the grains by the same weights: the
//!    gather is the transpose of the scatter, so that the work of the forces is that of the
//!    pressure on the volume, and sums of forces balance. Walls get the pressure of their cells.
//! 6. `dem` adds contacts.
//!
//! On processors nothing is copied or allocated on this path, fluid steps included: water reads the
//! ways where `dem` keeps them, and adds to the very sums that move the grains
//! (`tests/allocation.rs` counts). Renewals of the weights, and neighbour searches, allocate.
//!
//! Sources: Goren et al. (2010), J. Geophys. Res. 115, B09216, for the equation; Kim, Tchelepi
//! and Juanes (2011), Comput. Methods Appl. Mech. Eng. 200, 1591, for undrained splits.
//!
//! # On a device
//! [`gpu`] does the same on graphics devices, in the arrays where grains and lattice live there.
//!
//! # Grains that carry no load
//! A mean velocity that counts loose grains lets the skeleton compress while they fly the other
//! way, and pore pressure leaks away. So grains count by the load that they carry (`load.rs`),
//! and loose ones are dragged to the mean, with the reaction on the others (`faces.rs`).

#![allow(
    clippy::needless_range_loop,
    reason = "lanes, nodes and cells are indices of several arrays at once"
)]

mod books;
mod cells;
mod check;
mod choice;
mod coupled;
mod drag;
mod drift;
mod exchange;
#[cfg(test)]
mod exchange_tests;
mod faces;
mod gather;
pub mod gpu;
mod kernel;
mod kernels;
mod lattice;
mod ledger;
mod load;
mod model;
mod nodes;
mod open;
mod report;
mod scatter;
mod softness;
mod stiffness;
mod terms;
#[cfg(test)]
mod tests;
mod trend;
mod water;

pub use choice::{OPEN, open_needs_density};
pub use coupled::{Coupled, Error};
pub use drag::{Permeability, Resistance};
pub use ledger::Ledger;
pub use model::{Cavitation, Model, NormalStress};
pub use report::Report;
pub use stiffness::skeleton_stiffness;
pub use water::{Snapshot, State, Water};
