//! Grains and the water between them on the GPU.

mod balance;
mod bed;
mod beside_cpu;
mod consolidation;
mod dry;
mod long_shear;
mod program;
mod same_bits;
mod traffic;

use crate::lab::Suite;

pub fn list(suite: &mut Suite) {
    beside_cpu::list(suite);
    balance::list(suite);
    consolidation::list(suite);
    same_bits::list(suite);
    traffic::list(suite);
    dry::list(suite);
    long_shear::list(suite);
    program::list(suite);
}
