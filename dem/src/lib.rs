//! Grains: what they are, how they touch, how they move. Double precision, SI units.
//!
//! A run is a [`Model`] (the checked description) and a [`State`] (plain data). The
//! [`Solver`] takes both, is told to advance by n steps, and is read through a
//! [`Snapshot`]. A new phase of a protocol is a new model with the old state.

mod barrier;
mod boundary;
mod check;
mod companion;
pub mod contact;
mod cut;
pub mod gpu;
mod grains;
mod kernels;
#[doc(hidden)]
pub mod lanes;
mod ledger;
pub mod measure;
mod model;
mod motion;
pub mod output;
mod reading;
mod regroup;
mod search;
mod shared;
mod slab;
mod slots;
mod snapshot;
mod solver;
mod sorted;
pub mod stability;
mod start;
mod state;
mod step;
mod sweep;
mod view;
mod walls;

pub use companion::{Bed, Companion, Moved, Threads};
pub use contact::ContactLaw;
pub use grains::{Constraint, Grains, Horizontal};
pub use lanes::Row;
pub use model::{Domain, Drive, Model, StressLoad, Surface, Wall, WallMotion};
pub use shared::Shared;
pub use snapshot::{Ledger, Snapshot, Sums};
pub use solver::{Error, Outside, Solver};
pub use state::{Body, Contact, History, State, WallState};
