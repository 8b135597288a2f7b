//! The water as what goes along with the grains: its part of each of their steps.

use super::Water;
use crate::{Error, NormalStress};
use dem::{Companion, Moved, Row, Threads};
use lbm::Side;
use std::ops::Range;

impl<const N: usize> Companion for Water<N> {
    fn arrange(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.renew(bed).map_err(|error| error.to_string())
    }

    fn follow(&self, moved: &Moved, threads: &Threads) {
        let pass = self.pass();
        pass.follow(moved, threads);
        let predicts = self.model.predicts;
        pass.collect(moved, threads, self.step, |cell, collected| {
            let gone = if predicts { collected } else { 0.0 };
            self.pressure_of(cell, gone)
        });
    }

    fn due(&self, step: u64) -> bool {
        self.drains(step) || self.renews(step)
    }

    fn settle(&mut self, bed: &dem::Bed) -> Result<(), String> {
        let step = bed.step;
        let mut settle = || {
            if self.drains(step) {
                self.drain(step)?;
            }
            if self.renews(step) {
                self.renewed_at = step;
                self.renew(bed)?;
            }
            Ok(())
        };
        settle().map_err(|error: Error| error.to_string())?;
        let predicts = self.model.predicts;
        for cell in 0..self.lattice.count() {
            let collected = self.fields.collected.get_mut()[cell];
            let gone = if predicts { collected } else { 0.0 };
            let pressure = self.pressure_of(cell, gone);
            self.fields.pressure.get_mut()[cell] = pressure;
        }
        Ok(())
    }

    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        let pass = self.pass();
        pass.push(moved, threads);
        pass.gather(moved, own, force, |grain| self.lift[grain]);
    }

    fn wall_force(&self, wall: usize) -> f64 {
        let Some(side) = self.walls.iter().position(|&k| k == wall) else {
            return 0.0;
        };
        let force = self.pass().on_wall(side);
        match (self.model.normal_stress, &self.model.sides[side]) {
            (NormalStress::Total, _) => force,
            (NormalStress::Effective, Side::Pressure(signal)) => {
                let area = self.lattice.spacing.powi(2) * self.lattice.count() as f64
                    / self.lattice.cells[2] as f64;
                force - signal.at(self.fluid.time()) * area
            }
            (NormalStress::Effective, _) => 0.0,
        }
    }
}
