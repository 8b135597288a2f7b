//! The same water on the GPU: the same model, state, lattice and answers, in `f32`.
//!
//! A step is one dispatch, one thread a cell (shaders/lbm/step.wgsl), on one array in place.
//! Each population is read once and written once: 2 · 19 · 4 = 152 bytes a cell, of free water
//! all there is; storage and drag of a bed are 8 bytes more that are read
//! ([`memory::moved_by_a_step`]). Neighbours along x are threads side by side, and each
//! population lies for itself, so that threads read side by side too. The host hands over
//! hundreds of steps at a time, with a table of what the sides give in each.

mod arrays;
pub mod bed;
mod bindings;
mod flags;
pub mod memory;
mod reading;
mod rows;
mod setting;
mod sides;
mod slab;
mod solver;
mod state;
mod steps;
pub mod timing;

pub use setting::{Range, Setting};
pub use sides::Given;
pub use solver::Solver;
