//! Reading a solver: what the device holds becomes a snapshot.

use super::look::Look;
use super::scene::{INDEX, SLIDING, TOUCHING};
use super::solver::Solver;
use crate::{
    Body, Contact, Error, Grains, History, Horizontal, Ledger, Snapshot, State, WallState,
};
use glam::{DQuat, DVec3};

fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(row[0].into(), row[1].into(), row[2].into())
}

fn three(row: [f32; 3]) -> DVec3 {
    DVec3::new(row[0].into(), row[1].into(), row[2].into())
}

impl Solver {
    /// Copy of everything that outputs need, grains in the order of their identities.
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn snapshot(&self) -> Result<Snapshot, Error> {
        let reading = self.look()?;
        Ok(reading.snapshot(self))
    }
}

impl Look {
    /// Energies of the state that the solver was given.
    pub(super) fn energies_at_start(&self, solver: &Solver) -> Ledger {
        let mut contacts = self.contacts(solver, &self.walls_at(solver, &self.bodies_now(solver)));
        contacts.sort_unstable_by_key(|contact| (contact.i, contact.j));
        Ledger::of_instant(&solver.model, &solver.start.grains, &contacts)
    }

    /// Net force and torque on the grain in row `k` [N, N m], all but those along what
    /// constraints hold.
    pub(super) fn net(&self, solver: &Solver, k: usize) -> (DVec3, DVec3) {
        let id = self.motions[k].id as usize;
        let grains = &solver.start.grains;
        let [free, turns] = grains.constraint[id].freedom();
        let mut force = vector(self.pushes[2 * k]) + grains.mass[id] * solver.model.gravity;
        let mut torque = vector(self.pushes[2 * k + 1]);
        if let Some(outside) = &solver.outside {
            force += outside[id][0];
            torque += outside[id][1];
        }
        (free * force, turns * torque)
    }

    fn contacts(&self, solver: &Solver, walls: &[WallState]) -> Vec<Contact> {
        let mut contacts = Vec::new();
        let grid = &solver.numbers.grid;
        let radius = |k: usize| solver.start.grains.radius[self.motions[k].id as usize];
        for (k, list) in self.lists.iter().enumerate() {
            let id = self.motions[k].id;
            for e in list[0] as usize..(list[0] + list[1]) as usize {
                let word = self.words[e];
                let j = (word & INDEX) as usize;
                let other = self.motions[j].id;
                if word & TOUCHING == 0 || other < id {
                    continue;
                }
                let branch = grid.centre(&self.places[k]) - grid.centre(&self.places[j]);
                let branch = solver.model.domain.nearest_image(branch);
                contacts.push(Contact {
                    i: id,
                    j: Body::Grain(other),
                    history: self.history(&self.springs, &self.rollings, e, word & SLIDING != 0),
                    force: vector(self.forces[e]),
                    overlap: radius(k) + radius(j) - branch.length(),
                    branch,
                });
            }
            for (wall, state) in walls.iter().enumerate() {
                let e = k * walls.len() + wall;
                let touch = self.wall_forces[e][3];
                if touch == 0.0 {
                    continue;
                }
                let normal = solver.model.walls[wall].normal;
                let way = grid.centre(&self.places[k]).dot(normal) - state.offset;
                contacts.push(Contact {
                    i: id,
                    j: Body::Wall(wall as u32),
                    history: self.history(&self.wall_springs, &self.wall_rollings, e, touch > 1.5),
                    force: vector(self.wall_forces[e]),
                    overlap: radius(k) - way,
                    branch: normal * way,
                });
            }
        }
        contacts
    }

    fn history(
        &self,
        springs: &[[f32; 4]],
        rollings: &[[f32; 4]],
        e: usize,
        sliding: bool,
    ) -> History {
        let spring = springs.get(e).copied().unwrap_or_default();
        let rolling = rollings.get(e).copied().unwrap_or_default();
        History {
            spring: vector(spring),
            rolling_spring: vector(rolling),
            twisting_spring: spring[3].into(),
            sliding,
        }
    }

    fn snapshot(&self, solver: &Solver) -> Snapshot {
        let steps = u64::from(self.control.base);
        let model = &solver.model;
        // Velocities of the start are those of its places.
        let half = if steps == 0 { 0.0 } else { 0.5 * model.step };
        let bodies = self.bodies_now(solver);
        let forces = self.forces_now(solver);
        let mut walls = self.walls_at(solver, &bodies);
        let mut contacts = self.contacts(solver, &walls);
        contacts.sort_unstable_by_key(|contact| (contact.i, contact.j));
        for (k, wall) in walls.iter_mut().enumerate() {
            wall.velocity += half * self.wall_acceleration(solver, k, wall.velocity, forces[k]);
        }
        let drive =
            bodies[solver.numbers.slots.walls].1 + half * self.drive_acceleration(solver, &forces);

        let n = self.motions.len();
        let mut grains: Grains = solver.start.grains.clone();
        let (mut force, mut torque) = (vec![DVec3::ZERO; n], vec![DVec3::ZERO; n]);
        for (k, motion) in self.motions.iter().enumerate() {
            let id = motion.id as usize;
            let (push, turn) = self.net(solver, k);
            let (mass, inertia) = (grains.mass[id], grains.moment_of_inertia[id]);
            let position = solver.numbers.grid.centre(&self.places[k]);
            let image = self.owns[k].image;
            let turns = DVec3::new(
                f64::from(image as i16),
                f64::from((image >> 16) as i16),
                0.0,
            );
            let lengths = DVec3::new(model.domain.size[0], model.domain.size[1], 0.0);
            let from = solver
                .numbers
                .grid
                .place(solver.start.grains.position[id], 0.0);
            let from = from.map_or(position, |place| solver.numbers.grid.centre(&place));
            grains.position[id] = position;
            grains.displacement[id] += position - from + turns * lengths;
            grains.velocity[id] = three(motion.velocity) + half / mass * push;
            if grains.constraint[id].horizontal == Horizontal::Driven {
                grains.velocity[id].x = drive;
            }
            if solver.arrays.parts.slides {
                grains.angular_velocity[id] = three(motion.spin) + half / inertia * turn;
                let q = self.orientations[k].map(f64::from);
                let q = DQuat::from_array(q).normalize() * solver.start.grains.orientation[id];
                let [x, y, z, _] = self.turned[k].map(|parts| f64::from(parts) / 2f64.powi(38));
                grains.orientation[id] =
                    (DQuat::from_scaled_axis(DVec3::new(x, y, z)) * q).normalize();
            }
            (force[id], torque[id]) = (push, turn);
        }

        let sums = self.sums_at(solver, steps, &forces);
        let ledger = self.ledger(solver, &grains, &contacts, steps, &forces, &sums);
        let layer = solver.numbers.slots.walls;
        Snapshot {
            state: State {
                time: self.time(solver),
                grains,
                contacts,
                walls,
            },
            force,
            torque,
            held_force: forces[layer],
            driven_force: forces[layer + 1],
            wall_force: forces[..layer].to_vec(),
            sums,
            ledger,
        }
    }
}
