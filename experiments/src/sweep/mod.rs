//! Many runs of one scene that differ in a few values.
//!
//! A [`Design`] says which points there are. The scene of each point is read and checked as if it
//! ran alone; from these scenes follows the tree of what is to be run, a [`Plan`]: each phase of
//! each point, but what two points have in common, from the start to the phase before the first
//! that differs, only once. The plan, the scene of each [`Run`] and its [`Outcome`] stand in one
//! [`Folder`], so that a sweep goes on after it was stopped or killed, in one program ([`work`]) or
//! in many ([`run`]), and is put together by [`collect`](collect()) when all is over.

mod axis;
mod collect;
mod coordinates;
mod design;
mod hypercube;
mod outcome;
mod plan;
mod print;
mod progress;
mod results;
mod runs;
mod schedule;
mod series;
mod stage;
mod text;
mod tree;
mod work;

pub use axis::Axis;
pub use collect::{FILE, POINTS, collect};
pub use design::Design;
pub use outcome::Outcome;
pub use plan::{Plan, Source};
pub use print::{commands, slurm};
pub use runs::{Ended, Folder, on_gpu, run};
pub use tree::Run;
pub use work::{Tally, Workers, work};
