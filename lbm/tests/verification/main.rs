//! Does the lattice solve its equations?

mod cavity;
mod common;
mod determinism;
mod fluid_content;
mod free;
mod layers;
mod numbers;
mod packing;
mod porous;
mod refusals;
mod sides;
mod spheres;
mod study;
mod waves;
