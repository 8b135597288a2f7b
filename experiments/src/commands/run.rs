//! `esker run`

use super::SceneArgs;
use crate::backend::Backend;
use crate::run::{Options, STATE, run as run_scene};
use crate::scene::{AnyScene, Scene, WaterScene};
use crate::water::{Outcome, run as run_water};
use anyhow::{Context, Result};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Arguments of `esker run`.
#[derive(Clone, Debug, Args)]
pub struct Run {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder of the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Who computes
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// Number of threads of the CPU; results do not depend on it [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Show neither progress nor summary
    #[arg(long)]
    quiet: bool,
    /// Replace results that are there
    #[arg(long)]
    force: bool,
}

/// Exit status of a program that Ctrl-C ended, as shells know it.
pub(super) const INTERRUPTED: u8 = 130;

/// What becomes true when the user, or the system, wants the program to end.
///
/// # Errors
/// A system that does not tell.
pub(super) fn on_interrupt() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = stop.clone();
    let on_signal = move || {
        // The second time the user means it.
        if asked.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED.into());
        }
    };
    ctrlc::set_handler(on_signal).context("cannot listen for Ctrl-C")?;
    Ok(stop)
}

/// `esker run`
///
/// # Errors
/// A scene that is wrong, results that are there already, a run that failed.
pub fn run(arguments: &Run) -> Result<ExitCode> {
    let (scene, name) = arguments.scene.read()?;
    let options = Options {
        out: arguments
            .out
            .clone()
            .unwrap_or_else(|| PathBuf::from("results").join(name)),
        backend: arguments.backend,
        threads: arguments.threads.map_or(0, usize::from),
        force: arguments.force,
        quiet: arguments.quiet,
    };
    let stop = on_interrupt()?;
    match &scene {
        AnyScene::Grains(scene) => grains(scene, &options, &stop),
        AnyScene::Water(scene) => water(scene, &options, &stop),
    }
}

fn grains(scene: &Scene, options: &Options, stop: &AtomicBool) -> Result<ExitCode> {
    for warning in scene.warnings().iter().filter(|_| !options.quiet) {
        eprintln!("warning: {warning}");
    }
    let summary = run_scene(scene, options, stop)?;
    if !options.quiet {
        // Everything is on disk: a reader that has gone, as `head` does, is no failure.
        let _ = writeln!(std::io::stdout(), "{summary}");
    }
    if summary.stopped() {
        // Scenes look for files from their own folder.
        let state = std::path::absolute(options.out.join(STATE))?;
        let phase = summary.phases.last().map_or("", |phase| &phase.name);
        eprintln!(
            "stopped in mid-phase; to go on (as accurately, not with the same bits), run a scene with [grains] state = {:?}, with the phases from \
             {phase:?} on, and with start = \"keep\" in that one: it keeps its end, and counts \
             from its beginning",
            state.display().to_string()
        );
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}

fn water(scene: &WaterScene, options: &Options, stop: &AtomicBool) -> Result<ExitCode> {
    let summary = run_water(scene, options, stop)?;
    if !options.quiet {
        let _ = writeln!(std::io::stdout(), "{summary}");
    }
    for warning in summary.warnings.iter().filter(|_| !options.quiet) {
        eprintln!("warning: {warning}");
    }
    if summary.outcome == Outcome::Stopped {
        let state = std::path::absolute(options.out.join(STATE))?;
        let end = match scene.end.steady {
            Some(_) => "end.max_duration",
            None => "end.duration",
        };
        eprintln!(
            "stopped before its end; to go on with the same bits, run the scene into another folder \
             with --set water.start='{{ state = {:?} }}' --set {end}=\"{:?} s\"",
            state.display().to_string(),
            summary.left
        );
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}
