//! Does the coupling solve its equations? Grains and water together, in small beds made here.

mod balance;
mod bed;
mod consolidation;
mod refusals;
mod seepage;
mod shear;
mod stability;
mod tampered;
