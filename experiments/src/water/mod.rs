//! Runs of water alone: the solver on whichever machine, and the loop that follows a scene.

mod engine;
mod run;
mod steady;
mod summary;

pub use engine::Engine;
pub use run::run;
pub use summary::{Outcome, WaterSummary};
