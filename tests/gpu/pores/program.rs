//! Scenes with water between grains through the program, on both backends, and states that go from
//! one to the other.

use super::bed::{SIDE, STRESS, model, pressed, water};
use crate::lab::Suite;
use coupling::gpu::{Coupled, Memory};
use experiments::backend::Backend;
use experiments::output::{netcdf, state};
use experiments::run::{Options, run};
use experiments::scene::{Document, Scene};
use shaders::Device;
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_scenes_run_on_both_backends", both);
    suite.gpu(
        "wet_scenes_of_open_pores_are_refused_at_once",
        refused_at_once,
    );
    suite.gpu("wet_memory_is_told_beforehand", memory);
}

/// The phase that presses the bed dry.
fn pressed_dry() -> Scene {
    let mut scene = read(tests::wet::SCENE);
    scene.phases.truncate(1);
    scene
}

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
    go(&pressed_dry(), Backend::Cpu, &at("press"));
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
    let series = netcdf::open(&at("gpu").join("series.nc")).unwrap();
    let darcy = series.variable("dissipated_darcy").unwrap();
    let comment = darcy.attribute("comment");
    assert!(comment.is_some(), "nothing says why it is no number");
    let backend: String = file
        .attribute("backend")
        .unwrap()
        .value()
        .unwrap()
        .try_into()
        .unwrap();
    assert_eq!(backend, "gpu");
}

/// Gravel, which gets wet in the second phase: said before the first one, and nothing is written.
fn refused_at_once(_: &Device) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let text = tests::wet::SCENE.replace("2e-13 m^2", "1e-6 m^2");
    let options = |backend| Options {
        out: out.clone(),
        backend,
        threads: 1,
        force: false,
        quiet: true,
    };
    let error = run(&read(&text), &options(Backend::Gpu), &AtomicBool::new(true)).unwrap_err();
    let error = format!("{error:#}");
    for part in ["phase load", "--backend cpu", "permeability"] {
        assert!(error.contains(part), "{error}");
    }
    assert!(!out.exists());
    // On the CPU the same scene begins.
    run(&read(&text), &options(Backend::Cpu), &AtomicBool::new(true)).unwrap();
}

/// Bytes told and bytes taken, of the two kernels.
fn memory(device: &Device) {
    let mut drained = water(1e-12);
    drained.sides[0] = drained.sides[1].clone();
    let coarse =
        Coupled::<3>::new(device, model(STRESS), pressed(), drained.clone(), None).unwrap();
    let mut fine = water(1e-12);
    fine.cells = [6, 6, 7];
    let narrow = Coupled::<5>::new(device, model(STRESS), pressed(), fine.clone(), None).unwrap();
    let grains = pressed().grains.len();
    for (told, taken) in [
        (Memory::of(&drained, SIDE / 3.0, 3, grains), coarse.memory()),
        (Memory::of(&fine, SIDE / 6.0, 5, grains), narrow.memory()),
    ] {
        // What goes along with the grains stands in their part.
        let taken = taken + 116 * grains as u64;
        println!("{} bytes told, {taken} taken", told.bytes);
        assert!(told.bytes.abs_diff(taken) < taken / 20, "{told:?} {taken}");
    }
}
