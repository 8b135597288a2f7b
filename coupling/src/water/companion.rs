//! The water as what goes along with the grains: its part of each exchange.

use super::Water;
use crate::NormalStress;
use dem::{Companion, Moved, Row, Threads};
use lbm::Side;
use std::ops::Range;

impl<const N: usize> Companion for Water<N> {
    fn arrange(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.settle(bed)
    }

    fn exchanges(&self, step: u64) -> bool {
        step.is_multiple_of(self.steps.exchange)
    }

    fn follow(&self, moved: &Moved, threads: &Threads) {
        let pass = self.pass_at(moved.step);
        self.book_walls(moved, threads);
        pass.book_dragged(moved, threads);
        pass.follow(moved, threads);
        let (predicts, drains) = (self.model.predicts, self.drains(moved.step));
        let times = self.times(moved);
        pass.collect(moved, threads, |cell, collected, trend| {
            if drains {
                // The fluid step will tell.
                return f64::NAN;
            }
            let gone = if predicts { collected } else { 0.0 };
            let ahead = trend.ahead(self.pressure_of(cell, gone), &times);
            ahead.max(self.least[cell])
        });
    }

    fn wants_to_be_alone(&self, step: u64) -> bool {
        self.drains(step)
    }

    fn alone(&mut self, moved: &Moved) {
        match self.drain(moved) {
            Ok(()) => self.feel(moved),
            Err(error) => self.fault = Some(error),
        }
    }

    fn due(&self, step: u64) -> bool {
        self.fault.is_some() || self.renews(step)
    }

    fn settle(&mut self, bed: &dem::Bed) -> Result<(), String> {
        let renewed = match self.fault.take() {
            Some(error) => Err(error),
            None => {
                self.renewed_at = bed.step;
                self.renew(bed)
            }
        };
        renewed.map_err(|error| error.to_string())
    }

    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        let pass = self.pass_at(moved.step);
        pass.push(threads);
        pass.gather(moved, own, force);
    }

    fn wall_force(&self, wall: usize) -> f64 {
        let Some(side) = self.walls.iter().position(|&k| k == wall) else {
            return 0.0;
        };
        let force = self.pass().on_wall(side);
        match (self.model.normal_stress, &self.model.sides[side]) {
            (NormalStress::Total, _) => force,
            (NormalStress::Effective, Side::Pressure(signal)) => {
                force - signal.at(self.flow.time()) * self.lattice.area()
            }
            (NormalStress::Effective, _) => 0.0,
        }
    }
}
