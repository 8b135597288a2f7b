//! The program on a GPU: one scene, one protocol, one set of files, whoever computes.

use crate::lab::Suite;
use dem::gpu::{self, memory::Memory};
use experiments::backend::{Backend, Chosen, FEWEST, Machine};
use experiments::engine::Engine;
use experiments::output::{netcdf, state};
use experiments::ready;
use experiments::run::{Options, STATE, run, run_on};
use experiments::scene::{Document, Scene};
use shaders::Device;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use tests::bed::Bed;

pub fn list(suite: &mut Suite) {
    suite.plain("auto_takes_hardware_alone", auto);
    suite.plain("whole_lengths_suit_every_phase", whole_lengths);
    suite.gpu("a_run_says_who_computed_it", run_on_gpu);
    suite.gpu("a_scene_on_both_backends", both_backends);
    suite.gpu("what_a_gpu_cannot_hold_costs_no_results", refused);
    suite.gpu("memory_is_told_before_it_is_taken", memory);
    suite.gpu("timed_steps_are_the_same_steps", timed);
    suite.gpu("a_lost_device_is_an_error", lost);
    suite.gpu("a_device_lost_in_mid_run_costs_no_results", lost_in_mid_run);
}

/// small-shear with 120 grains, for some hundred steps a phase.
fn small_shear(more: &[&str]) -> Scene {
    let text = ready::find("small-shear").unwrap().scene();
    let sets = [
        "grains.count=120",
        "box.size=[\"60 mm\", \"60 mm\"]",
        "phase.settle.end.max_duration=2 ms",
        "phase.consolidate.end.max_duration=2 ms",
        "phase.shear.end.strain=0.0005",
        "output.series.every=0.5 ms",
    ];
    let sets: Vec<String> = sets.iter().chain(more).map(|&set| set.into()).collect();
    let document = Document::new("small-shear", Path::new("."), text, &sets).unwrap();
    Scene::read(&document).unwrap_or_else(|problems| panic!("{problems}"))
}

fn options(backend: Backend, out: &Path) -> Options {
    Options {
        out: out.to_path_buf(),
        backend,
        threads: 1,
        force: false,
        quiet: true,
    }
}

fn go(scene: &Scene, backend: Backend, out: &Path) -> state::Saved {
    run(scene, &options(backend, out), &AtomicBool::new(false)).unwrap();
    state::load(&out.join("state.h5")).unwrap()
}

fn auto() {
    let machine = |grains| Backend::Auto.choose(grains, 1).unwrap().machine;
    assert!(matches!(machine(FEWEST - 1), Machine::Cpu { threads: 1 }));
    let hardware = shaders::adapters().iter().any(|a| a.is_hardware());
    assert_eq!(matches!(machine(FEWEST), Machine::Gpu(_)), hardware);
}

/// The grid of the solver is that of the state at hand; the scene's lengths are whole in it.
fn whole_lengths() {
    let scene = small_shear(&[]);
    for height in [0.01, 0.1, 0.3] {
        for text in [
            "grains.count=120",
            "box.size=[\"0.3 m\", \"70 mm\"]",
            "search.skin=2 mm",
        ] {
            let scene = small_shear(&[text]);
            let grains = &scene.start.grains;
            let coarse =
                experiments::scene::whole::grid(&scene.domain, grains, Some(height), scene.skin);
            assert_eq!(coarse.unwrap().domain(&scene.domain), scene.domain);
        }
    }
    let [x, _] = scene.domain.size;
    assert!(x != 0.06 && (x - 0.06).abs() < 1e-8, "{x}");
}

fn run_on_gpu(device: &Device) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    go(&small_shear(&[]), Backend::Gpu, &out);
    for name in ["series.nc", "profiles.nc", "grains.nc"] {
        let file = netcdf::open(&out.join(name)).unwrap();
        let text = |key: &str| -> String {
            let value = file.attribute(key).unwrap().value().unwrap();
            value.try_into().unwrap()
        };
        assert_eq!(text("backend"), "gpu");
        assert_eq!(text("device"), device.adapter.describe());
    }
    let series = netcdf::open(&out.join("series.nc")).unwrap();
    let values =
        |name: &str| -> Vec<f64> { series.variable(name).unwrap().get_values(..).unwrap() };
    let time = values("time");
    assert!(time.len() > 8 && time.windows(2).all(|pair| pair[0] < pair[1]));
    let energy = values("kinetic_energy");
    assert!(energy.iter().all(|e| e.is_finite() && *e > 0.0));
}

