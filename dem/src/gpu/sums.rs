//! Sums that steps leave on the device: forces on walls and layers, works, losses.

use super::look::Look;
use super::scene::Slots;
use super::solver::Solver;
use super::wide::Wide;
use crate::{Contact, Drive, Grains, Horizontal, Ledger, Sums, WallMotion};
use std::ops::Range;

/// Sums over steps that were taken off the device before they could overflow there, in parts
/// of their units: the answer does not depend on how often.
#[derive(Clone, Debug)]
pub(super) struct Totals {
    parts: Vec<i128>,
    slots: Slots,
}

impl Totals {
    pub fn new(slots: Slots) -> Self {
        Self {
            parts: vec![0; slots.losses_read() - slots.totals()],
            slots,
        }
    }

    /// The slots of sums over steps.
    pub fn range(&self) -> Range<usize> {
        self.slots.totals()..self.slots.losses_read()
    }

    /// Add what the device had in [`range`](Self::range).
    pub fn add(&mut self, taken: &[[u32; 2]]) {
        for (sum, &[hi, lo]) in self.parts.iter_mut().zip(taken) {
            *sum += i128::from(Wide { hi: hi as i32, lo }.parts());
        }
    }

    /// What was taken of `slot`, with the words that it has now, in units.
    fn units(&self, slot: usize, [hi, lo]: [u32; 2]) -> f64 {
        let now = i128::from(Wide { hi: hi as i32, lo }.parts());
        let taken = slot.checked_sub(self.slots.totals());
        let taken = taken.and_then(|k| self.parts.get(k)).copied();
        (taken.unwrap_or(0) + now) as f64 / 2f64.powi(32)
    }
}

impl Look {
    pub(super) fn force(&self, solver: &Solver, slot: usize) -> f64 {
        solver.totals.units(slot, self.sums[slot]) * solver.numbers.units.force
    }

    pub(super) fn energy(&self, solver: &Solver, slot: usize) -> f64 {
        solver.totals.units(slot, self.sums[slot]) * solver.numbers.units.energy
    }

    fn work(&self, solver: &Solver, slot: usize) -> f64 {
        solver.totals.units(slot, self.sums[slot]) * solver.numbers.units.work
    }

    /// Force of a companion on wall `k` in `step`, as far as it moves it [N].
    pub(super) fn companion_force(&self, solver: &Solver, step: u64, k: usize) -> f64 {
        let slots = solver.numbers.slots;
        let Some(last) = self.reliefs.get(k) else {
            return 0.0;
        };
        let row = match step < last.since.into() {
            true => slots.walls + k,
            false => k,
        };
        let relief = self.reliefs[row];
        let force = self.force(solver, slots.held_companion() + row);
        f64::from(relief.share) * force - f64::from(relief.off)
    }

    /// Forces of this instant: walls, held and driven layer [N].
    pub(super) fn forces_now(&self, solver: &Solver) -> Vec<f64> {
        let first = solver.numbers.slots.reading();
        let slots = first..first + solver.numbers.slots.forces();
        slots.map(|slot| self.force(solver, slot)).collect()
    }

    /// Sums over steps 1 to n. The device has those over 0 to n - 2, and the last in its slot.
    pub(super) fn sums_at(&self, solver: &Solver, steps: u64, now: &[f64]) -> Sums {
        let slots = solver.numbers.slots;
        let sum = |k: usize| {
            if steps == 0 {
                return 0.0;
            }
            let before = self.force(solver, slots.totals() + k);
            let last = self.force(solver, slots.of_step(steps - 1) + k);
            before + last - solver.forces_at_start[k] + now[k]
        };
        Sums {
            steps,
            wall_force: (0..slots.walls).map(sum).collect(),
            held_force: sum(slots.walls),
            driven_force: sum(slots.walls + 1),
        }
    }

    pub(super) fn ledger(
        &self,
        solver: &Solver,
        grains: &Grains,
        contacts: &[Contact],
        steps: u64,
        now: &[f64],
        sums: &Sums,
    ) -> Ledger {
        let slots = solver.numbers.slots;
        let model = &solver.model;
        let start = &solver.ledger_start;
        let mut ledger = Ledger::of_instant(model, grains, contacts);
        if steps > 0 {
            let lost = |k: usize| {
                let spread =
                    (0..slots.spread).map(|p| self.energy(solver, slots.losses() + 4 * p + k));
                spread.sum::<f64>() + self.energy(solver, slots.losses_read() + k)
            };
            ledger.dissipated_friction = lost(0);
            ledger.dissipated_viscosity = lost(1);
            ledger.dissipated_rolling = lost(2);
            // There is no force from outside where something goes along.
            match solver.arrays.parts.companion {
                Some(_) => ledger.work_companion = lost(3),
                None => ledger.work_outside = lost(3),
            }
            // Between the first force and this one, each drift takes half of the force before
            // it and half of the one after.
            let between = |k: usize, sum: f64| sum + 0.5 * (solver.forces_at_start[k] - now[k]);
            for (k, wall) in model.walls.iter().enumerate() {
                ledger.work_walls += match wall.motion {
                    WallMotion::Held => 0.0,
                    WallMotion::Velocity(v) => v * model.step * between(k, sums.wall_force[k]),
                    WallMotion::Stress(_) => self.work_of_wall(solver, k, steps, now),
                };
            }
            let layer = slots.walls + 1;
            ledger.work_drive = match model.drive {
                Some(Drive::Velocity(v)) => -v * model.step * between(layer, sums.driven_force),
                Some(Drive::ShearStress(stress)) => {
                    let driven = grains
                        .constraint
                        .iter()
                        .position(|c| c.horizontal == Horizontal::Driven);
                    let way = driven.map_or(0.0, |k| {
                        grains.displacement[k].x - solver.start.grains.displacement[k].x
                    });
                    stress * model.domain.area() * way
                }
                None => 0.0,
            };
        }
        ledger.work_gravity -= start.work_gravity;
        ledger.residual = ledger.work() - ledger.dissipated() - (ledger.stored() - start.stored());
        ledger
    }

    /// Work of wall `k` under a stress. The device has booked both halves of the forces up to
    /// two steps ago.
    fn work_of_wall(&self, solver: &Solver, k: usize, steps: u64, now: &[f64]) -> f64 {
        let slots = solver.numbers.slots;
        let half = 0.5 * solver.model.step;
        let booked = self.work(solver, slots.works() + k);
        let walls = slots.walls;
        let before = match steps {
            // There was no drift before the first force.
            1 => 0.0,
            _ => self.bodies[((steps - 1) & 1) as usize * (walls + 1) + k]
                .velocity
                .into(),
        };
        let after = self.bodies_now(solver)[k].1;
        let last = self.force(solver, slots.of_step(steps - 1) + k);
        booked + half * last * (before + after) + half * now[k] * after
    }
}
