//! The text in the results gives the same run to the bit, and so does a state; what is there is
//! not lost.

use super::{BED, PIPE, go, options, read, ready};
use experiments::ready::ALL;
use experiments::scene::tree::Step;
use experiments::scene::{AnyScene, Document, WaterScene};
use experiments::water::{Outcome, run};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The scene of `scene`'s text must be the same, and its text too: nothing is left to choose.
fn again(scene: &WaterScene) -> WaterScene {
    let again = read(&scene.text, &[]).unwrap_or_else(|e| panic!("{e}\n{}", scene.text));
    assert_eq!(scene.text, again.text);
    assert!(*scene == again, "not the same scene:\n{}", scene.text);
    again
}

fn says(text: &str, path: &str) -> bool {
    let document = Document::new("scene.toml", Path::new("."), text, &[]).unwrap();
    let mut steps = path.split('.').map(|word| Step::Key(word.into()));
    steps
        .try_fold(&document.root, |node, step| node.down(&step))
        .is_some()
}

#[test]
fn everything_that_was_chosen_is_said() {
    let keys = [
        "box.sides.x",
        "box.sides.z",
        "water.liquid.density",
        "water.liquid.viscosity",
        "water.liquid.compressibility",
        "water.precision",
        "water.inertia",
        "water.sides.bottom",
        "water.sides.top",
        "water.acceleration",
        "water.speed",
        "water.regime",
        "water.step",
        "water.start.pressure",
        "water.start.flow",
        "output.series.every",
        "output.series.variables",
        "output.fluid.every",
        "output.fluid.variables",
    ];
    let text = read(PIPE, &[]).unwrap().text;
    for key in keys {
        assert!(!says(PIPE, key), "{key} was there before");
        assert!(says(&text, key), "{key} is not in:\n{text}");
    }
    let bed = read(BED, &[]).unwrap().text;
    assert!(says(&bed, "water.bed.forchheimer"), "{bed}");
}

#[test]
fn the_resolved_scene_is_the_same_scene() {
    for experiment in ALL {
        let text = experiment.scene();
        let document = Document::new(experiment.name, &experiment.folder(), text, &[]).unwrap();
        if let AnyScene::Water(scene) = AnyScene::read(&document).unwrap() {
            again(&scene);
        }
    }
    let sine = "water.sides.top={ pressure = { amplitude = \"1 kPa\", frequency = \"3 Hz\" } }";
    for sets in [
        &[sine][..],
        &["water.precision=f32"],
        &["output.fluid=none"],
    ] {
        again(&read(BED, sets).unwrap());
    }
}

/// Bits of all numbers in the files of a run.
fn results(scene: &WaterScene, out: &Path) -> Vec<Vec<u64>> {
    go(scene, out);
    let mut found = Vec::new();
    for name in ["series.nc", "fluid.nc"] {
        let file = experiments::output::netcdf::open(&out.join(name)).unwrap();
        for variable in file.variables().filter(|v| v.name() != "component") {
            let values: Vec<f64> = variable.get_values(..).unwrap();
            found.push(values.into_iter().map(f64::to_bits).collect());
        }
    }
    found
}

#[test]
fn the_resolved_scene_gives_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    for (k, precision) in ["f32", "f64"].into_iter().enumerate() {
        let set = format!("water.precision={precision}");
        let scene = read(BED, &[&set]).unwrap();
        let first = results(&scene, &folder.path().join(format!("{k}")));
        let second = results(&again(&scene), &folder.path().join(format!("{k}-again")));
        assert!(first.len() > 10 && first == second);
    }
}

