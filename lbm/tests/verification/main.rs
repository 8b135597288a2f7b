//! Does the lattice solve its equations?

mod common;
mod determinism;
mod fluid_content;
mod free;
mod layers;
mod numbers;
mod porous;
mod refusals;
mod sides;
mod waves;
