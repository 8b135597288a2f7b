//! Scenes of grains with water between them.

mod going_on;
mod meaning;
mod protocol;
mod signals;

pub use tests::wet::SCENE as WET;

use super::read;
use experiments::backend::Backend;
use experiments::run::{Options, Summary, run};
use experiments::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

fn wet(sets: &[&str]) -> Scene {
    read(WET, sets).unwrap_or_else(|e| panic!("{e}"))
}

fn options(out: &Path, threads: usize) -> Options {
    Options {
        out: out.to_path_buf(),
        backend: Backend::Cpu,
        threads,
        force: true,
        quiet: true,
    }
}

fn go(scene: &Scene, out: &Path, threads: usize) -> Summary {
    run(scene, &options(out, threads), &AtomicBool::new(false)).unwrap_or_else(|e| panic!("{e:#}"))
}

/// All values of a variable of a file.
fn values(file: &Path, variable: &str) -> Vec<f64> {
    let file = experiments::output::netcdf::open(file).unwrap();
    let found = file.variable(variable);
    let found = found.unwrap_or_else(|| panic!("no {variable}"));
    found.get_values(..).unwrap()
}

/// Area of the box [m²].
const AREA: f64 = 16e-6;

/// All values of a variable of the series of the run in the folder `out`.
fn series(out: &Path, variable: &str) -> Vec<f64> {
    values(&out.join("series.nc"), variable)
}

/// Results of the phase that presses the bed dry, made once.
fn pressed() -> PathBuf {
    static MADE: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = MADE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = wet(&[]);
        scene.phases.truncate(1);
        go(&scene, folder.path(), 1);
        folder
    });
    folder.path().to_path_buf()
}

/// The phases that come after, from that state.
fn after(sets: &[&str]) -> Scene {
    read(&text_after(&pressed(), "press"), sets).unwrap_or_else(|e| panic!("{e}"))
}

/// The scene of the phases after `last`, from the state in the folder `from`.
fn text_after(from: &Path, last: &str) -> String {
    let (head, phases) = WET.split_once("[[phase]]").unwrap();
    let named = format!("\"{last}\"");
    let (_, rest) = phases.split_once(&named).unwrap();
    let (_, rest) = rest.split_once("[[phase]]").unwrap();
    let (before, grains) = head.split_once("[box]").unwrap();
    let (_, contact) = grains.split_once("[contact]").unwrap();
    let state = from.join("state.h5");
    format!(
        "{before}[box]\ngravity = \"none\"\n[grains]\nstate = {state:?}\n[contact]{contact}[[phase]]{rest}"
    )
}
