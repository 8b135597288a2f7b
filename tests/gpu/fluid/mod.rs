//! The pore water on the GPU.

mod beside_cpu;
mod changes;
mod compositions;
mod failures;
mod flows;
mod large;
mod program;
mod same_bits;
mod scenes;

use crate::lab::Suite;

pub fn list(suite: &mut Suite) {
    compositions::list(suite);
    beside_cpu::list(suite);
    flows::list(suite);
    changes::list(suite);
    same_bits::list(suite);
    large::list(suite);
    program::list(suite);
    failures::list(suite);
}
