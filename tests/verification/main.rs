//! Does the code solve its equations?

mod conservation;
mod coulomb;
mod determinism;
mod energy;
mod impact;
mod incline;
mod integrator;
mod lammps;
mod ledger;
mod outside;
mod restitution;
mod rolling;
mod search;
mod sliding_to_rolling;
mod stability;
mod wall;
