//! `esker check` of water alone.

use super::check::line;
use super::cost::{MIB, duration};
use crate::backend::Backend;
use crate::scene::WaterScene;
use crate::water::Engine;
use anyhow::Result;
use std::process::ExitCode;
use std::time::Instant;

/// How long to measure the speed [s].
const SECONDS: f64 = 0.5;

/// Say what the numbers of `scene` imply.
///
/// # Errors
/// A machine that is not there, or cannot hold the water.
pub fn check(scene: &WaterScene, backend: Backend, threads: usize) -> Result<ExitCode> {
    let water = &scene.water;
    let cells = water.lattice().count();
    let chosen = backend.choose_for_water(cells, water.precision, threads)?;
    println!("{}\n", scene.title);
    let steps = scene.steps();
    for (what, value) in water.facts(steps) {
        line(what, &value);
    }
    let files = scene.output.iter().filter(|(_, file)| file.is_some());
    let files: Vec<String> = files.map(|(kind, _)| kind.file_name()).collect();
    line(
        "files",
        &[files, vec!["state.h5".into()]].concat().join(", "),
    );
    println!();
    line(
        "computed on",
        &format!("{} ({})", chosen.machine.describe(), chosen.why),
    );

    let mut engine = Engine::new(&chosen.machine, water)?;
    let memory = engine.memory() as f64;
    // The state it began with, and what is on its way to the files.
    let copies = (19 + 4 * 4) as f64 * 8.0 * cells as f64;
    line(
        "memory",
        &format!(
            "about {:.1} MiB for the lattice, {:.0} bytes a cell, and {:.1} MiB beside it",
            memory / MIB,
            memory / cells as f64,
            copies / MIB
        ),
    );
    let (begun, mut done, mut more) = (Instant::now(), 0, 1);
    // More and more at a time: a GPU makes steps by the hundred.
    while begun.elapsed().as_secs_f64() < SECONDS && done < steps {
        engine.advance(more)?;
        done += more;
        more += more.div_ceil(2);
    }
    let seconds = begun.elapsed().as_secs_f64() / done as f64 * steps as f64;
    let most = if scene.end.steady.is_some() {
        "at most "
    } else {
        ""
    };
    line(
        "run time",
        &format!("{most}about {} there", duration(seconds)),
    );
    for warning in water.warnings(steps) {
        line("warning", &warning);
    }
    Ok(ExitCode::SUCCESS)
}
