//! The bed as a phase measures it: strain, dilation, and what is said at the end.

use super::intervals::Due;
use super::summary::{Outcome, PhaseSummary, Water};
use crate::output::pores::PoreReading;
use crate::output::{FileKind, Frame};
use crate::protocol::{self, Reference};
use crate::scene::Phase;
use dem::{Model, Snapshot, Sums, measure};
use std::sync::Arc;

/// What a phase measures against: the bed at its start, and the last reading.
pub struct Bed {
    pub number: usize,
    /// The bed at the start of the phase.
    pub reference: Reference,
    /// Sums at the last reading of the series.
    pub before: Sums,
    /// Sums at every reading of the series.
    pub readings: Vec<Sums>,
}

impl Bed {
    /// Shear strain since the start of the phase [-].
    pub fn own_strain(&self, now: &Snapshot) -> f64 {
        (protocol::driven_way(&now.state) - self.reference.way) / self.reference.height
    }

    /// Shear strain since shearing began [-].
    pub fn strain(&self, now: &Snapshot) -> f64 {
        self.reference.strain + self.own_strain(now)
    }

    pub fn frame(
        &self,
        model: &Arc<Model>,
        now: &Arc<Snapshot>,
        water: Option<PoreReading>,
        due: Due,
    ) -> Frame {
        Frame {
            model: model.clone(),
            snapshot: now.clone(),
            before: self.before.clone(),
            water: water.map(Arc::new),
            phase: self.number as u32,
            strain: self.strain(now),
            dilation: measure::bed_height(model, &now.state) / self.reference.height - 1.0,
            due,
        }
    }

    pub fn read(&mut self, due: Due, now: &Snapshot) {
        if due[FileKind::Series] {
            self.before = now.sums.clone();
            self.readings.push(now.sums.clone());
        }
    }

    /// The last step of a phase is either what was wanted or all that was allowed.
    pub fn end_of_time(&self, phase: &Phase, now: &Snapshot) -> Outcome {
        match (phase.end.strain, phase.end.at_rest) {
            // Round-off leaves the last step a hair short.
            (Some(strain), _) if self.own_strain(now).abs() >= 0.999 * strain => Outcome::Strain,
            (None, None) => Outcome::Duration,
            _ => Outcome::MaxDuration,
        }
    }

    pub fn summary(
        &self,
        model: &Model,
        phase: &Phase,
        outcome: Outcome,
        steps: u64,
        now: &Snapshot,
        water: Option<PoreReading>,
    ) -> PhaseSummary {
        let shear = phase
            .shear
            .map(|_| (self.own_strain(now), self.friction(now)));
        PhaseSummary {
            name: phase.name.clone(),
            outcome,
            steps,
            duration: steps as f64 * model.step,
            height: measure::bed_height(model, &now.state),
            solid_fraction: measure::solid_fraction(model, &now.state),
            shear,
            water: water.map(|water| Water::of(&water)),
        }
    }

    /// Shear over normal stress at the top, mean over the last fifth of the phase.
    fn friction(&self, now: &Snapshot) -> f64 {
        let late = 0.8 * now.sums.steps as f64;
        let from = self
            .readings
            .iter()
            .rev()
            .find(|sums| sums.steps as f64 <= late);
        let zero = Sums {
            wall_force: vec![0.0; now.sums.wall_force.len()],
            ..Sums::default()
        };
        let from = from.unwrap_or(&zero);
        let pushed = now.sums.wall_force[protocol::TOP] - from.wall_force[protocol::TOP];
        -(now.sums.driven_force - from.driven_force) / pushed
    }
}
