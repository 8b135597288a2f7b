//! A run that is killed leaves files that open, with all but its last second in them.
//!
//! In a target of its own: a process that is started inherits the open files of this one, with their
//! locks, and holds them for as long as it lives. Beside other tests, one of them could find a file
//! of its own locked.

use experiments::backend::Backend;
use experiments::run::{Options, run};
use experiments::scene::{Document, Scene};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Where this process is to run without end, instead of testing.
const OUT: &str = "ESKER_TEST_OUT";

const ENDLESS: &str = r#"
title = "Without end"
[box]
size = ["6 mm", "6 mm"]
[grains]
count   = 60
radius  = "0.5 mm"
density = "2600 kg/m^3"
[contact]
normal     = { stiffness = "1e5 N/m", damping = "0.1 N s/m" }
tangential = { stiffness = "3e4 N/m", friction = 0.5 }
[[phase]]
name = "settle"
end  = { duration = "1000 s" }
[output]
series.every   = "50 us"
profiles.every = "1 ms"
grains.every   = "1 ms"
contacts.every = "1 ms"
"#;

fn run_without_end(out: &Path) {
    let document = Document::new("scene.toml", Path::new("."), ENDLESS, &[]).unwrap();
    let options = Options {
        out: out.into(),
        backend: Backend::Cpu,
        threads: 1,
        force: true,
        quiet: true,
    };
    let scene = Scene::read(&document).unwrap();
    run(&scene, &options, &AtomicBool::new(false)).unwrap();
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
    if let Some(out) = std::env::var_os(OUT) {
        return run_without_end(Path::new(&out));
    }
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "a_killed_run_leaves_files_that_open"])
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

/// No file may grow beyond 4 MB, more than comes to it in the first second: a disk that is full looks like
/// that.
#[test]
#[cfg(target_os = "linux")]
fn a_run_that_cannot_write_any_more_says_so_and_leaves_files_that_open() {
    if let Some(out) = std::env::var_os(OUT) {
        return run_without_end(Path::new(&out));
    }
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let name = "a_run_that_cannot_write_any_more_says_so_and_leaves_files_that_open";
    let limited = "trap '' XFSZ; ulimit -f 4000; exec \"$0\" --exact \"$1\" --nocapture";
    let out = Command::new("bash")
        .args(["-c", limited])
        .arg(std::env::current_exe().unwrap())
        .arg(name)
        .env(OUT, folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(!out.status.success(), "it ended well");
    assert!(
        said.contains("cannot write") && said.contains("room on the disk"),
        "{said}"
    );
    assert!(rows(&at("series.nc"), &at("copy.nc")) > 1, "{said}");
}
