//! Runs a scene: phase by phase, advance and look, until the protocol is done.

mod bed;
pub(crate) mod intervals;
pub(crate) mod pace;
pub(crate) mod progress;
mod rest;
mod summary;
pub(crate) mod water;

pub use summary::{Outcome, PhaseSummary, Summary};

use crate::backend::{Backend, Chosen, Machine};
use crate::engine::{Engine, see_water};
use crate::output::pores::Cells;
use crate::output::state::Saved;
use crate::output::{self, FileKind, Header, Plan, Writer};
use crate::protocol::{self, Past, Prepared, Reference, Unfinished};
use crate::scene::output::File;
use crate::scene::{Phase, Scene};
use anyhow::{Context, Error, Result, bail, ensure};
use bed::Bed;
use dem::{Drive, Model, State, Sums, measure};
use enum_map::EnumMap;
use intervals::Intervals;
use pace::Pace;
use progress::Progress;
use rest::RestWatch;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// How to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of the results.
    pub out: PathBuf,
    /// Who computes.
    pub backend: Backend,
    /// Number of threads of the CPU; 0: one for each core.
    pub threads: usize,
    /// Replace results that are there?
    pub force: bool,
    /// Say nothing?
    pub quiet: bool,
}

/// The file to go on from.
pub const STATE: &str = "state.h5";

/// Run `scene` until its protocol is done, or until `stop` becomes true; then all that was
/// computed is on disk, the state too.
///
/// # Errors
/// Results that are there already, files that cannot be written, a bed that does not fit
/// its layers, a machine that is not there or cannot hold the bed, numbers that run away.
pub fn run(scene: &Scene, options: &Options, stop: &AtomicBool) -> Result<Summary> {
    check_room(&options.out, options.force)?;
    let chosen = options.backend.choose_for(scene, options.threads)?;
    run_on(&chosen, scene, options, stop)
}

/// The same on a machine that was chosen before.
///
/// # Errors
/// Those of [`run`], but for that of the choice.
pub fn run_on(
    chosen: &Chosen,
    scene: &Scene,
    options: &Options,
    stop: &AtomicBool,
) -> Result<Summary> {
    check_room(&options.out, options.force)?;
    let machine = &chosen.machine;
    check_start(scene, machine)?;
    let plan = plan(scene)?;
    let out = &options.out;
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let header = Header {
        title: scene.title.clone(),
        scene: scene.text.clone(),
        seed: Some(scene.seed),
        backend: machine.backend(),
        device: machine.describe(),
    };
    let names: Vec<String> = scene
        .phases
        .iter()
        .map(|phase| phase.name.clone())
        .collect();
    let writer = Writer::create(out, &header, &plan, &names, &scene.start.grains)?;
    remove_others(out, &scene.output.files)?;
    let steps = scene
        .phases
        .iter()
        .map(|phase| expected_steps(scene, phase));
    let mut run = Run {
        scene,
        options,
        machine,
        stop,
        writer,
        progress: Progress::new(options.quiet, steps.collect()),
        intervals: Intervals::new(&scene.output.files, scene.step),
        header,
        past: scene.past.clone(),
        pace: Pace::default(),
    };
    run.progress
        .say(&format!("on {} ({})", machine.describe(), chosen.why));
    let begun = Instant::now();
    let mut state = scene.start.clone();
    let mut phases: Vec<PhaseSummary> = Vec::new();
    let mut failed = None;
    for number in 0..scene.phases.len() {
        match run.phase(number, state) {
            Ok((reached, summary)) => {
                state = reached;
                run.progress.say(&summary.to_string());
                let stopped = summary.outcome == Outcome::Stopped;
                phases.push(summary);
                if stopped {
                    break;
                }
            }
            Err(error) => {
                failed = Some(error);
                break;
            }
        }
    }
    // What was computed before an error is on disk too.
    run.progress.finish();
    run.writer.finish()?;
    match failed {
        Some(error) => Err(error.context(format!(
            "the run stopped; its results until then are in {}",
            options.out.display()
        ))),
        None => Ok(Summary {
            device: machine.describe(),
            grains: scene.start.grains.len(),
            phases,
            seconds: begun.elapsed().as_secs_f64(),
            out: options.out.clone(),
        }),
    }
}

