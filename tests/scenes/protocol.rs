//! Phases hand the bed on as the laboratory would.

use super::{SMALL, read};
use dem::{Horizontal, State};
use experiments::backend::Backend;
use experiments::output::{FileKind, state};
use experiments::protocol::{TOP, prepare, start_height};
use experiments::run::{Options, Outcome, Summary, run};
use experiments::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

fn go(scene: &Scene, out: &Path, threads: usize) -> (State, Summary) {
    let options = Options {
        out: out.to_path_buf(),
        backend: Backend::Cpu,
        threads,
        force: true,
        quiet: true,
    };
    let summary = run(scene, &options, &AtomicBool::new(false)).unwrap();
    (state::load(&out.join("state.h5")).unwrap().state, summary)
}

/// Only the phases from `first` on.
fn from(text: &str, first: &str) -> String {
    let head = text.split("[[phase]]").next().unwrap();
    let tail = text.split("[[phase]]").skip(1);
    let kept = tail.skip_while(|phase| {
        !phase.contains(&format!("name = {first:?}"))
            && !phase.contains(&format!("name  = {first:?}"))
    });
    let phases: Vec<&str> = kept.collect();
    format!("{head}[[phase]]{}", phases.join("[[phase]]"))
}

/// The shear alone, from the state in `file`.
fn going_on(file: &Path) -> String {
    let grains = "count   = 60\nradius  = \"0.5 mm\"\ndensity = \"2600 kg/m^3\"";
    from(SMALL, "shear").replace(grains, &format!("state = {file:?}"))
}

/// A state at the end of the consolidation, in `folder`.
fn consolidated(folder: &Path) -> PathBuf {
    let mut scene = read(SMALL, &[]).unwrap();
    scene.phases.truncate(2);
    go(&scene, folder, 1);
    folder.join("state.h5")
}

#[test]
fn going_on_from_a_state_gives_the_bits_of_not_having_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let whole = read(SMALL, &[]).unwrap();
    let (end, _) = go(&whole, &folder.path().join("whole"), 1);

    let mut first = whole.clone();
    first.phases.truncate(2);
    let half = folder.path().join("half");
    go(&first, &half, 2);
    let rest = read(&going_on(&half.join("state.h5")), &[]).unwrap();
    assert_eq!(rest.phases.len(), 1);
    let (continued, _) = go(&rest, &folder.path().join("rest"), 2);
    assert!(end == continued, "the bits differ");
}

#[test]
fn a_pushed_wall_begins_on_the_highest_grain() {
    let scene = read(SMALL, &["box.size=[\"6 mm\", \"6 mm\", \"1 m\"]"]).unwrap();
    let wall_height = |state: &State| -state.walls[TOP].offset;
    assert_eq!(wall_height(&scene.start), 1.0);
    let held = prepare(&scene, &scene.phases[0], scene.start.clone(), None).unwrap();
    assert_eq!(wall_height(&held.state), 1.0);
    assert!(held.height < 0.1);
    let pushed = prepare(&scene, &scene.phases[1], scene.start.clone(), None).unwrap();
    let grains = &scene.start.grains;
    let tops = grains.position.iter().zip(&grains.radius);
    let highest = tops.map(|(p, r)| p.z + r).fold(0.0, f64::max);
    assert_eq!(wall_height(&pushed.state), highest);
}

#[test]
fn shear_holds_the_lowest_layer_and_starts_from_a_linear_profile() {
    let scene = read(SMALL, &[]).unwrap();
    let mut state = scene.start.clone();
    state.grains.velocity.fill(glam::DVec3::ONE);
    state.grains.angular_velocity.fill(glam::DVec3::ONE);
    let ready = prepare(&scene, &scene.phases[2], state.clone(), None).unwrap();
    let (grains, layer) = (&ready.state.grains, 0.6e-3);
    let top = 5.0 * ready.height;
    let lowest = grains.position.iter().zip(&grains.radius);
    let floor = lowest.map(|(p, r)| p.z - r).fold(f64::INFINITY, f64::min);
    for k in 0..grains.len() {
        let (z, v) = (grains.position[k].z - floor, grains.velocity[k]);
        let constraint = grains.constraint[k];
        let (horizontal, speed) = if z < layer {
            (Horizontal::Held, 0.0)
        } else if z > ready.height - layer {
            (Horizontal::Driven, top)
        } else {
            (
                Horizontal::Free,
                top * (z - layer) / (ready.height - 2.0 * layer),
            )
        };
        assert_eq!(constraint.horizontal, horizontal);
        assert_eq!(constraint.rotation_held, horizontal != Horizontal::Free);
        approx::assert_relative_eq!(v.x, speed, max_relative = 1e-12);
        assert_eq!((v.y, v.z), (0.0, 0.0));
        assert_eq!(grains.angular_velocity[k], glam::DVec3::ZERO);
    }
    // A phase without shear lets go of them.
    let after = prepare(&scene, &scene.phases[1], ready.state, None).unwrap();
    assert!(
        after
            .state
            .grains
            .constraint
            .iter()
            .all(|c| c.horizontal == Horizontal::Free)
    );

    let kept = read(SMALL, &["phase.shear.start=keep"]).unwrap();
    let kept = prepare(&kept, &kept.phases[2], state.clone(), None).unwrap();
    assert_eq!(kept.state.grains.velocity, state.grains.velocity);
}

