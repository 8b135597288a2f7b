//! A thread that writes, so that stepping does not wait for the disk.

use super::netcdf::keep_quiet;
use super::{FileKind, Files, Frame, Header, Plan, create_files, partial};
use anyhow::{Context, Result, anyhow, ensure};
use std::path::Path;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Frames that may wait; a frame of a million grains takes half a gigabyte.
const WAITING: usize = 2;

/// How often what was written goes to the disk. A run that is killed loses what came later; one
/// that is killed at that very moment may leave a file that cannot be read. Rows that follow each
/// other fast would be such moments all the time, and a sync costs several times what the row does.
const SYNC_EVERY: Duration = Duration::from_secs(1);

/// Writes frames on a thread of its own.
#[derive(Debug)]
pub struct Writer {
    frames: Option<SyncSender<Frame>>,
    thread: Mutex<Option<JoinHandle<Result<()>>>>,
}

impl Writer {
    /// Make the files of `plan` in the folder `dir`; files of these names are replaced, but only
    /// once all new ones are there.
    ///
    /// `phases`: names of the protocol's phases. `grains`: the bed; what never changes
    /// (radius, identity) is taken from it. Unknown names in the plan are refused.
    pub fn create(
        dir: &Path,
        header: &Header,
        plan: &Plan,
        phases: &[String],
        grains: &dem::Grains,
    ) -> Result<Self> {
        let files = create_files(dir, header, plan, phases, grains)
            .and_then(|files| take_places(dir, &files).map(|()| files))
            .inspect_err(|_| remove_partial(dir))?;
        let (frames, waiting) = sync_channel(WAITING);
        let dir = dir.to_path_buf();
        let thread = thread::Builder::new()
            .name("writer".into())
            .spawn(move || write_all(&dir, files, &waiting))?;
        Ok(Self {
            frames: Some(frames),
            thread: Mutex::new(Some(thread)),
        })
    }

    /// Hand over one frame. Waits only if the writer is some frames behind; an error of
    /// the writing thread comes back from a later call, or from [`finish`](Self::finish).
    pub fn send(&self, frame: Frame) -> Result<()> {
        let frames = self.frames.as_ref().expect("taken only at the end");
        if frames.send(frame).is_ok() {
            return Ok(());
        }
        // The thread ends before its time only because of an error.
        self.join()?;
        Err(anyhow!("output ended after an earlier error"))
    }

    /// Write what is left and close the files.
    pub fn finish(mut self) -> Result<()> {
        self.frames = None;
        self.join()
    }

    /// Wait for the thread and take its error, once.
    fn join(&self) -> Result<()> {
        let mut thread = self.thread.lock().expect("no panic while it is held");
        match thread.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(result)) => result,
            Some(Err(_)) => Err(anyhow!("the writing thread panicked; files may lack rows")),
        }
    }
}

/// A writer that goes away without being finished still writes what it was given; only
/// its errors are lost.
impl Drop for Writer {
    fn drop(&mut self) {
        self.frames = None;
        let _ = self.join();
    }
}

/// Let the new files take the places of old ones.
fn take_places(dir: &Path, files: &Files) -> Result<()> {
    let paths = || files.iter().map(|(kind, _)| dir.join(kind.file_name()));
    for path in paths() {
        ensure!(!path.is_dir(), "{} is a folder; move it", path.display());
    }
    for path in paths() {
        std::fs::rename(partial(&path), &path)
            .with_context(|| format!("cannot replace {}", path.display()))?;
    }
    Ok(())
}

/// Take away what was made of files that could not all be made.
fn remove_partial(dir: &Path) {
    for kind in FileKind::all() {
        // It may not have come to this one.
        let _ = std::fs::remove_file(partial(&dir.join(kind.file_name())));
    }
}

/// Write frames until the last sender is gone.
fn write_all(dir: &Path, mut files: Files, frames: &Receiver<Frame>) -> Result<()> {
    keep_quiet();
    sync(dir, &mut files)?;
    let mut synchronised = Instant::now();
    loop {
        let frame = match frames.recv_timeout(SYNC_EVERY) {
            Ok(frame) => Some(frame),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return sync(dir, &mut files),
        };
        for (kind, file) in &mut files {
            let Some(frame) = frame.as_ref().filter(|frame| frame.due[*kind]) else {
                continue;
            };
            file.write(frame).with_context(|| {
                let (path, time) = (dir.join(kind.file_name()), frame.snapshot.state.time);
                format!("cannot write {} at t = {time} s", path.display())
            })?;
        }
        if synchronised.elapsed() >= SYNC_EVERY {
            sync(dir, &mut files)?;
            synchronised = Instant::now();
        }
    }
}

