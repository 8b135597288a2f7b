//! What is said when a run of water has ended.

use crate::scene::water::{AXES, Water};
use lbm::{Regime, Snapshot};
use std::fmt;
use std::path::PathBuf;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Its duration was over.
    Duration,
    /// The flow was steady.
    Steady,
    /// Its maximal duration was over before the flow was steady.
    MaxDuration,
    /// The user stopped it.
    Stopped,
}

/// A run in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterSummary {
    /// Who computed.
    pub device: String,
    /// Why it ended.
    pub outcome: Outcome,
    /// Number of cells with water.
    pub cells: usize,
    /// Steps made.
    pub steps: u64,
    /// Simulated time of this run [s].
    pub duration: f64,
    /// What is still left of the duration [s].
    pub left: f64,
    /// Mean flux along x, y, z at the end [m/s].
    pub flux: [f64; 3],
    /// Greatest speed of any row of the files, or flux in a bed [m/s].
    pub fastest: f64,
    /// What makes the numbers doubtful.
    pub warnings: Vec<String>,
    /// Wall-clock time [s].
    pub seconds: f64,
    /// Folder of the results.
    pub out: PathBuf,
}

/// The greatest speed over that of the lattice's waves that leaves errors small.
const MACH_MOST: f64 = 0.3;

/// What makes the numbers of a run doubtful in which flows were as fast as `fastest` [m/s].
pub fn doubts(water: &Water, fastest: f64) -> Vec<String> {
    let scaling = &water.scaling;
    let mut doubts = Vec::new();
    if !fastest.is_finite() {
        return doubts;
    }
    let mach = fastest * scaling.step / water.model.spacing * scaling.storage[0].sqrt();
    if scaling.regime != Regime::Diffusive && mach > MACH_MOST {
        doubts.push(format!(
            "water flowed at {fastest:.3e} m/s, {mach:.2} times as fast as waves on the lattice; \
             write water.speed = \"{fastest:.1e} m/s\", and leave water.step out"
        ));
    }
    if water.model.bed.is_none() && !water.model.inertia {
        let longest = water.lattice().size().into_iter().zip(water.model.cells);
        let longest = longest
            .filter(|(_, n)| *n > 1)
            .map(|(l, _)| l)
            .fold(0.0, f64::max);
        let fluid = water.model.fluid;
        let reynolds = fastest * longest * fluid.density / fluid.viscosity;
        if reynolds > 1.0 {
            doubts.push(format!(
                "the Reynolds number of the box is {reynolds:.1}, and the squares of the velocity \
                 are left out, which is right for parallel flow alone; else write water.inertia = true"
            ));
        }
    }
    doubts
}

/// Mean flux along each axis [m/s].
pub fn mean_flux(now: &Snapshot) -> [f64; 3] {
    let count = now.flux.len() as f64;
    [0, 1, 2].map(|axis| now.flux.iter().map(|q| q[axis]).sum::<f64>() / count)
}

impl fmt::Display for WaterSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let why = match self.outcome {
            Outcome::Duration => "done",
            Outcome::Steady => "steady",
            Outcome::MaxDuration => "max_duration over, NOT steady",
            Outcome::Stopped => "stopped",
        };
        let flux = self
            .flux
            .iter()
            .zip(AXES)
            .map(|(q, axis)| format!("{q:.4e} along {axis}"));
        let flux: Vec<String> = flux.collect();
        writeln!(
            f,
            "{:.4e} s ({why}), mean flux in m/s: {}",
            self.duration,
            flux.join(", ")
        )?;
        let speed = self.steps as f64 * self.cells as f64 / self.seconds / 1e6;
        writeln!(
            f,
            "{} steps of {} cells in {:.1} s: {speed:.1} million cells/s on {}",
            self.steps, self.cells, self.seconds, self.device
        )?;
        write!(f, "results in {}", self.out.display())
    }
}