/// See that the folder holds no result.
pub(crate) fn check_room(out: &Path, force: bool) -> Result<()> {
    let names = FileKind::all().map(FileKind::file_name);
    let mut paths = names.chain([STATE.into()]).map(|name| out.join(name));
    if let (Some(first), false) = (paths.find(|path| path.exists()), force) {
        bail!(
            "{} exists; choose another folder with --out, or replace it with --force",
            first.display()
        );
    }
    Ok(())
}

/// See that the first phase can begin: what is refused here costs no old results.
fn check_start(scene: &Scene, machine: &Machine) -> Result<()> {
    if let Machine::Gpu(device) = machine {
        see_water(scene, &device.adapter)?;
    }
    let phase = &scene.phases[0];
    let reference = scene.past.reference_of(phase);
    let Prepared { model, state, .. } =
        protocol::prepare(scene, phase, scene.start.clone(), reference)
            .with_context(|| format!("phase {}", phase.name))?;
    // Measuring takes long, and is refused nothing.
    let stiffness = scene.past.water.as_ref().and_then(|past| past.stiffness);
    let engine = Engine::of_phase(scene, phase, machine, model, state, &scene.past, stiffness);
    engine.with_context(|| format!("phase {}", phase.name))?;
    Ok(())
}

/// Remove old results that this run does not replace, so that no folder holds two runs. An old
/// state stays until the new one replaces it: this run may have started from it.
pub(crate) fn remove_others(out: &Path, files: &EnumMap<FileKind, Option<File>>) -> Result<()> {
    let others = files.iter().filter(|(_, file)| file.is_none());
    for path in others
        .map(|(kind, _)| out.join(kind.file_name()))
        .filter(|p| p.exists())
    {
        let removed = std::fs::remove_file(&path);
        removed.with_context(|| format!("cannot remove {}", path.display()))?;
    }
    Ok(())
}

/// Which variables, and the layers of the profiles.
fn plan(scene: &Scene) -> Result<Plan> {
    let files = scene.output.files.clone();
    Ok(Plan {
        variables: files.map(|_, file| file.map(|file| file.variables)),
        profile_edges: scene.profile_edges().map_err(Error::msg)?,
        cells: scene.water.as_ref().map(|water| Cells {
            count: water.cells,
            spacing: water.spacing,
        }),
    })
}

/// Number of steps of `phase` at most, where the height of its bed can only be guessed.
pub fn expected_steps(scene: &Scene, phase: &Phase) -> u64 {
    let guess = protocol::expected_height(scene);
    let model = protocol::model(scene, phase, guess);
    longest(phase, &model, guess)
}

/// Number of steps after which `phase` ends for certain.
fn longest(phase: &Phase, model: &Model, height: f64) -> u64 {
    let of_strain = match (model.drive, phase.end.strain) {
        (Some(Drive::Velocity(v)), Some(strain)) => strain * height / v.abs(),
        _ => f64::INFINITY,
    };
    (phase.end.duration.min(of_strain) / model.step).ceil() as u64
}

struct Run<'a> {
    scene: &'a Scene,
    options: &'a Options,
    machine: &'a Machine,
    stop: &'a AtomicBool,
    writer: Writer,
    progress: Progress,
    intervals: Intervals,
    header: Header,
    /// What came before the state that the next phase is handed.
    past: Past,
    pace: Pace,
}

