//! Runs a scene of water alone: advance and look, until its end.

use super::Engine;
use super::steady::SteadyWatch;
use super::summary::{Outcome, WaterSummary, doubts, mean_flux};
use crate::output::Header;
use crate::output::fluid::{self, WaterFrame};
use crate::output::water_state::{self, SavedWater};
use crate::run::{Options, STATE, check_room, remove_others};
use crate::run::{intervals, pace::Pace, progress::Progress};
use crate::scene::WaterScene;
use anyhow::{Context, Result};
use intervals::Intervals;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Run `scene` until its end, or until `stop` becomes true; then all that was computed is on
/// disk, the state too.
///
/// # Errors
/// Results that are there already, files that cannot be written, a machine that is not there or
/// cannot hold the water, numbers that run away.
pub fn run(scene: &WaterScene, options: &Options, stop: &AtomicBool) -> Result<WaterSummary> {
    check_room(&options.out, options.force)?;
    let water = &scene.water;
    let cells = water.lattice().count();
    let chosen = options
        .backend
        .choose_for_water(cells, water.precision, options.threads)?;
    let machine = chosen.machine;
    // What is refused here costs no old results.
    let mut engine = Engine::new(&machine, water)?;
    let out = &options.out;
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let header = Header {
        title: scene.title.clone(),
        scene: scene.text.clone(),
        seed: None,
        backend: machine.backend(),
        device: machine.describe(),
    };
    let writer = fluid::create(out, &header, scene)?;
    remove_others(out, &scene.output)?;

    let total = scene.steps();
    let mut progress = Progress::new(options.quiet, vec![total]);
    progress.begin(0, "water", total);
    progress.say(&format!("on {} ({})", machine.describe(), chosen.why));
    for line in water.describe(total) {
        progress.say(&line);
    }
    let (memory, each) = (
        engine.memory() as f64 / MIB,
        engine.memory() as f64 / cells as f64,
    );
    let memory = format!("{memory:.1} MiB for the lattice, {each:.0} bytes a cell");
    progress.say(&format!("{:<22}{memory}", "memory"));
    let begun = Instant::now();
    let mut pace = Pace::default();
    let intervals = Intervals::new(&scene.output, water.scaling.step);
    let mut watch = SteadyWatch::new(scene);
    let shared = Arc::new(water.clone());
    let frame = |now: &Arc<lbm::Snapshot>, due| WaterFrame {
        water: shared.clone(),
        now: now.clone(),
        due,
    };
    let first = Arc::new(engine.snapshot()?);
    let mut fastest = fastest_of(&first);
    writer.send(frame(&first, intervals.last()))?;
    drop(first);
    let mut done = 0;
    let reached = loop {
        let next = intervals.next(done).min(watch.next(done)).min(total);
        let goal = next.min(done + pace.steps());
        if let Err(error) = pace.time(goal - done, || engine.advance(goal - done)) {
            break Err(error.into());
        }
        done = goal;
        progress.at(done, water.scaling.step, pace.steps_per_second());
        let mut due = intervals.due(done);
        let look = done == watch.next(done - 1);
        let stopped = stop.load(Ordering::Relaxed);
        if !(intervals::any(due) || look || stopped || done == total) {
            continue;
        }
        let now = Arc::new(engine.snapshot()?);
        fastest = fastest.max(fastest_of(&now));
        let outcome = if look && watch.is_steady(&now) {
            Some(Outcome::Steady)
        } else if done == total {
            Some(match scene.end.steady {
                Some(_) => Outcome::MaxDuration,
                None => Outcome::Duration,
            })
        } else {
            stopped.then_some(Outcome::Stopped)
        };
        if outcome.is_some() {
            due = intervals.last();
        }
        if intervals::any(due) {
            writer.send(frame(&now, due))?;
        }
        if let Some(outcome) = outcome {
            break Ok((outcome, mean_flux(&now)));
        }
    };
    // What was computed before an error is on disk too.
    progress.finish();
    writer.finish()?;
    let (outcome, flux) = reached.map_err(|error: anyhow::Error| {
        let results = format!("its results until then are in {}", out.display());
        error.context(format!("the run stopped; {results}"))
    })?;
    let saved = SavedWater {
        cells: water.model.cells,
        step: water.scaling.step,
        density: water.scaling.density,
        state: engine.state()?,
    };
    water_state::save(&out.join(STATE), &saved, &header)?;
    let filled = water.model.solid.iter().filter(|&&solid| solid).count();
    Ok(WaterSummary {
        device: machine.describe(),
        outcome,
        cells: cells - filled,
        steps: done,
        duration: done as f64 * water.scaling.step,
        left: (total - done) as f64 * water.scaling.step,
        flux,
        fastest,
        warnings: doubts(water, fastest),
        seconds: begun.elapsed().as_secs_f64(),
        out: out.clone(),
    })
}

const MIB: f64 = 1_048_576.0;

/// The greatest speed, or flux in a bed [m/s].
fn fastest_of(now: &lbm::Snapshot) -> f64 {
    let squares = now
        .flux
        .iter()
        .map(|u| u.iter().map(|u| u * u).sum::<f64>());
    squares.fold(0.0, f64::max).sqrt()
}
