//! Wet runs that are stopped, and go on: as they would have, or with other water.

use super::protocol::begun;
use super::{after, go, options, series, text_after};
use crate::read;
use experiments::output::state;
use experiments::run::run;
use std::sync::atomic::AtomicBool;

#[test]
fn a_run_stopped_under_water_goes_on_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let loaded = after(&[]);
    go(&loaded, &at("whole"), 1);
    let stopped = run(&loaded, &options(&at("stopped"), 1), &AtomicBool::new(true)).unwrap();
    assert!(stopped.stopped());
    let half = state::load(&at("stopped").join("state.h5")).unwrap();
    assert_eq!(half.past.unfinished.as_ref().unwrap().phase, "load");
    assert!(half.past.water.is_some());
    assert!(half.state.time > loaded.start.time);
    // The last row is of the moment at which it stopped.
    let last = *series(&at("stopped"), "time").last().unwrap();
    assert!((last / half.state.time - 1.0).abs() < 1e-9, "{last} s");

    let keep = "phase.load.start=keep";
    let rest = read(&text_after(&at("stopped"), "press"), &[keep]).unwrap();
    go(&rest, &at("rest"), 1);
    let end = |name: &str| state::load(&at(name).join("state.h5")).unwrap();
    let (whole, rest) = (end("whole"), end("rest"));
    assert!((whole.state.time - rest.state.time).abs() < 1.5 * loaded.step);
    // Not the same bits, from the middle of a phase.
    let height = |saved: &state::Saved| -saved.state.walls[1].offset;
    let off = (height(&whole) / height(&rest) - 1.0).abs();
    assert!(off < 1e-4, "{off}");
}

#[test]
fn a_state_goes_on_with_other_water() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mut first = after(&["phase.load.end.duration=0.2 ms"]);
    first.phases.truncate(1);
    go(&first, &at("load"), 1);
    let saved = state::load(&at("load").join("state.h5")).unwrap();
    let left = &saved.past.water.as_ref().unwrap().state.pressure;
    let base = left[..4].iter().sum::<f64>() / 4.0;
    assert!(base > 500.0, "{left:?} Pa");
    let text = text_after(&at("load"), "load");
    let pressure = |name: &str, sets: &[&str]| {
        let mut scene = read(&text, sets).unwrap_or_else(|e| panic!("{e}"));
        // It begins with the pressure that was left.
        let begun = begun(&scene).water().unwrap().unwrap().now.pressure;
        let pairs = begun.iter().zip(left);
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-9 * base));
        scene.phases[0].end.duration = 2e-4;
        go(&scene, &at(name), 1);
        series(&at(name), "pore_pressure_base")
    };
    let still = "phase.shear.shear.strain_rate=1e-3 1/s";
    let tight = pressure("tight", &[still, "water.sides.top=tight"]);
    let open = pressure("open", &[still, "water.bed.permeability=2e-11 m^2"]);
    assert!(tight.last().unwrap() > &(0.5 * base), "{tight:?}");
    // The first row is an interval later. Then the wall comes down on a bed that yields.
    assert!(open[0] < 0.6 * tight[0], "{open:?} {tight:?}");
    // But not with other cells.
    let error = read(&text, &["water.spacing=1 mm"])
        .unwrap_err()
        .to_string();
    assert!(error.contains("water.spacing"), "{error}");
}
