//! Do the files hold what the writer was given, described, on the disk, errors and all?

use super::everything;
use dem::contact::Tension;
use dem::{Body, Contact, Domain, Grains, History, Ledger, Model, Snapshot, Sums, Surface, Wall};
use enum_map::EnumMap;
use experiments::output::{FileKind, Frame, Header, Plan, Writer};
use glam::DVec3;
use netcdf::types::NcVariableType;
use netcdf::{AttributeValue, File};
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use tests::{floor, smooth};

/// Two grains on each other between walls 4 m apart, over 12 m²; `contacts` of the
/// three are there.
fn frame(time: f64, contacts: usize) -> Frame {
    let at = |z| DVec3::new(1.5, 1.5, z);
    let law = smooth(1e6, 0.0, Tension::Clip);
    let bottom = floor(Surface::Frictionless);
    let top = Wall {
        normal: DVec3::NEG_Z,
        ..bottom.clone()
    };
    let model = Model {
        domain: Domain {
            size: [3.0, 4.0],
            periodic: [true, true],
        },
        walls: vec![bottom, top],
        ..tests::model(law, &Grains::default())
    };
    let mut state = tests::state(&[(at(1.0), 1.0), (at(3.0), 1.0)], 2);
    state.time = time;
    state.walls[1].offset = -4.0;
    let contact = |i, j, push: f64, arm: f64| Contact {
        i,
        j,
        history: History::default(),
        force: push * DVec3::Z,
        overlap: 1e-8,
        branch: arm * DVec3::Z,
    };
    state.contacts = vec![
        contact(0, Body::Grain(1), -8.0, -2.0),
        contact(0, Body::Wall(0), 8.0, 1.0),
        contact(1, Body::Wall(1), -8.0, -1.0),
    ];
    state.contacts.truncate(contacts);
    let snapshot = Snapshot {
        state,
        force: vec![DVec3::ZERO; 2],
        torque: vec![DVec3::ZERO; 2],
        wall_force: vec![8.0, 8.0],
        held_force: 3.0,
        driven_force: -6.0,
        sums: Sums::default(),
        ledger: Ledger::default(),
    };
    Frame {
        model: Arc::new(model),
        snapshot: Arc::new(snapshot),
        before: Sums::default(),
        water: None,
        phase: 1,
        strain: 10.0 * time,
        dilation: 0.02,
        due: EnumMap::from_fn(|_| true),
    }
}

/// What [`everything`] is, for this bed.
fn all() -> Plan {
    Plan {
        profile_edges: vec![0.0, 2.0, 4.0],
        ..everything()
    }
}

fn start(dir: &Path, plan: &Plan) -> Result<Writer, String> {
    let header = Header {
        title: "a column".into(),
        scene: "seed = 7\n".into(),
        seed: Some(7),
        backend: "cpu",
        device: "a processor".into(),
    };
    let phases = ["settle", "first shear"].map(String::from);
    Writer::create(
        dir,
        &header,
        plan,
        &phases,
        &frame(0.0, 0).snapshot.state.grains,
    )
    .map_err(|error| format!("{error:#}"))
}

fn open(dir: &Path, name: &str) -> File {
    experiments::output::netcdf::open(&dir.join(name)).unwrap()
}

fn values(file: &File, name: &str) -> Vec<f64> {
    file.variable(name).unwrap().get_values(..).unwrap()
}

fn text(attribute: Option<AttributeValue>) -> String {
    attribute.unwrap().try_into().unwrap()
}

#[test]
fn what_is_sent_can_be_read() {
    let dir = tempfile::tempdir().unwrap();
    let writer = start(dir.path(), &all()).unwrap();
    writer.send(frame(0.1, 3)).unwrap();
    writer.send(frame(0.2, 2)).unwrap();
    writer.finish().unwrap();

    let series = open(dir.path(), "series.nc");
    assert_eq!(values(&series, "time"), [0.1, 0.2]);
    assert_eq!(values(&series, "strain"), [1.0, 2.0]);
    assert_eq!(values(&series, "dilation"), [0.02, 0.02]);
    assert_eq!(values(&series, "shear_stress_top"), [0.5, 0.5]);
    assert_eq!(values(&series, "coordination_number"), [1.0, 1.0]);

    let profiles = open(dir.path(), "profiles.nc");
    assert_eq!(values(&profiles, "z"), [1.0, 3.0]);
    assert_eq!(values(&profiles, "z_bounds"), [0.0, 2.0, 2.0, 4.0]);
    let stress = values(&profiles, "stress");
    let expected = f64::from(8.0_f32 / 12.0);
    // time, z, component, face; the last contact is missing from the second row.
    let zz: Vec<_> = stress.iter().skip(8).step_by(9).copied().collect();
    assert_eq!(zz, [expected, expected, expected, 0.5 * expected]);

    let grains = open(dir.path(), "grains.nc");
    assert_eq!(values(&grains, "grain"), [0.0, 1.0]);
    assert_eq!(values(&grains, "radius"), [1.0, 1.0]);
    assert_eq!(
        values(&grains, "position")[..6],
        [1.5, 1.5, 1.0, 1.5, 1.5, 3.0]
    );

    let contacts = open(dir.path(), "contacts.nc");
    assert_eq!(values(&contacts, "offset"), [0.0, 3.0]);
    assert_eq!(values(&contacts, "count"), [3.0, 2.0]);
    let pairs = [0.0, 1.0, 0.0, -1.0, 1.0, -2.0, 0.0, 1.0, 0.0, -1.0];
    assert_eq!(values(&contacts, "pair"), pairs);
}

