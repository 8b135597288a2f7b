//! Sweeps: what is shared, what is refused, what goes on, what is collected.

mod collected;
mod going_on;
mod refused;
mod shared;

use experiments::backend::Backend;
use experiments::run::{Options, run};
use experiments::scene::{AnyScene, Document};
use experiments::sweep::{Design, Folder, Plan, Source, Tally, Workers, work};
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn texts(list: &[&str]) -> Vec<String> {
    list.iter().map(|text| (*text).into()).collect()
}

fn source(text: &str) -> Source {
    Source {
        name: "scene.toml".into(),
        folder: ".".into(),
        text: text.into(),
        sets: Vec::new(),
    }
}

fn grid(vary: &[&str]) -> Design {
    Design::grid(&texts(vary)).unwrap_or_else(|e| panic!("{e:#}"))
}

/// The plan of a scene and a design, on the disk.
fn planned(text: &str, design: Design, out: &Path) -> Plan {
    let (plan, texts) = Plan::new(&source(text), design).unwrap_or_else(|e| panic!("{e:#}"));
    plan.store(&texts, out, false).unwrap();
    plan
}

/// Run all that is not done.
fn go(plan: &Plan, out: &Path, stop: &AtomicBool) -> Tally {
    let workers = Workers {
        jobs: 2,
        threads: 1,
        backend: Backend::Cpu,
        quiet: true,
    };
    let folder = Folder { path: out, plan };
    work(folder, workers, stop).unwrap_or_else(|e| panic!("{e:#}"))
}

/// The same, to the end and without failures.
fn all(plan: &Plan, out: &Path) {
    let tally = go(plan, out, &AtomicBool::new(false));
    assert_eq!(tally.failed, []);
    assert_eq!(tally.done, plan.ends.len());
}

/// Run a point of a design by itself.
fn alone(text: &str, sets: &[String], out: &Path) {
    let document = Document::new("scene.toml", Path::new("."), text, sets).unwrap();
    let options = Options {
        out: out.to_path_buf(),
        backend: Backend::Cpu,
        threads: 1,
        force: true,
        quiet: true,
    };
    let go_on = AtomicBool::new(false);
    match AnyScene::read(&document).unwrap() {
        AnyScene::Grains(scene) => drop(run(&scene, &options, &go_on).unwrap()),
        AnyScene::Water(scene) => {
            drop(experiments::water::run(&scene, &options, &go_on).unwrap());
        }
    }
}

/// All values of a variable of a file.
fn values(file: &Path, variable: &str) -> Vec<f64> {
    let file = experiments::output::netcdf::open(file).unwrap();
    let found = file.variable(variable);
    let found = found.unwrap_or_else(|| panic!("no {variable}"));
    found.get_values(..).unwrap()
}

/// Water that a pressure drives through a bed, alone.
const WATER: &str = r#"
title = "A small column"
[box]
size = ["2 mm", "2 mm", "8 mm"]
[water]
spacing = "1 mm"
sides   = { bottom = { pressure = "1 kPa" }, top = { pressure = "0 Pa" } }
[water.bed]
porosity     = 0.4
permeability = "1e-12 m^2"
[end]
duration = "2 ms"
"#;