/// The step is that of the state where the scene is silent; with another one populations mean
/// nothing, and pressure and flow are taken over alone.
#[test]
fn a_state_of_another_lattice_gives_pressure_and_flow_alone() {
    let folder = tempfile::tempdir().unwrap();
    go(&read(BED, &["water.step=4 us"]).unwrap(), folder.path());
    let file = folder.path().join("state.h5");
    let saved = experiments::output::water_state::load(&file).unwrap();
    let state = format!("water.start={{ state = {file:?} }}");
    let silent = read(BED, &[&state]).unwrap();
    assert_eq!(silent.water.scaling.step, 4e-6);
    assert!(silent.water.start == saved.state && silent.water.warnings(1000).is_empty());
    let other = read(BED, &[&state, "water.step=2 us"]).unwrap().water;
    assert_eq!(other.start.pressure, saved.state.pressure);
    assert!(other.start.populations.is_empty());
    assert!(
        other
            .warnings(1000)
            .iter()
            .any(|w| w.contains("another step"))
    );
}

/// A run that goes on from its state ends with the bits of one that was not stopped.
#[test]
fn a_state_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for precision in ["f32", "f64"] {
        let set = format!("water.precision={precision}");
        let whole = read(BED, &[&set, "water.step=4 us", "end.duration=2 ms"]).unwrap();
        let out = at(&format!("whole-{precision}"));
        go(&whole, &out);
        let half = read(BED, &[&set, "water.step=4 us", "end.duration=1 ms"]).unwrap();
        let first = at(&format!("half-{precision}"));
        go(&half, &first);
        let state = format!("water.start={{ state = {:?} }}", first.join("state.h5"));
        let sets = [set.as_str(), "water.step=4 us", "end.duration=1 ms", &state];
        let rest = again(&read(BED, &sets).unwrap());
        let second = at(&format!("rest-{precision}"));
        go(&rest, &second);
        let pressure = |out: &Path| {
            let saved = experiments::output::water_state::load(&out.join("state.h5")).unwrap();
            (saved.state.pressure, saved.state.populations)
        };
        assert!(
            pressure(&out) == pressure(&second),
            "{precision}: the bits differ"
        );
        assert!(pressure(&out) != pressure(&first));
    }
}

/// Also where a side varies, whatever the step at which the run was stopped: the time of a state is
/// a sum of steps that must not round differently.
#[test]
fn a_state_goes_on_with_the_same_bits_under_a_side_that_varies() {
    let folder = tempfile::tempdir().unwrap();
    let sine = "water.sides.top={ pressure = { amplitude = \"1 kPa\", period = \"3 ms\" } }";
    let step = "water.step=3.7 us";
    let load = |out: &Path| experiments::output::water_state::load(&out.join("state.h5")).unwrap();
    let whole = read(BED, &[sine, step, "end.duration=1.85 ms"]).unwrap();
    assert_eq!(whole.steps(), 500);
    let out = folder.path().join("whole");
    go(&whole, &out);
    for stopped in [123, 377] {
        let at = |name: &str| folder.path().join(format!("{name}-{stopped}"));
        let duration = |steps: u32| format!("end.duration={:?} s", f64::from(steps) * 3.7e-6);
        go(
            &read(BED, &[sine, step, &duration(stopped)]).unwrap(),
            &at("first"),
        );
        let state = format!(
            "water.start={{ state = {:?} }}",
            at("first").join("state.h5")
        );
        let rest = read(BED, &[sine, &state, &duration(500 - stopped)]).unwrap();
        assert_eq!(rest.steps(), u64::from(500 - stopped));
        go(&rest, &at("rest"));
        assert!(
            load(&out).state == load(&at("rest")).state,
            "stopped after {stopped}"
        );
    }
}

#[test]
fn a_run_that_is_stopped_keeps_its_results_and_tells_what_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let scene = ready("poiseuille", &[]);
    let summary = run(&scene, &options(folder.path()), &AtomicBool::new(true)).unwrap();
    assert_eq!(summary.outcome, Outcome::Stopped);
    assert!(summary.left > 4.9 && summary.duration > 0.0);
    for file in ["series.nc", "fluid.nc", "state.h5"] {
        assert!(folder.path().join(file).is_file(), "{file}");
    }
    let refused = run(&scene, &options(folder.path()), &AtomicBool::new(true)).unwrap_err();
    assert!(refused.to_string().contains("--force"), "{refused}");
    let forced = experiments::run::Options {
        force: true,
        ..options(folder.path())
    };
    run(&scene, &forced, &AtomicBool::new(true)).unwrap();
}
