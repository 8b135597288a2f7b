//! The water's own step, and what grains feel of it.

use super::Water;
use super::flow::Flow;
use crate::Error;
use crate::open::Motion;
use dem::Moved;
use lbm::Side;

impl<const N: usize> Water<N> {
    /// The water's own step: what has been collected is drained.
    pub(super) fn drain(&mut self, moved: &Moved) -> Result<(), Error> {
        let step = moved.step;
        let passed = (step - self.fluid_at) as f64 * self.step;
        self.fluid_at = step;
        let lattice = &self.lattice;
        let collected = self.fields.collected.get_mut();
        let solver = match &mut self.flow {
            Flow::Lattice(solver) => solver,
            Flow::Open(open) => {
                let [bottom, top] = self.walls.map(|k| moved.walls[k].velocity);
                let motion = Motion {
                    each: moved.velocity,
                    faces: self.fields.velocity.get_mut(),
                    walls: [bottom, -top],
                };
                let (storage, content) = (&self.storage, &mut self.content);
                open.advance(lattice, &motion, collected, storage, content)?;
                collected.fill(0.0);
                self.fields.kept.clone_from(&open.kept);
                self.fields.ends.clone_from(&open.ends);
                let left = open.left(lattice);
                for (sum, left) in self.left.iter_mut().zip(left) {
                    *sum += left;
                }
                return Ok(());
            }
        };
        self.scratch.rates.resize(lattice.count(), 0.0);
        let (mut open, mut before) = (0.0, 0.0);
        let rate = 1.0 / (lattice.volume() * passed);
        for (cell, collected) in collected.iter_mut().enumerate() {
            // Vapour opens where the pressure would fall below the least, and closes again.
            let held = self.storage[cell] * self.least[cell];
            let opens = match held.is_finite() {
                true => (held - (self.content[cell] - *collected)).max(-self.vapour[cell]),
                false => 0.0,
            };
            self.vapour[cell] += opens;
            open += self.vapour[cell];
            let change = opens - *collected;
            before += self.content[cell] + change;
            self.scratch.rates[self.order[cell] as usize] = change * rate;
            *collected = 0.0;
        }
        self.events.see_vapour(open, passed);
        solver.advance_with(self.steps.sub_steps, &self.scratch.rates)?;
        self.read_content();
        let left = self.see_leaving(before - self.content.iter().sum::<f64>(), passed);
        if self.books.kept {
            self.book_sides(left, passed);
        }
        Ok(())
    }

    /// A `volume` [m³] has left in a `time` [s]: what does not go through a wall as its side says
    /// goes through the other; where a pressure is prescribed at both, more through one than the
    /// other by what flows in the cells beside them now. The volumes through bottom and top.
    pub(super) fn see_leaving(&mut self, volume: f64, time: f64) -> [f64; 2] {
        let area = self.lattice.area();
        let [bottom, top] = self.model.sides.each_ref().map(|side| match side {
            Side::Flux(signal) => Some(-signal.at(self.flow.time()) * area * time),
            Side::Pressure(_) => None,
            _ => Some(0.0),
        });
        let shares = match (bottom, top) {
            (Some(bottom), Some(top)) => [bottom, top],
            (Some(bottom), None) => [bottom, volume - bottom],
            (None, Some(top)) => [volume - top, top],
            (None, None) => {
                let layers = [0, self.lattice.cells[2] - 1];
                let fluxes = |solver: &lbm::Solver<f64>| layers.map(|z| solver.upward_flux(z));
                let upward = self
                    .flow
                    .lattice()
                    .map_or(0.0, |solver| fluxes(solver).iter().sum());
                let more = upward * area * time;
                [0.5 * (volume - more), 0.5 * (volume + more)]
            }
        };
        for (left, share) in self.left.iter_mut().zip(shares) {
            *left += share;
        }
        shares
    }

    pub(super) fn read_content(&mut self) {
        self.scratch.of_lbm.resize(self.lattice.count(), 0.0);
        let Flow::Lattice(solver) = &self.flow else {
            return;
        };
        solver.contents(&mut self.scratch.of_lbm);
        for (content, &cell) in self.content.iter_mut().zip(&self.order) {
            *content = self.scratch.of_lbm[cell as usize];
        }
    }

    /// The pressure that grains feel until the next exchange follows.
    pub(super) fn feel(&mut self, moved: &Moved) {
        if let Flow::Open(open) = &self.flow {
            // As solved: of its differences the water keeps what is told in `kept`.
            let pressure = self.fields.pressure.get_mut();
            pressure.copy_from_slice(&open.pressure);
            return;
        }
        let times = self.times(moved);
        for cell in 0..self.lattice.count() {
            let now = self.pressure_of(cell, 0.0);
            let ahead = self.fields.trends.get_mut()[cell].ahead(now, &times);
            self.fields.pressure.get_mut()[cell] = ahead.max(self.least[cell]);
        }
    }

    /// The same when cells have changed, as at the last exchange but for that.
    pub(super) fn feel_anew(&mut self) {
        if let Flow::Open(_) = &self.flow {
            return;
        }
        let predicts = self.model.predicts;
        for cell in 0..self.lattice.count() {
            let collected = self.fields.collected.get_mut()[cell];
            let now = self.pressure_of(cell, if predicts { collected } else { 0.0 });
            let trend = &mut self.fields.trends.get_mut()[cell];
            trend.before = now;
            let ahead = now + trend.rise;
            self.fields.pressure.get_mut()[cell] = ahead.max(self.least[cell]);
        }
    }
}
