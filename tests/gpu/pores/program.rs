//! Scenes with water between grains through the program, on both backends, and states that go from
//! one to the other.

use crate::lab::Suite;
use experiments::backend::Backend;
use experiments::output::{netcdf, state};
use experiments::run::{Options, run};
use experiments::scene::{Document, Scene};
use shaders::Device;
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_scenes_run_on_both_backends", both);
}

const WET: &str = r#"
title = "Small and wet"
[box]
size = ["4 mm", "4 mm"]
gravity = "none"
[grains]
count = 200
radius = { law = "uniform", min = "0.45 mm", max = "0.55 mm" }
density = "2600 kg/m^3"
[contact]
normal = { stiffness = "3e4 N/m", restitution = 0.3 }
tangential = { stiffness = "1e4 N/m", friction = 0.5 }
[water]
bed.permeability = "2e-13 m^2"
sides.top = "drained"
[[phase]]
name = "press"
top = { normal_stress = "10 kPa", damping = "0.05 N s/m" }
friction = 0.1
water = "none"
end = { at_rest = 1e-4, max_duration = "0.2 s" }
[output]
series.every = "50 us"
grains = "none"
profiles = "none"
"#;

/// A load on the bed whose state is in the folder.
fn loaded(folder: &Path, name: &str) -> Scene {
    let state = folder.join("state.h5");
    let text = format!(
        r#"
title = "Loaded"
[box]
gravity = "none"
[grains]
state = {state:?}
[contact]
normal = {{ stiffness = "3e4 N/m", restitution = 0.3 }}
tangential = {{ stiffness = "1e4 N/m", friction = 0.5 }}
[water]
bed.permeability = "2e-13 m^2"
sides.top = "drained"
[[phase]]
name = "{name}"
top = {{ normal_stress = "12 kPa", damping = "0 N s/m" }}
end = {{ duration = "0.3 ms" }}
[output]
series.every = "50 us"
fluid.every = "0.1 ms"
grains = "none"
profiles = "none"
"#
    );
    read(&text)
}

fn read(text: &str) -> Scene {
    let document = Document::new("wet", Path::new("."), text, &[]).unwrap();
    Scene::read(&document).unwrap_or_else(|problems| panic!("{problems}"))
}

fn go(scene: &Scene, backend: Backend, out: &Path) {
    let options = Options {
        out: out.to_path_buf(),
        backend,
        threads: 1,
        force: false,
        quiet: true,
    };
    run(scene, &options, &AtomicBool::new(false)).unwrap_or_else(|e| panic!("{e:#}"));
}

fn values(file: &Path, variable: &str) -> Vec<f64> {
    let file = netcdf::open(file).unwrap();
    let found = file.variable(variable);
    let found = found.unwrap_or_else(|| panic!("no {variable}"));
    found.get_values(..).unwrap()
}

/// Two load steps after each other, on either machine; the second also from the other's state.
fn both(_: &Device) {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    go(&read(WET), Backend::Cpu, &at("press"));
    go(&loaded(&at("press"), "load"), Backend::Cpu, &at("cpu"));
    go(&loaded(&at("press"), "load"), Backend::Gpu, &at("gpu"));
    go(&loaded(&at("gpu"), "more"), Backend::Cpu, &at("gpu, cpu"));
    go(&loaded(&at("cpu"), "more"), Backend::Gpu, &at("cpu, gpu"));
    go(&loaded(&at("cpu"), "more"), Backend::Cpu, &at("cpu, cpu"));
    let same = |one: &str, other: &str, file: &str, variable: &str| {
        let [a, b] = [one, other].map(|name| values(&at(name).join(file), variable));
        assert_eq!(a.len(), b.len(), "{variable}");
        let most = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let pairs = a.iter().zip(&b);
        let off = pairs.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        println!("{one} and {other}: {variable} off by {off:.1e} of {most:.1e}");
        assert!(
            most > 0.0 && off < 1e-4 * most,
            "{variable} of {one} and {other}"
        );
    };
    for (one, other) in [
        ("cpu", "gpu"),
        ("cpu, cpu", "cpu, gpu"),
        ("cpu, cpu", "gpu, cpu"),
    ] {
        for variable in ["pore_pressure_mean", "pore_pressure_base", "wall_height"] {
            same(one, other, "series.nc", variable);
        }
        same(one, other, "fluid.nc", "porosity");
    }
    same("cpu", "gpu", "series.nc", "total_stress_bottom");
    let saved = state::load(&at("gpu").join("state.h5")).unwrap();
    let water = saved.past.water.expect("the bed is wet");
    assert_eq!(water.state.loads.len(), 200);
    let file = netcdf::open(&at("gpu").join("fluid.nc")).unwrap();
    let backend: String = file
        .attribute("backend")
        .unwrap()
        .value()
        .unwrap()
        .try_into()
        .unwrap();
    assert_eq!(backend, "gpu");
}
