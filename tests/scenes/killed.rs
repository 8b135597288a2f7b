//! A run that is killed leaves files that open, with all but its last second in them.

use super::{SMALL, read};
use experiments::backend::Backend;
use experiments::run::{Options, run};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::thread::sleep;
use std::time::{Duration, Instant};

const OUT: &str = "ESKER_TEST_OUT";

#[test]
#[ignore = "has no end: the test below starts it in a process of its own, and kills that"]
fn a_run_without_end() {
    let sets = [
        "phase.settle.end.duration=1000 s",
        "output.series.every=50 us",
        "output.profiles.every=1 ms",
        "output.grains.every=1 ms",
        "output.contacts.every=1 ms",
    ];
    let options = Options {
        out: std::env::var_os(OUT)
            .expect("the test below sets it")
            .into(),
        backend: Backend::Cpu,
        threads: 1,
        force: true,
        quiet: true,
    };
    run(
        &read(SMALL, &sets).unwrap(),
        &options,
        &AtomicBool::new(false),
    )
    .unwrap();
}

/// Rows in the file as it is on the disk now; none if it does not open.
fn rows(file: &Path, copy: &Path) -> usize {
    let copied = std::fs::copy(file, copy).is_ok();
    let open = || experiments::output::netcdf::open(copy).ok();
    let time = copied.then(open).flatten().map(|file| {
        let time: Vec<f64> = file.variable("time").unwrap().get_values(..).unwrap();
        assert!(time.windows(2).all(|t| t[0] < t[1]), "{time:?}");
        time.len()
    });
    time.unwrap_or(0)
}

/// The kill comes between two moments at which rows go to the disk.
#[test]
fn a_killed_run_leaves_files_that_open() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "killed::a_run_without_end", "--ignored"])
        .env(OUT, folder.path())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let deadline = Instant::now() + Duration::from_secs(60);
    while rows(&at("contacts.nc"), &at("copy.nc")) < 2 {
        assert!(Instant::now() < deadline, "the rows never came to the disk");
        sleep(Duration::from_millis(20));
    }
    sleep(Duration::from_millis(300));
    assert_eq!(child.try_wait().unwrap(), None, "it ended by itself");
    // The kill that nobody can catch.
    child.kill().unwrap();
    child.wait().unwrap();
    for name in ["series.nc", "profiles.nc", "grains.nc", "contacts.nc"] {
        assert!(rows(&at(name), &at("copy.nc")) > 1, "{name}");
    }
}
