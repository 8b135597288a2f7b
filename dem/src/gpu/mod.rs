//! Grains on the GPU: the same description, the same readings.
//!
//! Positions are exact ([`fixed`]), running sums whole numbers ([`wide`]); velocities, forces
//! and springs f32. All of a step happens on the device ([`control`], shaders/dem/step.wgsl),
//! the neighbour search too ([`search`]); the host hands over hundreds of steps at a time.

mod arrays;
mod bodies;
pub mod companion;
pub mod control;
pub mod fixed;
pub mod law;
mod loading;
mod look;
pub mod memory;
mod numbers;
mod outside;
mod reading;
mod rows;
mod scene;
pub mod search;
mod solver;
mod steps;
mod sums;
#[cfg(test)]
mod tests;
pub mod timing;
pub mod wide;

pub use solver::Solver;