/// A dense bed under load, sheared from the first step.
const DENSE: &str = r#"
title = "Dense"
[box]
size = ["0.2 m", "0.2 m"]
gravity = "none"
[grains]
bed = "one_size.csv"
density = "3600 kg/m^3"
[contact]
normal = { stiffness = "1e7 N/m", damping = "78 N s/m" }
tangential = { stiffness = "1e6 N/m", damping = "78 N s/m", friction = { static = 0.58, dynamic = 0.47 } }
[[phase]]
name = "shear"
top = { normal_stress = "100 kPa" }
shear = { strain_rate = "0.25 1/s" }
end = { duration = "2 ms" }
[output]
series = { every = "0.5 ms" }
"#;

/// Three hundred steps of a dense bed, as each backend writes them. Forces are in single
/// precision, 6e-8; a bed is chaotic, and what differs has grown tenfold to hundredfold by the end
/// (1e-6 in the stresses, 6e-6 in the kinetic energy on lavapipe). Devices round differently:
/// ten times that is allowed, where a wrong law would be off by per cents.
fn both_backends(_: &Device) {
    let folder = tempfile::tempdir().unwrap();
    let beds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments/src/bench");
    let scene = Scene::read(&Document::new("dense", &beds, DENSE, &[]).unwrap());
    let scene = scene.unwrap_or_else(|problems| panic!("{problems}"));
    let series = |backend, name: &str| {
        let out = folder.path().join(name);
        let saved = go(&scene, backend, &out);
        let file = netcdf::open(&out.join("series.nc")).unwrap();
        let read =
            move |name: &str| -> Vec<f64> { file.variable(name).unwrap().get_values(..).unwrap() };
        (saved, read)
    };
    let (cpu, of_cpu) = series(Backend::Cpu, "cpu");
    let (gpu, of_gpu) = series(Backend::Gpu, "gpu");
    assert_eq!(cpu.domain, gpu.domain, "one box, to the bit");
    assert_eq!(cpu.domain, scene.domain);
    assert_eq!(cpu.state.grains.constraint, gpu.state.grains.constraint);
    // Of more than two thousand some few are about to part or to touch.
    let contacts = [&cpu, &gpu].map(|saved| saved.state.contacts.len());
    assert!(contacts[0] > 2000, "a dense bed");
    assert!(contacts[0].abs_diff(contacts[1]) <= 4, "{contacts:?}");
    for (name, most) in [
        ("time", 1e-12),
        ("wall_height", 1e-8),
        ("shear_stress_top_mean", 6e-5),
        ("normal_stress_top_mean", 6e-5),
        ("kinetic_energy", 6e-5),
        ("elastic_energy_normal", 6e-5),
        ("work_drive", 6e-5),
    ] {
        let (a, b) = (of_cpu(name), of_gpu(name));
        assert!(a.len() == b.len() && a.len() > 3, "{name}: as many rows");
        let apart = a.iter().zip(&b).map(|(a, b)| (b / a - 1.0).abs());
        let apart = apart.fold(0.0, f64::max);
        println!(
            "{name}: within {apart:.1e}, in the end {:e}",
            a[a.len() - 1]
        );
        assert!(apart < most, "{name}: {apart:e}");
    }
}

/// Kilometres of grains of a centimetre.
const WIDE: &str = r#"
title = "Far apart"
[box]
size = ["5000 m", "60 mm"]
[grains]
count = 60
radius = "10 mm"
density = "2600 kg/m^3"
[contact]
normal = { stiffness = "1e6 N/m", restitution = 0.5 }
tangential = { stiffness = "3e5 N/m", friction = 0.5 }
[[phase]]
name = "settle"
end = { duration = "1 ms" }
[output]
series = { every = "1 ms" }
"#;

