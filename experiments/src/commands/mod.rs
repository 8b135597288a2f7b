//! What each command of the program does.

mod calibrate;
mod check;
mod cost;
mod info;
mod left_out;
mod pores;
mod run;
mod scene;
mod sweep;
mod water;

pub use check::{Check, check};
pub use info::info;
pub use run::{Run, run};
pub use scene::SceneArgs;
pub use sweep::{Sweep, sweep};

use crate::{bed, ready, scene as scenes};
use anyhow::{Context, Result};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Arguments of `esker new`.
#[derive(Clone, Debug, Args)]
pub struct New {
    /// Name of a ready-made experiment; `esker list` shows them
    pub name: String,
    /// Folder to make
    pub dir: PathBuf,
}

/// Arguments of `esker import`.
#[derive(Clone, Debug, Args)]
pub struct Import {
    /// CSV with a header, LAMMPS data or dump, or `sphere` binary 2.11
    pub file: PathBuf,
    /// NetCDF file to write
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Replace the file if it is there
    #[arg(long)]
    pub force: bool,
}

/// What can be measured.
#[derive(Clone, Debug, Subcommand)]
pub enum Bench {
    /// Grain-steps per second on a dense sheared packing, or cells of water per second
    Speed(crate::bench::SpeedArgs),
}

/// `esker list`
///
/// # Errors
/// None that a user can cause.
pub fn list() -> Result<ExitCode> {
    for ready in ready::ALL {
        let document = scenes::Document::new(ready.name, &ready.folder(), ready.scene(), &[])?;
        let title = scenes::title(&document).unwrap_or_default();
        println!("{:22}{title}", ready.name);
    }
    Ok(ExitCode::SUCCESS)
}

/// `esker new`
///
/// # Errors
/// An unknown name, a folder that is taken.
pub fn new(arguments: &New) -> Result<ExitCode> {
    let name = &arguments.name;
    let ready = ready::find(name).with_context(|| scene::no_such(name))?;
    ready.copy(&arguments.dir)?;
    let dir = arguments.dir.display();
    println!("{name} is in {dir}; edit {dir}/scene.toml, then esker run {dir}/scene.toml");
    Ok(ExitCode::SUCCESS)
}

/// `esker import`
///
/// # Errors
/// Files that cannot be read or written.
pub fn import(arguments: &Import) -> Result<ExitCode> {
    let output = &arguments.output;
    anyhow::ensure!(
        arguments.force || !output.exists(),
        "{} exists; choose another name, or replace it with --force",
        output.display()
    );
    println!("{}", bed::import(&arguments.file, output)?);
    Ok(ExitCode::SUCCESS)
}

/// `esker bench`
///
/// # Errors
/// Those of [`crate::bench::speed`].
pub fn bench(arguments: &Bench) -> Result<ExitCode> {
    match arguments {
        Bench::Speed(arguments) => crate::bench::speed(arguments)?,
    }
    Ok(ExitCode::SUCCESS)
}
