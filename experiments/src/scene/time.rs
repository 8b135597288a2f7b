//! `[time]` and `[search]`: the step and the skin.

use super::Scene;
use super::reader::{Range, Table};
use super::units::{LENGTH, TIME};
use crate::protocol;
use dem::stability::{default_step, stable_step};

/// What a scene says of step and skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// Time step [s]; none: the default.
    pub step: Option<f64>,
    /// Surplus of the neighbour search [m]; none: chosen as it goes.
    pub skin: Option<f64>,
}

/// Read `[time]` and `[search]`.
pub fn read(root: &Table) -> Time {
    let time = root.table("time", "[time] with step = \"1 us\"");
    let search = root.table_or_empty("search", "[search] with skin = \"1 mm\"");
    Time {
        step: time.and_then(|table| table.quantity("step", &TIME, Range::Positive)),
        skin: search.and_then(|table| skin(&table)),
    }
}

fn skin(search: &Table) -> Option<f64> {
    if !search.has("skin") {
        search.choose("skin", "auto");
    }
    if search.is_word("skin", "auto") {
        return None;
    }
    search.quantity("skin", &LENGTH, Range::Positive)
}

/// Shortest step, in stability limits.
const SHORTEST: f64 = 1e-6;

/// Set the step of `scene`: as `stated`, if that is stable in every phase, or the default.
///
/// # Errors
/// Why the stated step cannot be.
pub fn settle(scene: &mut Scene, stated: Option<f64>) -> Result<(), String> {
    let grains = &scene.start.grains;
    let least = |step: fn(&dem::Model, &dem::Grains) -> f64| {
        let each = scene.phases.iter().map(|phase| {
            let model = protocol::model(scene, phase, 1.0);
            (step(&model, grains), phase.name.as_str())
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (limit, phase) = least(stable_step).ok_or("there is no phase")?;
    let (default, _) = least(default_step).ok_or("there is no phase")?;
    match stated {
        Some(step) if step > limit => {
            let lightest = grains.radius.iter().copied().fold(f64::INFINITY, f64::min);
            Err(format!(
                "is {step:e} s, above the stability limit of {limit:.3e} s (lightest grain, \
                 radius {lightest:.3e} m, under all springs and dashpots of phase {phase}, or its \
                 wall); write less, or leave it out for {default:.3e} s"
            ))
        }
        Some(step) if step < SHORTEST * limit => Err(format!(
            "is {step:e} s, less than a millionth of the stability limit of {limit:.3e} s: the run \
             would take years; write more, or leave it out for {default:.3e} s"
        )),
        Some(step) => {
            scene.step = step;
            Ok(())
        }
        None => {
            scene.step = default;
            Ok(())
        }
    }
}

impl Scene {
    /// Largest step [s] that is stable in every phase.
    pub fn stable_step(&self) -> f64 {
        let each = self.phases.iter().map(|phase| {
            let model = protocol::model(self, phase, 1.0);
            stable_step(&model, &self.start.grains)
        });
        each.fold(f64::INFINITY, f64::min)
    }
}
