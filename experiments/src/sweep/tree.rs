//! What is to be run for all points: phases with the same past are one run.

use super::stage::{Start, fingerprint, stages};
use super::text;
use crate::output::FileKind;
use crate::run::{STATE, expected_steps};
use crate::scene::AnyScene;
use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// One phase of one or several points, or the water of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Name of its folder: its phase, and a number among those of the same phase.
    pub name: String,
    /// The run from whose state it starts.
    pub from: Option<usize>,
    /// Number of its phase; 0 for water alone.
    pub phase: usize,
    /// About how much is to be computed, steps of grains or of cells.
    pub work: u64,
    /// What its phase must still be once it is read with that state.
    pub stage: u64,
    /// Of its scene.
    pub text: u64,
}

/// The runs, each after the one that it starts from.
#[derive(Debug, Default)]
pub struct Tree {
    /// All runs.
    pub runs: Vec<Run>,
    /// The scene of each.
    pub texts: Vec<String>,
    /// The last run of each point.
    pub ends: Vec<usize>,
    /// Names of the phases, of the point with the most of them.
    pub phases: Vec<String>,
    /// The run that stands for a start or an earlier run, a phase, and what decides its bits.
    known: HashMap<(u64, Option<usize>, u64), usize>,
    /// The start of the last scene.
    start: Option<Start>,
    /// Number of runs of each phase's name.
    counts: HashMap<String, usize>,
}

impl Tree {
    /// Add the point with the resolved `scene`.
    ///
    /// # Errors
    /// A scene without `series.nc`, from which results are collected.
    pub fn add(&mut self, scene: &AnyScene) -> Result<()> {
        let series = match scene {
            AnyScene::Grains(scene) => scene.output.files[FileKind::Series].is_some(),
            AnyScene::Water(scene) => scene.output[FileKind::Series].is_some(),
        };
        ensure!(
            series,
            "output.series is \"none\", and a sweep collects what stands in series.nc; write e.g. \
             --set output.series='{{ every = \"1 ms\" }}'"
        );
        let end = match scene {
            AnyScene::Water(scene) => {
                let cells = scene.water.lattice().count() as u64;
                let work = scene.steps().saturating_mul(cells);
                self.push("water", None, 0, work, 0, scene.text.clone())
            }
            AnyScene::Grains(scene) => {
                let start = Start::number(scene, &mut self.start);
                let stages = stages(scene);
                let count = scene.start.grains.len() as u64;
                if scene.phases.len() > self.phases.len() {
                    let names = scene.phases.iter().map(|phase| phase.name.clone());
                    self.phases = names.collect();
                }
                let (mut from, last) = (None, scene.phases.len() - 1);
                for (number, phase) in scene.phases.iter().enumerate() {
                    let stage = stages[number];
                    let key = (start, from, stage);
                    // The last phase is a point's own, even if another point is the same.
                    let known = self.known.get(&key).copied().filter(|_| number < last);
                    let run = known.unwrap_or_else(|| {
                        let state =
                            from.map(|run: usize| format!("../{}/{STATE}", self.runs[run].name));
                        let text = text::of_phase(&scene.text, number, state.as_deref());
                        let work = expected_steps(scene, phase).saturating_mul(count);
                        self.push(&phase.name, from, number, work, stage, text)
                    });
                    if number < last {
                        self.known.insert(key, run);
                    }
                    from = Some(run);
                }
                from.expect("a scene has phases")
            }
        };
        self.ends.push(end);
        Ok(())
    }

    fn push(
        &mut self,
        name: &str,
        from: Option<usize>,
        phase: usize,
        work: u64,
        stage: u64,
        text: String,
    ) -> usize {
        let count = self.counts.entry(name.into()).or_default();
        self.runs.push(Run {
            name: format!("{name}-{count}"),
            from,
            phase,
            work,
            stage,
            text: fingerprint(&text),
        });
        *count += 1;
        self.texts.push(text);
        self.runs.len() - 1
    }
}
