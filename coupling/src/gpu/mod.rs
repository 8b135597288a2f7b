//! Grains and their water on one device, in each other's arrays.
//!
//! The scheme and its numbers are those of the CPU ([`crate::Water`]); grains are those of `dem::gpu`,
//! the lattice that of `lbm::gpu`. All of a step happens on the device, renewals too. What crosses to
//! the host is how far the device is, and at a renewal the extremes of the bed, from which follow the
//! numbers of the lattice.
//!
//! # The path of one step
//! A step of the grains is `shaders/dem/step.wgsl`, one dispatch; what the water pushes grains and walls
//! with is added there, and held from one exchange to the next (`choice.rs`). At an exchange the
//! water follows their motion:
//!
//! | dispatch | what | one thread, or group |
//! |---|---|---|
//! | `scatter.wgsl` | w V v of the grains of a cell, to the 54 faces around | 64 threads a cell |
//! | `follow.wgsl`, `means` | 18 of these for each face: mean velocities | a cell |
//! | `follow.wgsl`, `collect_and_feel` | the volume that faces bring, and the pressure to hold | a cell |
//! | `push.wgsl` | pressure differences over weights, forces on walls | a cell |
//! | `gather.wgsl` | what pushes each grain until the next exchange | a grain |
//!
//! Velocities are means since the last exchange, from the places then and now, which are exact: so the
//! volume that is collected is the one that has gone, however long the run. Every n steps what was
//! collected becomes the source of the lattice (`drain.wgsl`, the lattice, `follow.wgsl`,
//! `feel_drained`). Where loose grains are dragged, the scatter leaves their share too, and there is
//! one kernel more (`react`). The wide kernel is the
//! narrow one and a filter over the cells (`smooth.wgsl`): two dispatches more in each direction.
//!
//! So a step with an exchange is six dispatches, and one of m = 8 steps with an exchange, drag and
//! all, 14 for eight. Who reads between two exchanges is told of the pressure then, which changes nothing
//! (`look`).
//!
//! # Sums over grains
//! No grain adds to memory that another one adds to. At a renewal the grains of each cell are listed
//! by identity; a workgroup walks the list of a cell, each thread for one of the faces around, and
//! each face takes what the cells around have left for it. These sums have one order, whatever
//! that of the rows or of the threads: the same bits each time, with no scale that could overflow.
//! Per grain and exchange this reads 20 bytes side by side and two places, and per cell (nine grains)
//! writes and reads 216 bytes; 54 atomic additions of two words for each grain would move four times
//! as much, all to the few places of its cell. Forces on walls are whole numbers, as those of the
//! grains are (`shaders/dem/wide.wgsl`).
//!
//! # What differs from the CPU
//! Arithmetic is in f32, but for positions, sums on walls, and what is kept of kicks. A search of
//! neighbours only reorders rows, where the CPU exchanges and renews weights with each. Vapour is looked at when
//! weights are renewed. Works and losses of the water are not summed: that takes the water's energy
//! before and after each of its steps, in double precision. Pores so open that the
//! water's mass holds it are refused, before the first step where the description tells.
//!
//! # Steps that are not made
//! Steps are recorded in groups of up to 64, each heard of before the next one is recorded. The lists
//! of neighbours may end before a group does; what was recorded beyond does nothing, and the host
//! takes back what it counted. The group in which weights are renewed ends there.

mod ahead;
mod arrays;
mod coupled;
mod kernels;
mod numbers;
mod reading;
mod renewal;
mod steps;
#[cfg(test)]
mod tests;

pub use ahead::{Memory, foresee};
pub use coupled::Coupled;
