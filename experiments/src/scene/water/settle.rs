//! Step and regime: what the scene says, or what the lattice chooses.

use super::start::Start;
use super::{Precision, Water, word};
use crate::scene::reader::{Reader, Table};
use crate::scene::tree::Step;
use crate::scene::units::TIME;
use lbm::{Model, Regime, Scaling};

/// Let the lattice choose what is left open, and say so.
pub fn settle(
    table: &Table,
    reader: &Reader,
    mut model: Model,
    precision: Precision,
    start: Start,
) -> Option<Water> {
    let Start {
        mut state, lattice, ..
    } = start;
    let choose = |model: &Model| match precision {
        Precision::F32 => Scaling::choose::<f32>(model, state.thickness),
        Precision::F64 => Scaling::choose::<f64>(model, state.thickness),
    };
    let mut scaling = choose(&model);
    // Tight beds could do with steps that are longer than the run, and are as right in shorter ones.
    if let Ok(chosen) = &scaling
        && model.step.is_none()
        && chosen.regime == Regime::Diffusive
        && let Some(soonest) = soonest(reader, chosen.step)
    {
        table.choose("step", TIME.write(soonest));
        model.step = Some(soonest);
        scaling = choose(&model);
    }
    let scaling = match scaling {
        Ok(scaling) => scaling,
        // Where something else is wrong, this may only follow from it.
        Err(_) if reader.has_problems() => return None,
        Err(error) => {
            refused(table, &error.to_string());
            return None;
        }
    };
    if model.regime.is_none() {
        table.choose("regime", word(scaling.regime));
    }
    if model.step.is_none() {
        table.choose("step", TIME.write(scaling.step));
    }
    model.regime = Some(scaling.regime);
    model.step = Some(scaling.step);
    // What populations mean is said by the lattice; without them pressure and flow remain.
    let other_lattice = lattice.is_some_and(|lattice| lattice != [scaling.step, scaling.density]);
    if other_lattice {
        state.populations.clear();
    }
    Some(Water {
        model,
        precision,
        start: state,
        other_lattice,
        scaling,
    })
}

/// Rows that come so much more often than a step could be long are a mistake.
const OFTEN: f64 = 1e-3;

/// The shortest time that the scene asks for, all of the run or between two rows [s], where it is
/// shorter than `step` [s]. What cannot be read is told where it is read.
fn soonest(reader: &Reader, step: f64) -> Option<f64> {
    let time = |path: &[&str]| {
        let (key, tables) = path.split_last()?;
        let root = Some(&reader.document().root);
        let table = tables.iter().fold(root, |node, key| {
            node.and_then(|node| node.down(&Step::Key((*key).into())))
        });
        let time = TIME.read(table?.text_of(key)?).ok()?;
        (time > 0.0).then_some(time)
    };
    let durations = [["end", "duration"], ["end", "max_duration"]];
    let rows = [["output", "series", "every"], ["output", "fluid", "every"]];
    let durations = durations.iter().filter_map(|path| time(path));
    let rows = rows.iter().filter_map(|path| time(path));
    let times = durations.chain(rows.filter(|every| *every > OFTEN * step));
    let soonest = times.fold(f64::INFINITY, f64::min);
    (soonest < step).then_some(soonest)
}

/// What a lattice refuses, at the key that mends it.
fn refused(table: &Table, message: &str) {
    let says = |words: &str| message.contains(words);
    let key = if says("lattice of f64") {
        "precision"
    } else if table.has("step") && says("step") {
        "step"
    } else if says("spacing") {
        "spacing"
    } else if says("regime") {
        "regime"
    } else {
        "step"
    };
    let remedy = match key {
        "precision" => "; here: precision = \"f64\"",
        _ => "",
    };
    table.wrong(key, format!("cannot be right: {message}{remedy}"));
}
