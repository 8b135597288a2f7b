//! Scenes of water alone on a GPU: one scene and one set of files, whoever computes.

use crate::lab::Suite;
use experiments::backend::Backend;
use experiments::output::netcdf;
use experiments::ready;
use experiments::run::Options;
use experiments::scene::{Document, WaterScene};
use experiments::water::run;
use shaders::Device;
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub fn list(suite: &mut Suite) {
    suite.gpu("a_scene_of_water_on_both_backends", both_backends);
}

fn both_backends(_: &Device) {
    for (name, more, variable) in [
        ("terzaghi-column", "end.duration=20 s", "pressure"),
        ("poiseuille", "end={ duration = \"60 ms\" }", "velocity"),
    ] {
        let ready = ready::find(name).unwrap();
        let sets = ["water.precision=f32".to_owned(), more.to_owned()];
        let document = Document::new(name, &ready.folder(), ready.scene(), &sets).unwrap();
        let scene = WaterScene::read(&document).unwrap_or_else(|problems| panic!("{problems}"));
        let folder = tempfile::tempdir().unwrap();
        let [cpu, gpu] = [("cpu", Backend::Cpu), ("gpu", Backend::Gpu)].map(|(word, backend)| {
            let out = folder.path().join(word);
            last(&scene, backend, word, &out, variable)
        });
        let scale = cpu.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        for (a, b) in cpu.iter().zip(&gpu) {
            assert!((a - b).abs() < 2e-5 * scale, "{name}: {a} {b}");
        }
    }
}

/// The last row of a variable, and nobody else has computed it.
fn last(scene: &WaterScene, backend: Backend, word: &str, out: &Path, variable: &str) -> Vec<f64> {
    let options = Options {
        out: out.to_path_buf(),
        backend,
        threads: 1,
        force: false,
        quiet: true,
    };
    let summary = run(scene, &options, &AtomicBool::new(false)).unwrap();
    let file = netcdf::open(&out.join("fluid.nc")).unwrap();
    let told = file.attribute("backend").unwrap().value().unwrap();
    assert_eq!(String::try_from(told).unwrap(), word);
    let values: Vec<f64> = file.variable(variable).unwrap().get_values(..).unwrap();
    let count = if variable == "velocity" { 3 } else { 1 } * summary.cells;
    values[values.len() - count..].to_vec()
}