fn sync(dir: &Path, files: &mut Files) -> Result<()> {
    for (kind, file) in files {
        file.sync()
            .with_context(|| format!("cannot write {}", dir.join(kind.file_name()).display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::catalogue;
    use dem::contact::{Linear, Tension};
    use dem::{
        Body, Contact, ContactLaw, Domain, History, Ledger, Model, Snapshot, State, Sums, Surface,
        Wall, WallMotion, WallState,
    };
    use enum_map::EnumMap;
    use glam::DVec3;
    use std::sync::Arc;

    /// Two grains on each other between walls 4 m apart, over 12 m²; `contacts` of the
    /// three are there.
    fn frame(time: f64, contacts: usize) -> Frame {
        let wall = |normal| Wall {
            name: "wall".into(),
            normal,
            surface: Surface::Frictionless,
            motion: WallMotion::Held,
        };
        let model = Model {
            domain: Domain {
                size: [3.0, 4.0],
                periodic: [true, true],
            },
            gravity: DVec3::ZERO,
            law: ContactLaw::Linear(Linear {
                normal_stiffness: 1e6,
                normal_damping: 0.0,
                tension: Tension::Clip,
                sliding: None,
                rolling: None,
                twisting: None,
            }),
            walls: vec![wall(DVec3::Z), wall(DVec3::NEG_Z)],
            drive: None,
            step: 1e-5,
            skin: None,
            ledger: true,
        };
        let at = |offset| WallState {
            offset,
            velocity: 0.0,
        };
        let mut state = State {
            time,
            walls: vec![at(0.0), at(-4.0)],
            ..State::default()
        };
        state.grains.add_sphere(DVec3::new(1.5, 1.5, 1.0), 1.0, 1.0);
        state.grains.add_sphere(DVec3::new(1.5, 1.5, 3.0), 1.0, 1.0);
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
            phase: 1,
            strain: 10.0 * time,
            dilation: 0.02,
            due: EnumMap::from_fn(|_| true),
        }
    }

    fn everything() -> Plan {
        let names = |kind| catalogue::names(kind).into_iter().map(Into::into).collect();
        Plan {
            variables: EnumMap::from_fn(|kind| Some(names(kind))),
            profile_edges: vec![0.0, 2.0, 4.0],
        }
    }

    fn start(dir: &Path, plan: &Plan) -> Result<Writer> {
        let header = Header {
            title: "a column".into(),
            scene: "seed = 7\n".into(),
            seed: 7,
        };
        let phases = ["settle", "first shear"].map(String::from);
        Writer::create(
            dir,
            &header,
            plan,
            &phases,
            &frame(0.0, 0).snapshot.state.grains,
        )
    }

    fn open(dir: &Path, name: &str) -> netcdf::File {
        crate::output::netcdf::open(&dir.join(name)).unwrap()
    }

    fn values(file: &netcdf::File, name: &str) -> Vec<f64> {
        file.variable(name).unwrap().get_values(..).unwrap()
    }

    fn text(attribute: Option<netcdf::AttributeValue>) -> String {
        attribute.unwrap().try_into().unwrap()
    }

    #[test]
    fn what_is_sent_can_be_read() {
        let dir = tempfile::tempdir().unwrap();
        let writer = start(dir.path(), &everything()).unwrap();
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
        start(dir.path(), &everything()).unwrap().finish().unwrap();
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
                if variable.vartype() != netcdf::types::NcVariableType::String {
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
        let writer = start(dir.path(), &everything()).unwrap();
        writer.send(frame(0.1, 3)).unwrap();
        // A copy is what a killed run would leave.
        let copy = dir.path().join("copy.nc");
        let deadline = Instant::now() + Duration::from_secs(20);
        let rows = || {
            std::fs::copy(dir.path().join("contacts.nc"), &copy).unwrap();
            crate::output::netcdf::open(&copy).map_or(vec![], |file| values(&file, "time"))
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
        let writer = start(dir.path(), &everything()).unwrap();
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
        let writer = start(dir.path(), &everything()).unwrap();
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
        let refused = |plan| format!("{:#}", start(dir.path(), &plan).unwrap_err());
        let mut plan = everything();
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
            ..everything()
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
}
