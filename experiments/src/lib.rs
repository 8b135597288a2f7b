//! The program esker: scenes, protocol, output.

pub mod backend;
pub mod bed;
pub mod bench;
pub mod commands;
pub mod engine;
pub mod output;
pub mod protocol;
pub mod ready;
pub mod run;
pub mod scene;
pub mod start;
pub mod sweep;
pub mod water;