fn refused(_: &Device) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let document = Document::new("wide", Path::new("."), WIDE, &[]).unwrap();
    let scene = Scene::read(&document).unwrap_or_else(|problems| panic!("{problems}"));
    let error = run(
        &scene,
        &options(Backend::Gpu, &out),
        &AtomicBool::new(false),
    )
    .unwrap_err();
    let error = format!("{error:#}");
    assert!(error.contains("use the CPU"), "{error}");
    assert!(!out.exists(), "nothing was begun");
}

fn memory(device: &Device) {
    let (model, state) = Bed::new(500, 7.0, 0.5, 1).sheared(0.01);
    let mut frictionless = model.clone();
    if let dem::ContactLaw::Linear(law) = &mut frictionless.law {
        law.sliding = None;
    }
    frictionless.ledger = false;
    let mut bare = state.clone();
    bare.contacts.clear();
    for (model, state) in [(model, state), (frictionless, bare)] {
        let told = Memory::of(&model, &state).unwrap();
        let solver = gpu::Solver::new(device, model, state).unwrap();
        let (told, taken) = (told.bytes, solver.memory());
        // Beside rows of grains and entries there are the numbers of the scene and of steps, 17 KiB;
        // a row of 16 bytes a grain that is forgotten adds 8.
        println!("{told} bytes told, {taken} taken");
        assert!((0..22 << 10).contains(&(taken as i64 - told as i64)));
    }
}

fn timed(device: &Device) {
    let (model, state) = Bed::new(500, 7.0, 0.5, 1).sheared(0.01);
    let mut timed = gpu::Solver::new(device, model.clone(), state.clone()).unwrap();
    let Some(timing) = timed.time(100).unwrap() else {
        println!("no time stamps here");
        return;
    };
    // Two groups, fewer where the lists end before a group does.
    assert!((64..=128).contains(&timing.steps));
    let names: Vec<&str> = timing.sections.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["check", "search", "steps", "settle"]);
    assert!(timing.sections.iter().all(|(_, seconds)| *seconds >= 0.0));
    let mut other = gpu::Solver::new(device, model, state).unwrap();
    other.advance(timing.steps).unwrap();
    assert!(timed.snapshot().unwrap() == other.snapshot().unwrap());
}

fn lost(_: &Device) {
    let device = Device::open(shaders::Choice::Any).unwrap();
    let (model, state) = Bed::new(500, 7.0, 0.5, 1).sheared(0.01);
    let solver = gpu::Solver::new(&device, model, state).unwrap();
    let mut engine = Engine::Gpu(Box::new(solver));
    engine.advance(10).unwrap();
    device.destroy();
    let error = engine.advance(10).unwrap_err().to_string();
    assert!(error.contains("device"), "{error}");
    assert!(engine.snapshot().is_err());
}

/// The device goes while the second phase runs: the first one's end is there to go on from, and the
/// series holds what was read until then.
fn lost_in_mid_run(_: &Device) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let scene = small_shear(&["phase.consolidate.end.max_duration=10 s"]);
    let device = Device::open(shaders::Choice::Any).unwrap();
    let chosen = Chosen {
        machine: Machine::Gpu(device.clone()),
        why: "as the test wants".into(),
    };
    let state = out.join(STATE);
    let error = std::thread::scope(|threads| {
        threads.spawn(|| {
            for _ in 0..6000 {
                if state.exists() {
                    break;
                }
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
            // The second phase is well under way.
            std::thread::sleep(std::time::Duration::from_millis(500));
            device.destroy();
        });
        let options = options(Backend::Gpu, &out);
        run_on(&chosen, &scene, &options, &AtomicBool::new(false)).unwrap_err()
    });
    let error = format!("{error:#}");
    for part in [
        "results until then are in",
        "phase consolidate",
        "device was lost",
    ] {
        assert!(error.contains(part), "{error}");
    }
    let saved = state::load(&state).unwrap();
    let series = netcdf::open(&out.join("series.nc")).unwrap();
    let time: Vec<f64> = series.variable("time").unwrap().get_values(..).unwrap();
    assert!(saved.state.time > 0.0 && time.len() >= 4, "{time:?}");
    assert!(time[time.len() - 1] >= saved.state.time, "{time:?}");
}
