//! Does the coupling solve its equations? Grains and water together, in small beds made here.

mod balance;
mod bed;
mod consolidation;
mod dilation;
mod energy;
mod fluidisation;
mod loose;
mod open_books;
mod refusals;
mod seepage;
mod settling;
mod shear;
mod stability;
mod study;
mod tampered;
