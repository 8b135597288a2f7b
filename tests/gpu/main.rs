//! The GPU's WGSL against the Rust that explains it. Any adapter will do, software included;
//! where there is none, the tests that need one are reported as ignored, never as passed.

mod beside;
mod beside_cpu;
mod boundaries;
mod cage;
mod compare;
mod compositions;
mod conservation;
mod drift;
mod fall;
mod fluid;
mod lab;
mod lammps;
mod laws;
mod overlap;
mod parts;
mod plane_shear;
mod pores;
mod poster;
mod program;
mod rounding;
mod same_bits;
mod search;
mod springs;
mod sums;

use lab::Suite;

fn main() {
    let mut suite = Suite::new();
    compositions::list(&mut suite);
    beside_cpu::list(&mut suite);
    laws::list(&mut suite);
    search::list(&mut suite);
    overlap::list(&mut suite);
    springs::list(&mut suite);
    drift::list(&mut suite);
    sums::list(&mut suite);
    same_bits::list(&mut suite);
    poster::list(&mut suite);
    cage::list(&mut suite);
    conservation::list(&mut suite);
    boundaries::list(&mut suite);
    lammps::list(&mut suite);
    parts::list(&mut suite);
    plane_shear::list(&mut suite);
    program::list(&mut suite);
    fall::list(&mut suite);
    fluid::list(&mut suite);
    pores::list(&mut suite);
    suite.run();
}
