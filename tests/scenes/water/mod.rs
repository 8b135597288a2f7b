//! Scenes of water alone.

mod flows;
mod meaning;
mod same_bits;

use experiments::backend::Backend;
use experiments::ready;
use experiments::run::Options;
use experiments::scene::{Document, Problems, WaterScene};
use experiments::water::{WaterSummary, run};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A scene that is right, and says as little as it may.
const PIPE: &str = r#"
title = "Small"
box.size = ["1 mm", "1 mm", "8 mm"]

[water]
spacing = "1 mm"

[end]
duration = "1 s"
"#;

/// A bed that drains.
const BED: &str = r#"
title = "Bed"
box.size = ["1 cm", "1 cm", "8 cm"]

[water]
spacing = "1 cm"
sides.top = { pressure = "0 Pa" }
start.pressure = "1 kPa"

[water.bed]
porosity = 0.4
permeability = "1e-12 m^2"

[end]
duration = "2 ms"
"#;

/// The scene of a text in a folder, with `sets` as on the command line.
fn read_in(folder: &Path, text: &str, sets: &[&str]) -> Result<WaterScene, Problems> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).into()).collect();
    WaterScene::read(&Document::new("scene.toml", folder, text, &sets)?)
}

fn read(text: &str, sets: &[&str]) -> Result<WaterScene, Problems> {
    read_in(Path::new("."), text, sets)
}

/// A ready-made experiment.
fn ready(name: &str, sets: &[&str]) -> WaterScene {
    let ready = ready::find(name).unwrap();
    read_in(&ready.folder(), ready.scene(), sets).unwrap_or_else(|e| panic!("{e}"))
}

fn options(out: &Path) -> Options {
    Options {
        out: out.to_path_buf(),
        backend: Backend::Cpu,
        threads: 1,
        force: false,
        quiet: true,
    }
}

fn go(scene: &WaterScene, out: &Path) -> WaterSummary {
    run(scene, &options(out), &AtomicBool::new(false)).unwrap_or_else(|e| panic!("{e:#}"))
}

/// All values of a variable of a file.
fn values(file: &Path, variable: &str) -> Vec<f64> {
    let file = experiments::output::netcdf::open(file).unwrap();
    let found = file
        .variable(variable)
        .unwrap_or_else(|| panic!("no {variable}"));
    found.get_values(..).unwrap()
}

/// The last row of a variable of `fluid.nc` of `n` numbers.
fn last(out: &Path, variable: &str, n: usize) -> Vec<f64> {
    let all = values(&out.join("fluid.nc"), variable);
    all[all.len() - n..].to_vec()
}