#[test]
fn everything_is_described() {
    let dir = tempfile::tempdir().unwrap();
    start(dir.path(), &all()).unwrap().finish().unwrap();
    for name in ["series.nc", "profiles.nc", "grains.nc", "contacts.nc"] {
        let file = open(dir.path(), name);
        let global = |key| file.attribute(key).map(|a| a.value().unwrap());
        assert_eq!(text(global("title")), "a column");
        assert_eq!(text(global("scene")), "seed = 7\n");
        for key in ["Conventions", "version", "commit", "machine", "seed"] {
            assert!(global(key).is_some(), "{name} lacks {key}");
        }
        for variable in file.variables() {
            let attribute = |key| variable.attribute_value(key).transpose().unwrap();
            let (label, name) = (text(attribute("long_name")), variable.name());
            assert!(!label.is_empty());
            if variable.vartype() != NcVariableType::String {
                assert!(attribute("units").is_some(), "{name} lacks units");
            }
        }
        let phase = file.variable("phase").unwrap();
        let attribute = |key| phase.attribute_value(key).transpose().unwrap();
        assert_eq!(text(attribute("flag_meanings")), "settle first_shear");
    }
}

#[test]
fn rows_are_on_the_disk_before_the_end() {
    let dir = tempfile::tempdir().unwrap();
    let writer = start(dir.path(), &all()).unwrap();
    writer.send(frame(0.1, 3)).unwrap();
    // A copy is what a killed run would leave.
    let copy = dir.path().join("copy.nc");
    let deadline = Instant::now() + Duration::from_secs(20);
    let rows = || {
        std::fs::copy(dir.path().join("contacts.nc"), &copy).unwrap();
        experiments::output::netcdf::open(&copy).map_or(vec![], |file| values(&file, "time"))
    };
    while rows() != [0.1] {
        assert!(Instant::now() < deadline, "the row never came to the disk");
        thread::sleep(Duration::from_millis(20));
    }
    drop(writer);
}

#[test]
fn an_error_of_the_thread_comes_back_with_its_place() {
    let dir = tempfile::tempdir().unwrap();
    let writer = start(dir.path(), &all()).unwrap();
    let mut crowded = frame(0.3, 3);
    let snapshot = Arc::make_mut(&mut crowded.snapshot);
    snapshot.state.grains.add_sphere(DVec3::ZERO, 1.0, 1.0);
    writer.send(crowded).unwrap();
    let error = format!("{:#}", writer.finish().unwrap_err());
    for part in [
        "grains.nc",
        "t = 0.3 s",
        "3 entries along grain, which holds 2",
    ] {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn sending_after_an_error_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let writer = start(dir.path(), &all()).unwrap();
    let mut crowded = frame(0.3, 3);
    let snapshot = Arc::make_mut(&mut crowded.snapshot);
    snapshot.state.grains.add_sphere(DVec3::ZERO, 1.0, 1.0);
    // The channel takes some frames before the thread has failed.
    let errors = (0..99).filter_map(|_| writer.send(crowded.clone()).err());
    let mut errors = errors.map(|e| format!("{e:#}"));
    assert!(errors.next().unwrap().contains("grains.nc"));
    assert!(errors.next().unwrap().contains("earlier error"));
}

#[test]
fn what_does_not_exist_cannot_be_written() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |plan| start(dir.path(), &plan).unwrap_err();
    let mut plan = all();
    plan.variables[FileKind::Profiles] = Some(vec!["vorticity".into()]);
    let unknown = refused(plan);
    for part in [
        "profiles.nc",
        "no variable \"vorticity\"; it knows velocity",
    ] {
        assert!(unknown.contains(part), "{unknown}");
    }
    let disordered = refused(Plan {
        profile_edges: vec![1.0, 0.0],
        ..all()
    });
    assert!(disordered.contains("ascending"), "{disordered}");
}

#[test]
fn only_what_is_planned_is_made() {
    let dir = tempfile::tempdir().unwrap();
    let mut plan = Plan::default();
    plan.variables[FileKind::Series] = Some(vec!["strain".into(), "wall_height".into()]);
    let writer = start(dir.path(), &plan).unwrap();
    writer.send(frame(0.1, 3)).unwrap();
    writer.finish().unwrap();
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 1);
    let series = open(dir.path(), "series.nc");
    let names: Vec<_> = series.variables().map(|v| v.name()).collect();
    assert_eq!(names, ["time", "phase", "strain", "wall_height"]);
}
