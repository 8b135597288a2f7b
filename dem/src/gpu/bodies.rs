//! Walls and driven layer as the host sees them: where they are now.

use super::look::Look;
use super::solver::Solver;
use crate::{Drive, WallMotion, WallState};

impl Look {
    pub(super) fn drive_acceleration(&self, solver: &Solver, forces: &[f64]) -> f64 {
        match solver.model.drive {
            Some(Drive::ShearStress(stress)) if solver.numbers.driven_mass > 0.0 => {
                let driven = forces[solver.numbers.slots.walls + 1];
                (stress * solver.model.domain.area() + driven) / solver.numbers.driven_mass
            }
            _ => 0.0,
        }
    }

    pub(super) fn wall_acceleration(
        &self,
        solver: &Solver,
        k: usize,
        velocity: f64,
        force: f64,
    ) -> f64 {
        match solver.model.walls[k].motion {
            WallMotion::Held | WallMotion::Velocity(_) => 0.0,
            WallMotion::Stress(load) => {
                let pushed = load.stress(self.time(solver)) * load.area;
                let together = self.companion_force(solver, self.control.base.into(), k);
                (pushed - force - together - load.damping * velocity) / load.mass
            }
        }
    }

    pub(super) fn time(&self, solver: &Solver) -> f64 {
        solver.start.time + f64::from(self.control.base) * solver.model.step
    }

    /// The bodies as moved by the forces of the step before.
    pub(super) fn bodies_now(&self, solver: &Solver) -> Vec<(f64, f64)> {
        let walls = solver.numbers.slots.walls;
        let step = u64::from(self.control.base);
        let row = |step: u64| (step & 1) as usize * (walls + 1);
        if step == 0 {
            let bodies = &self.bodies[..=walls];
            let each = bodies
                .iter()
                .map(|b| (solver.numbers.grid.metres(b.offset), b.velocity.into()));
            return each.collect();
        }
        // The device moves them when the next step begins: do here what it will do.
        let last = step - 1;
        let bodies = &self.bodies[row(last)..=row(last) + walls];
        let slot = solver.numbers.slots.of_step(last);
        let dt = solver.model.step;
        // The first kick is half a one.
        let kick = if last == 0 { 0.5 * dt } else { dt };
        let each = bodies.iter().enumerate().map(|(k, body)| {
            let mut velocity = f64::from(body.velocity);
            if k == walls {
                let driven = self.force(solver, slot + walls + 1);
                let mut forces = vec![0.0; walls + 2];
                forces[walls + 1] = driven;
                velocity += kick * self.drive_acceleration(solver, &forces);
                return (0.0, velocity);
            }
            // Normals lie along axes.
            let side = solver.model.walls[k].normal.element_sum();
            if let WallMotion::Stress(load) = solver.model.walls[k].motion {
                let time = solver.start.time + last as f64 * dt;
                let pushed = load.stress(time) * load.area;
                let force = self.force(solver, slot + k);
                let together = self.companion_force(solver, last, k);
                let force = force + together;
                velocity += kick * (pushed - force - load.damping * velocity) / load.mass;
            }
            (
                solver.numbers.grid.metres(body.offset) + side * velocity * dt,
                velocity,
            )
        });
        each.collect()
    }

    /// Walls of the state, velocities still half a step behind.
    pub(super) fn walls_at(&self, solver: &Solver, bodies: &[(f64, f64)]) -> Vec<WallState> {
        let walls = solver.model.walls.iter().zip(bodies);
        let each = walls.map(|(wall, &(coordinate, velocity))| WallState {
            offset: wall.normal.element_sum() * coordinate,
            velocity,
        });
        each.collect()
    }
}
