//! What is said when a run has ended.

use crate::output::pores::PoreReading;
use std::fmt;
use std::path::PathBuf;

/// Why a phase ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Its duration was over.
    Duration,
    /// Its strain was reached.
    Strain,
    /// It came to rest.
    AtRest,
    /// Its maximal duration was over before its criterion was met.
    MaxDuration,
    /// The user stopped it.
    Stopped,
}

/// One phase in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseSummary {
    /// Its name.
    pub name: String,
    /// Why it ended.
    pub outcome: Outcome,
    /// Steps made.
    pub steps: u64,
    /// Simulated time [s].
    pub duration: f64,
    /// Height of the bed at its end [m].
    pub height: f64,
    /// Solid fraction of the inside of the bed at its end, as in `series.nc` [-].
    pub solid_fraction: f64,
    /// Shear strain of the phase, and shear over normal stress at the top, the mean over the last
    /// fifth of its time.
    pub shear: Option<(f64, f64)>,
    /// The water between the grains, if there is any.
    pub water: Option<Water>,
}

/// The water at the end of a phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// Its mean pressure beyond that at rest [Pa].
    pub pressure: f64,
    /// What may be wrong with its numbers.
    pub warnings: Vec<String>,
}

impl Water {
    /// What is to be said of a reading.
    pub fn of(reading: &PoreReading) -> Self {
        let (cells, report) = (&reading.now.pressure, &reading.report);
        Self {
            pressure: cells.iter().sum::<f64>() / cells.len() as f64,
            warnings: report.warnings(),
        }
    }
}

impl fmt::Display for PhaseSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let why = match self.outcome {
            Outcome::Duration => "done",
            Outcome::Strain => "strain reached",
            Outcome::AtRest => "at rest",
            Outcome::MaxDuration => "max_duration over, criterion NOT met",
            Outcome::Stopped => "stopped",
        };
        write!(
            f,
            "{:>12}: {:.4} s ({why}), bed {:.4} m high, solid fraction {:.3}",
            self.name, self.duration, self.height, self.solid_fraction
        )?;
        if let Some((strain, friction)) = self.shear {
            write!(f, ", strain {strain:.4}, shear over normal stress ")?;
            match friction.is_finite() {
                true => write!(f, "{friction:.3} (mean of the last fifth)")?,
                false => write!(f, "unknown: nothing pressed")?,
            }
        }
        if let Some(water) = &self.water {
            write!(f, ", mean pore pressure {:.4e} Pa", water.pressure)?;
            for warning in &water.warnings {
                write!(f, "\n{:>14}warning: {warning}", "")?;
            }
        }
        Ok(())
    }
}

/// A run in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Who computed.
    pub device: String,
    /// Number of grains.
    pub grains: usize,
    /// The phases that ran.
    pub phases: Vec<PhaseSummary>,
    /// Wall-clock time [s].
    pub seconds: f64,
    /// Folder of the results.
    pub out: PathBuf,
}

impl Summary {
    /// Did the user stop it?
    pub fn stopped(&self) -> bool {
        self.phases
            .iter()
            .any(|phase| phase.outcome == Outcome::Stopped)
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let steps: u64 = self.phases.iter().map(|phase| phase.steps).sum();
        let speed = steps as f64 * self.grains as f64 / self.seconds;
        writeln!(
            f,
            "{steps} steps of {} grains in {:.1} s: {speed:.3e} grain-steps/s on {}",
            self.grains, self.seconds, self.device
        )?;
        write!(f, "results in {}", self.out.display())
    }
}