impl Run<'_> {
    /// Run one phase from `state`; returns the state at its end, which is on disk then.
    fn phase(&mut self, number: usize, state: State) -> Result<(State, PhaseSummary)> {
        let phase = &self.scene.phases[number];
        let in_phase = || format!("phase {}", phase.name);
        let goes_on = self.past.reference_of(phase);
        let Prepared {
            model,
            state,
            height,
        } = protocol::prepare(self.scene, phase, state, goes_on).with_context(in_phase)?;
        let reference = goes_on.unwrap_or_else(|| Reference {
            time: state.time,
            height,
            way: protocol::driven_way(&state),
            strain: self.past.strain,
        });
        // Steps of this phase that were made before it was stopped.
        let mut done = ((state.time - reference.time) / model.step).round() as u64;
        let total = longest(phase, &model, height).max(done.saturating_add(1));
        self.progress.begin(number, &phase.name, total);
        let mut watch = RestWatch::new(phase, &model, &state);
        let mut bed = Bed {
            number,
            reference,
            before: Sums::default(),
            readings: Vec::new(),
        };
        let stiffness = water::stiffness(self.scene, phase, &model, &state, &self.past)
            .with_context(in_phase)?;
        let (scene, machine) = (self.scene, self.machine);
        let mut engine =
            Engine::of_phase(scene, phase, machine, model, state, &self.past, stiffness)
                .with_context(in_phase)?;
        if let Engine::Wet(wet) = &engine {
            let report = water::describe(engine.model(), &wet.report()?);
            self.progress.say(&format!("{:>12}: {report}", phase.name));
        }
        let model = Arc::new(engine.model().clone());
        if number == 0 {
            let now = Arc::new(engine.snapshot().with_context(in_phase)?);
            self.writer
                .send(bed.frame(&model, &now, engine.water()?, intervals::START))?;
        }
        loop {
            let next = self.intervals.next(done).min(watch.next(done)).min(total);
            let goal = next.min(done + self.pace.steps());
            self.pace
                .time(goal - done, || engine.advance(goal - done))
                .with_context(in_phase)?;
            done = goal;
            self.progress
                .at(done, engine.model().step, self.pace.steps_per_second());

            let mut due = self.intervals.due(done);
            let look = done == watch.next(done - 1);
            let stopped = self.stop.load(Ordering::Relaxed);
            if !(intervals::any(due) || look || stopped || done == total) {
                continue;
            }
            let now = Arc::new(engine.snapshot().with_context(in_phase)?);
            let room = measure::wall_height(&model, &now.state, protocol::TOP);
            ensure!(
                room > now.state.grains.mean_radius(),
                "phase {}: the top wall stands at {room:.4e} m, less than a grain above the \
                 bottom; it went through the bed. Move it more slowly or for a shorter time",
                phase.name
            );
            let outcome = if done == total {
                Some(bed.end_of_time(phase, &now))
            } else if look && watch.at_rest(&now) {
                Some(Outcome::AtRest)
            } else if look
                && phase
                    .end
                    .strain
                    .is_some_and(|s| bed.own_strain(&now).abs() >= s)
            {
                Some(Outcome::Strain)
            } else if stopped {
                Some(Outcome::Stopped)
            } else {
                None
            };
            if outcome.is_some() {
                due = self.intervals.last();
            }
            if intervals::any(due) {
                self.writer
                    .send(bed.frame(&model, &now, engine.water()?, due))?;
                bed.read(due, &now);
            }
            if let Some(outcome) = outcome {
                self.past = Past {
                    strain: bed.strain(&now),
                    unfinished: (outcome == Outcome::Stopped).then(|| Unfinished {
                        phase: phase.name.clone(),
                        reference,
                    }),
                    water: water::past(&engine, stiffness)?,
                };
                let saved = Saved {
                    state: now.state.clone(),
                    domain: self.scene.domain,
                    past: self.past.clone(),
                };
                output::state::save(&self.options.out.join(STATE), &saved, &self.header)?;
                let summary = bed.summary(&model, phase, outcome, done, &now, engine.water()?);
                return Ok((saved.state, summary));
            }
        }
    }
}
