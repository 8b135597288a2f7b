//! One run of a sweep: from the state of the run before it, or on from where it was stopped.
//!
//! Its folder holds `scene.toml`, then the files of `esker run`, and `outcome.json` at last. Where a
//! run was stopped in its middle, the files until then stand in `before-1`, `before-2`, ...

use super::outcome::Outcome;
use super::plan::Plan;
use super::stage::stages;
use super::text;
use crate::backend::{Backend, Machine};
use crate::output::{state, water_state};
use crate::run::{self, Options, STATE};
use crate::scene::{AnyScene, Document, Scene, WaterScene};
use crate::water;
use anyhow::{Context, Result, anyhow, bail, ensure};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// How a run ended that did not fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ended {
    /// It came to its end, after so long [s].
    Done(f64),
    /// It was stopped, and can go on.
    Stopped,
}

/// The folder of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Folder<'a> {
    /// Where it is.
    pub path: &'a Path,
    /// What is run in it.
    pub plan: &'a Plan,
}

impl Folder<'_> {
    /// The folder of a run.
    pub fn of(&self, run: usize) -> PathBuf {
        self.path.join(&self.plan.runs[run].name)
    }

    /// What became of a run; none: it was not finished.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn outcome(&self, run: usize) -> Result<Option<Outcome>> {
        Outcome::load(&self.of(run))
    }

    /// Hold the sweep, alone or beside others that do, until the file is dropped.
    ///
    /// # Errors
    /// Another program that holds it.
    pub fn hold(&self, alone: bool) -> Result<File> {
        let file = lock_file(self.path)?;
        let held = if alone {
            file.try_lock()
        } else {
            file.try_lock_shared()
        };
        held_or(file, held, || {
            let folder = self.path.display();
            anyhow!("another esker works on {folder}; wait for it, or stop it")
        })
    }
}

fn lock_file(folder: &Path) -> Result<File> {
    let path = folder.join("lock");
    File::create(&path).with_context(|| format!("cannot make {}", path.display()))
}