#[test]
fn layers_that_leave_nothing_between_them_are_refused() {
    let mut scene = read(SMALL, &[]).unwrap();
    scene.phases[2].layer = 0.6 * start_height(&scene);
    let error = prepare(&scene, &scene.phases[2], scene.start.clone(), None).unwrap_err();
    assert!(
        error.to_string().contains("write a smaller layer"),
        "{error}"
    );
}

#[test]
fn a_strain_is_reached_and_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let scene = read(SMALL, &[]).unwrap();
    let (_, summary) = go(&scene, folder.path(), 1);
    let shear = &summary.phases[2];
    assert_eq!(shear.outcome, Outcome::Strain);
    let (strain, _) = shear.shear.unwrap();
    assert!((0.005..0.005001).contains(&strain), "{strain}");
}

#[test]
fn a_bed_comes_to_rest_before_its_time_is_up() {
    let folder = tempfile::tempdir().unwrap();
    let sets = [
        "phase.consolidate.end={ at_rest = 1e-3, max_duration = \"1 s\" }",
        "contact.normal.damping=\"0.5 N s/m\"",
        // Without it springs under grains that roll to and fro swing on for a second in some beds.
        "contact.tangential.damping=\"0.5 N s/m\"",
    ];
    let mut scene = read(SMALL, &sets).unwrap();
    scene.phases.remove(2);
    let (state, summary) = go(&scene, folder.path(), 1);
    assert_eq!(summary.phases[1].outcome, Outcome::AtRest);
    assert!(state.time < 0.5);
    assert!(!state.contacts.is_empty());
}

#[test]
fn a_stopped_run_leaves_what_it_computed() {
    let folder = tempfile::tempdir().unwrap();
    let scene = read(SMALL, &["phase.settle.end.duration=1000 s"]).unwrap();
    let options = Options {
        out: folder.path().to_path_buf(),
        backend: Backend::Cpu,
        threads: 1,
        force: false,
        quiet: true,
    };
    let summary = run(&scene, &options, &AtomicBool::new(true)).unwrap();
    assert!(summary.stopped());
    assert_eq!(summary.phases.len(), 1);
    let state = state::load(&folder.path().join("state.h5")).unwrap().state;
    assert!(state.time > 0.0 && state.time < 10.0);
    assert!(folder.path().join("series.nc").is_file());
}

#[test]
fn a_state_brings_its_box_and_refuses_another() {
    let folder = tempfile::tempdir().unwrap();
    let text = going_on(&consolidated(folder.path()));
    let stated = read(&text, &[]).unwrap();
    let left_out = text.replace("[box]\nsize = [\"6 mm\", \"6 mm\"]", "");
    assert!(!left_out.contains("[box]"));
    assert_eq!(read(&left_out, &[]).unwrap().domain, stated.domain);

    let refused = |set: &str| read(&text, &[set]).unwrap_err().to_string();
    let other = refused("box.size=[\"6 mm\", \"7 mm\"]");
    assert!(
        other.contains("is 0.007 m along y, but the state was made in 0.006 m"),
        "{other}"
    );
    let walls = refused("box.sides.x=walls");
    assert!(
        walls.contains("box.sides.x: is not what the state was made with, \"periodic\""),
        "{walls}"
    );
    let height = refused("box.size=[\"6 mm\", \"6 mm\", \"9 mm\"]");
    assert!(height.contains("knows where its top wall is"), "{height}");
}

