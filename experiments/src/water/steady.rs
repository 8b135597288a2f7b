//! The criterion that a flow is steady.

use crate::scene::WaterScene;
use lbm::Snapshot;

/// Looks in the longest time that a run may take.
const LOOKS: u64 = 50;
/// Looks that must find the flow steady in a row.
const IN_A_ROW: u32 = 3;

/// Watches the flow approach its end: from one look to the next it changes by d, and then by r d.
/// What changes by the same factor for ever has r d / (1 - r) still to come; that over the
/// fastest flow so far must be small. All are root mean squares over the box.
#[derive(Clone, Debug)]
pub struct SteadyWatch {
    every: u64,
    limit: Option<f64>,
    before: Vec<[f64; 3]>,
    change: Option<f64>,
    fastest: f64,
    in_a_row: u32,
}

impl SteadyWatch {
    /// Watch a run of `scene`.
    pub fn new(scene: &WaterScene) -> Self {
        let limit = scene.end.steady;
        Self {
            every: match limit {
                Some(_) => scene.steps().div_ceil(LOOKS),
                None => u64::MAX,
            },
            limit,
            before: scene.water.start.flux.clone(),
            change: None,
            fastest: 0.0,
            in_a_row: 0,
        }
    }

    /// The first step after `done` at which to look.
    pub fn next(&self, done: u64) -> u64 {
        (done / self.every + 1).saturating_mul(self.every)
    }

    /// One look; true once the flow has been steady long enough.
    pub fn is_steady(&mut self, now: &Snapshot) -> bool {
        let Some(limit) = self.limit else {
            return false;
        };
        let pairs = now
            .flux
            .as_flattened()
            .iter()
            .zip(self.before.as_flattened());
        let change = pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let flow = now
            .flux
            .as_flattened()
            .iter()
            .map(|u| u * u)
            .sum::<f64>()
            .sqrt();
        self.fastest = self.fastest.max(flow);
        let to_come = match self.change.replace(change) {
            // Round-off comes and goes, and has no ratio.
            _ if change < 1e-3 * limit * self.fastest => change,
            Some(before) if change < before => change * change / (before - change),
            _ => f64::INFINITY,
        };
        let steady = to_come <= limit * self.fastest;
        self.in_a_row = if steady { self.in_a_row + 1 } else { 0 };
        self.before.clone_from(&now.flux);
        self.in_a_row >= IN_A_ROW
    }
}
