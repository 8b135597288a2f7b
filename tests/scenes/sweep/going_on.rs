//! Sweeps that fail in part or are stopped; tests/python/test_sweep.py kills one.

use super::super::SMALL;
use super::{WATER, all, alone, go, grid, planned, values};
use experiments::output::{state, water_state};
use experiments::sweep::{Folder, Outcome, Plan, collect};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

/// A wall that comes down so fast passes through the bed.
const FALLING: &str = "phase.consolidate.top={ velocity = \"1 mm/s\" },{ velocity = \"10 m/s\" }";

#[test]
fn failures_are_told_and_stop_no_other_point() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let plan = planned(SMALL, grid(&[FALLING, "phase.shear.friction=0.3,0.4"]), out);
    for _ in 0..2 {
        let tally = go(&plan, out, &AtomicBool::new(false));
        assert_eq!(tally.done, 2);
        let failed: Vec<usize> = tally.failed.iter().map(|(point, _)| *point).collect();
        assert_eq!(failed, [2, 3]);
        let reason = &tally.failed[0].1;
        assert!(reason.contains("consolidate-1, which failed"), "{reason}");
    }
    let sweep = Folder {
        path: out,
        plan: &plan,
    };
    let failed = sweep.outcome(plan.find("consolidate-1").unwrap()).unwrap();
    assert!(matches!(failed, Some(Outcome::Failed { .. })));
    let status = collect(sweep).unwrap();
    assert!(status[0].is_none() && status[1].is_none());
    assert!(status[2].as_ref().unwrap().starts_with("consolidate-1: "));
    let table = std::fs::read_to_string(out.join("points.csv")).unwrap();
    assert_eq!(
        table
            .lines()
            .filter(|line| line.contains(",not done,"))
            .count(),
        2
    );
    assert_eq!(
        values(&out.join("sweep.nc"), "status"),
        [0.0, 0.0, 1.0, 1.0]
    );
    let dilation = values(&out.join("sweep.nc"), "dilation_late");
    assert!(dilation[..2].iter().all(|f| f.is_finite()), "{dilation:?}");
    assert!(dilation[2..].iter().all(|f| f.is_nan()), "{dilation:?}");
}

/// Stop the sweep some time after `file` has come to be.
fn stopped(plan: &Plan, out: &Path, file: &str) {
    let stop = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            wait_for(&out.join(file));
            thread::sleep(Duration::from_millis(150));
            stop.store(true, Ordering::Relaxed);
        });
        let tally = go(plan, out, &stop);
        assert!(tally.done < plan.ends.len(), "it was stopped too late");
    });
}

fn wait_for(file: &Path) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !file.exists() {
        assert!(Instant::now() < deadline, "{} never came", file.display());
        thread::sleep(Duration::from_millis(5));
    }
}

fn changed(file: &Path) -> SystemTime {
    std::fs::metadata(file).unwrap().modified().unwrap()
}

/// A bed that is sheared for some seconds of computing.
fn long() -> String {
    SMALL.replace("strain = 0.005", "strain = 1.0")
}

#[test]
fn a_stopped_sweep_goes_on_and_repeats_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let plan = planned(
        &long(),
        grid(&["phase.shear.shear.strain_rate=5,50 1/s"]),
        out,
    );
    stopped(&plan, out, "consolidate-0/outcome.json");
    let unfinished = state::load(&out.join("shear-0/state.h5")).unwrap();
    let unfinished = unfinished.past.unfinished.expect("it was in its middle");
    assert_eq!(unfinished.phase, "shear");
    let bed = changed(&out.join("consolidate-0/state.h5"));
    all(&plan, out);
    assert_eq!(changed(&out.join("consolidate-0/state.h5")), bed);
    assert!(out.join("shear-0/before-1/series.nc").exists());
    let sweep = Folder {
        path: out,
        plan: &plan,
    };
    collect(sweep).unwrap();
    // The whole phase is there, in order, and it ends at its strain.
    let file = out.join("sweep.nc");
    let (time, strain) = (values(&file, "time"), values(&file, "strain"));
    let own = time.len() / 2;
    let time: Vec<f64> = time[..own]
        .iter()
        .copied()
        .filter(|t| t.is_finite())
        .collect();
    assert!(time.windows(2).all(|t| t[0] < t[1]), "{time:?}");
    let last = strain[time.len() - 1];
    assert!((last - 1.0).abs() < 2e-3, "{last}");
    let gap = time.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    // 0.2 s of shear in 1000 rows, as chosen.
    assert!(gap < 1e-3, "{gap} s between two rows");
}

/// From any state, not only from the end.
#[test]
fn stopped_water_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let long = WATER.replace("duration = \"2 ms\"", "duration = \"0.1 s\"");
    let plan = planned(&long, grid(&["water.bed.permeability=1e-12 m^2"]), &out);
    stopped(&plan, &out, "water-0/series.nc");
    let part = water_state::load(&out.join("water-0/state.h5")).unwrap();
    assert!(part.state.time > 0.0 && part.state.time < 0.099);
    all(&plan, &out);
    let own = folder.path().join("alone");
    alone(&long, &[], &own);
    let load = |path: &Path| water_state::load(&path.join("state.h5")).unwrap().state;
    let (one, other) = (load(&own), load(&out.join("water-0")));
    assert_eq!(one.populations, other.populations);
    assert_eq!(one.pressure, other.pressure);
}

#[test]
fn two_programs_do_not_work_on_one_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let plan = planned(SMALL, grid(&["seed=1,2"]), folder.path());
    let sweep = Folder {
        path: folder.path(),
        plan: &plan,
    };
    let held = sweep.hold(true).unwrap();
    let error = sweep.hold(true).unwrap_err().to_string();
    assert!(error.contains("another esker"), "{error}");
    assert!(sweep.hold(false).is_err());
    drop(held);
    let (_one, _other) = (sweep.hold(false).unwrap(), sweep.hold(false).unwrap());
    assert!(sweep.hold(true).is_err());
}
