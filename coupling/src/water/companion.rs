//! The water as what goes along with the grains: its part of each of their steps.

use super::Water;
use crate::NormalStress;
use dem::{Companion, Moved, Row, Threads};
use lbm::Side;
use std::ops::Range;

impl<const N: usize> Companion for Water<N> {
    fn arrange(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.renew(bed).map_err(|error| error.to_string())
    }

    fn follow(&self, moved: &Moved, threads: &Threads) {
        let pass = self.pass();
        self.book_walls(moved, threads);
        self.mark_collected(moved.step, threads);
        pass.follow(moved, threads);
        let predicts = self.model.predicts;
        pass.collect(moved, threads, self.step, |cell, collected| {
            let gone = if predicts { collected } else { 0.0 };
            self.pressure_of(cell, gone)
        });
    }

    fn wants_to_be_alone(&self, step: u64) -> bool {
        self.drains(step)
    }

    fn alone(&mut self, moved: &Moved) {
        match self.drain(moved.step, moved.walls) {
            Ok(()) => self.feel(),
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
        renewed.map_err(|error| error.to_string())?;
        self.feel();
        Ok(())
    }

    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        let pass = self.pass();
        pass.push(moved, threads);
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