/// A lock that the file system does not know is none: it only saves users from themselves.
fn held_or(
    file: File,
    held: Result<(), TryLockError>,
    taken: impl Fn() -> anyhow::Error,
) -> Result<File> {
    match held {
        Err(TryLockError::WouldBlock) => Err(taken()),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

/// Does a GPU compute the first run, and so most likely all?
///
/// # Errors
/// A machine that is not there, or a scene that cannot be read.
pub fn on_gpu(folder: Folder, backend: Backend) -> Result<bool> {
    let own = folder.of(0);
    let text = fs::read_to_string(own.join("scene.toml"))
        .with_context(|| format!("cannot read the scene in {}", own.display()))?;
    let chosen = match read(&own, &text)? {
        AnyScene::Grains(scene) => backend.choose_for(&scene, 1)?,
        AnyScene::Water(scene) => {
            let (cells, precision) = (scene.water.lattice().count(), scene.water.precision);
            backend.choose_for_water(cells, precision, 1)?
        }
    };
    Ok(matches!(chosen.machine, Machine::Gpu(_)))
}

/// Make run number `number`, and note what became of it.
///
/// # Errors
/// What made it fail; it is noted too.
pub fn run(
    folder: Folder,
    number: usize,
    backend: Backend,
    threads: usize,
    stop: &AtomicBool,
) -> Result<Ended> {
    let own = folder.of(number);
    let name = &folder.plan.runs[number].name;
    if let Some(Outcome::Done { seconds, .. }) = Outcome::load(&own)? {
        return Ok(Ended::Done(seconds));
    }
    let lock = lock_file(&own)?;
    let held = lock.try_lock();
    let _lock = held_or(lock, held, || anyhow!("another esker computes {name}"))?;
    if let Some(from) = folder.plan.runs[number].from {
        let before = &folder.plan.runs[from].name;
        let done = matches!(folder.outcome(from)?, Some(Outcome::Done { .. }));
        ensure!(
            done,
            "{name} starts from {before}, which is not done; run that first"
        );
    }
    Outcome::clear(&own)?;
    let begun = Instant::now();
    let made = make(folder, number, backend, threads, stop);
    let seconds = begun.elapsed().as_secs_f64();
    let outcome = match &made {
        Ok(None) => return Ok(Ended::Stopped),
        Ok(Some(warnings)) => Outcome::Done {
            seconds,
            warnings: warnings.clone(),
        },
        Err(error) => Outcome::Failed {
            reason: format!("{error:#}"),
        },
    };
    outcome.store(&own)?;
    made.map(|_| Ended::Done(seconds))
}

/// The warnings of a run; none: it was stopped.
fn make(
    folder: Folder,
    number: usize,
    backend: Backend,
    threads: usize,
    stop: &AtomicBool,
) -> Result<Option<Vec<String>>> {
    let own = folder.of(number);
    let path = own.join("scene.toml");
    let text =
        fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let scene = read(&own, &text)?;
    if let AnyScene::Grains(scene) = &scene {
        ensure!(
            stages(scene) == [folder.plan.runs[number].stage],
            "its scene is not what it was when the sweep was planned, by another version of esker \
             perhaps; begin a new sweep"
        );
    }
    let options = Options {
        out: own.clone(),
        backend,
        threads,
        force: true,
        quiet: true,
    };
    let scene = match going_on(&own, &text, &scene)? {
        Some(text) => read(&own, &text)?,
        None => scene,
    };
    match scene {
        AnyScene::Grains(scene) => grains(&scene, &options, stop),
        AnyScene::Water(scene) => of_water(&scene, &options, stop),
    }
}

fn read(own: &Path, text: &str) -> Result<AnyScene> {
    let name = own.join("scene.toml").display().to_string();
    let document = Document::new(&name, own, text, &[])?;
    Ok(AnyScene::read(&document)?)
}

fn grains(scene: &Scene, options: &Options, stop: &AtomicBool) -> Result<Option<Vec<String>>> {
    let summary = run::run(scene, options, stop)?;
    let mut warnings: Vec<String> = scene.warnings();
    for phase in &summary.phases {
        match phase.outcome {
            run::Outcome::Stopped => return Ok(None),
            run::Outcome::MaxDuration => {
                let name = &phase.name;
                warnings.push(format!(
                    "phase {name}: max_duration was over before its criterion was met"
                ));
            }
            _ => {}
        }
        let water = phase.water.iter().flat_map(|water| &water.warnings);
        warnings.extend(water.cloned());
    }
    Ok(Some(warnings))
}

fn of_water(
    scene: &WaterScene,
    options: &Options,
    stop: &AtomicBool,
) -> Result<Option<Vec<String>>> {
    let summary = water::run(scene, options, stop)?;
    let mut warnings = summary.warnings;
    match summary.outcome {
        water::Outcome::Stopped => return Ok(None),
        water::Outcome::MaxDuration => {
            warnings.push("max_duration was over before the flow was steady".into());
        }
        _ => {}
    }
    Ok(Some(warnings))
}

/// The scene that goes on from where the run was stopped; none: it begins.
fn going_on(own: &Path, text: &str, scene: &AnyScene) -> Result<Option<String>> {
    if unfinished(own, scene)? || partial(own, count_before(own) + 1).exists() {
        set_aside(own)?;
    }
    let n = count_before(own);
    if n == 0 {
        return Ok(None);
    }
    let state = format!("before-{n}/{STATE}");
    Ok(Some(match scene {
        AnyScene::Grains(_) => text::going_on(text, &state),
        AnyScene::Water(scene) => {
            let left = left(scene, &own.join(&state))?;
            text::water_going_on(text, &state, left)
        }
    }))
}

/// Does `own` hold a state from the middle of the run?
fn unfinished(own: &Path, scene: &AnyScene) -> Result<bool> {
    let path = own.join(STATE);
    if !path.exists() {
        return Ok(false);
    }
    Ok(match scene {
        AnyScene::Grains(_) => state::load(&path)?.past.unfinished.is_some(),
        AnyScene::Water(scene) => left(scene, &path)? > 0.0,
    })
}

/// How long water has still to flow from a state [s]; 0 at its end, and where the flow may have
/// become steady.
fn left(scene: &WaterScene, state: &Path) -> Result<f64> {
    let step = scene.water.scaling.step;
    let flowed = water_state::load(state)?.state.time - scene.water.start.time;
    let left = scene.steps().saturating_sub((flowed / step).round() as u64);
    Ok(left as f64 * step)
}

fn count_before(own: &Path) -> usize {
    (1..)
        .take_while(|n| own.join(format!("before-{n}")).exists())
        .count()
}

fn partial(own: &Path, n: usize) -> PathBuf {
    own.join(format!("before-{n}.partial"))
}

/// Move the files of the run until now into the next `before`; a move that was broken off goes on.
fn set_aside(own: &Path) -> Result<()> {
    let n = count_before(own) + 1;
    let (partial, whole) = (partial(own, n), own.join(format!("before-{n}")));
    let moved = || -> std::io::Result<()> {
        fs::create_dir_all(&partial)?;
        for entry in fs::read_dir(own)? {
            let path = entry?.path();
            let ours = path.extension().is_some_and(|e| e == "nc" || e == "h5");
            if let (true, Some(name)) = (ours, path.file_name()) {
                fs::rename(&path, partial.join(name))?;
            }
        }
        fs::rename(&partial, &whole)
    };
    moved().with_context(|| format!("cannot write to {}", own.display()))?;
    if !whole.join(STATE).exists() {
        bail!("{} holds no state to go on from", whole.display());
    }
    Ok(())
}
