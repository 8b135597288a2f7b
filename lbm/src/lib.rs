//! Pore water on a D3Q19 lattice: free, or in a porous bed of any permeability. SI units.
//!
//! A run is a [`Model`] (the checked description) and a [`State`] (plain data). The [`Solver`]
//! takes both, is told to advance by n steps, and is read through a [`Snapshot`]. It works in
//! `f32` or `f64`, on populations that are deviations from rest, in one array. What the numbers
//! imply for the lattice is in its [`Scaling`], which refuses what cannot be stable or accurate.
//! [`gpu`] has the same solver on graphics devices.

mod check;
mod choice;
mod clock;
mod collide;
pub mod gpu;
mod grid;
mod kernels;
mod lanes;
mod lattice;
mod limits;
mod links;
mod model;
mod populations;
mod reading;
mod scaling;
mod signal;
mod snapshot;
mod solver;
mod start;
mod state;
mod step;

pub use choice::Extremes;
pub use lanes::Real;
pub use model::{Bed, Ends, Field, Fluid, Model, Regime, Side};
pub use scaling::Scaling;
pub use signal::Signal;
pub use snapshot::Snapshot;
pub use solver::{Error, Solver};
pub use state::State;
