//! Does the code solve its equations?

mod companion;
mod conservation;
mod coulomb;
mod determinism;
mod energy;
mod friction;
mod impact;
mod incline;
mod integrator;
mod lammps;
mod ledger;
mod outside;
mod poster_ledger;
mod restitution;
mod rolling;
mod search;
mod sliding_to_rolling;
mod stability;
mod wall;