#[test]
fn a_state_without_grains_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = consolidated(folder.path());
    let mut saved = state::load(&path).unwrap();
    saved.state.grains = dem::Grains::default();
    saved.state.contacts.clear();
    let header = experiments::output::Header {
        title: String::new(),
        scene: String::new(),
        seed: Some(1),
        backend: "cpu",
        device: "a processor".into(),
    };
    state::save(&path, &saved, &header).unwrap();
    let error = read(&going_on(&path), &[]).unwrap_err().to_string();
    assert!(error.contains("grains.state: holds no grain"), "{error}");
}

#[test]
fn a_run_that_is_refused_leaves_old_results() {
    let folder = tempfile::tempdir().unwrap();
    let path = consolidated(folder.path());
    let text = going_on(&path);
    let mut scene = read(&text, &[]).unwrap();
    let options = Options {
        out: folder.path().to_path_buf(),
        backend: Backend::Cpu,
        threads: 1,
        force: true,
        quiet: true,
    };
    let never = AtomicBool::new(false);
    scene.phases[0].layer = start_height(&scene);
    let all = || {
        let entries = std::fs::read_dir(folder.path()).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        let files = paths.filter(|path| path.is_file());
        let bytes = files.map(|path| (path.clone(), std::fs::read(path).unwrap()));
        bytes.collect::<std::collections::BTreeMap<_, _>>()
    };
    let before = all();
    assert_eq!(before.len(), 4, "series, profiles, grains and state");
    assert!(run(&scene, &options, &never).is_err());
    assert!(before == all(), "a layer without room");

    // Some of the files can be made, not all.
    let mut scene = read(&text, &[]).unwrap();
    scene.output.files[FileKind::Grains]
        .as_mut()
        .unwrap()
        .variables = vec!["vorticity".into()];
    assert!(run(&scene, &options, &never).is_err());
    assert!(before == all(), "an unknown variable");
    let scene = read(&text, &["output.contacts.every=1 ms"]).unwrap();
    std::fs::create_dir(folder.path().join("contacts.nc")).unwrap();
    assert!(run(&scene, &options, &never).is_err());
    assert!(before == all(), "a name that is taken");

    // A run that is not refused replaces all.
    let scene = read(&text, &["output.grains=none"]).unwrap();
    std::fs::remove_dir(folder.path().join("contacts.nc")).unwrap();
    run(&scene, &options, &never).unwrap();
    let after = all();
    assert_eq!(after.len(), 3, "grains.nc is of the run before");
    assert!(after.iter().all(|(path, bytes)| before[path] != *bytes));
}

#[test]
fn a_stopped_shear_goes_on_to_the_strain_that_it_was_to_reach() {
    let folder = tempfile::tempdir().unwrap();
    let text = going_on(&consolidated(folder.path()));
    let scene = read(&text, &["phase.shear.end.strain=0.05"]).unwrap();
    let (whole, _) = go(&scene, &folder.path().join("whole"), 1);

    let options = Options {
        out: folder.path().join("stopped"),
        backend: Backend::Cpu,
        threads: 1,
        force: false,
        quiet: true,
    };
    let stopped = run(&scene, &options, &AtomicBool::new(true)).unwrap();
    assert!(stopped.stopped());
    let saved = state::load(&options.out.join("state.h5")).unwrap();
    assert!(saved.past.strain > 0.0 && saved.past.strain < 0.04);

    let text = going_on(&options.out.join("state.h5"));
    let sets = ["phase.shear.end.strain=0.05", "phase.shear.start=keep"];
    let rest = read(&text, &sets).unwrap();
    let (end, summary) = go(&rest, &folder.path().join("rest"), 1);
    let (strain, _) = summary.phases[0].shear.unwrap();
    assert!((0.05..0.05001).contains(&strain), "{strain}");
    assert!((end.time - whole.time).abs() < 1.5 * scene.step);
    let saved = state::load(&folder.path().join("rest/state.h5")).unwrap();
    assert_eq!(saved.past.strain, strain);
    assert_eq!(saved.past.unfinished, None);
}

#[test]
fn the_summary_and_the_series_know_one_solid_fraction() {
    let folder = tempfile::tempdir().unwrap();
    let (_, summary) = go(&read(SMALL, &[]).unwrap(), folder.path(), 1);
    let path = folder.path().join("series.nc");
    let series = experiments::output::netcdf::open(&path).unwrap();
    let fraction = series.variable("solid_fraction").unwrap();
    let last = *fraction.get_values::<f64, _>(..).unwrap().last().unwrap();
    assert_eq!(summary.phases[2].solid_fraction, last);
}
