//! Reading a solver: snapshots and the energy ledger.

use crate::lanes::Row;
use crate::motion::turned;
use crate::sorted::Lasting;
use crate::{Body, Contact, Grains, History, Ledger, Snapshot, Solver, State, WallState};
use glam::{DQuat, DVec3};

impl Solver {
    /// Copy of everything that outputs need, grains in the order of their identities.
    pub fn snapshot(&self) -> Snapshot {
        let (grains, force, torque) = self.grains_now();
        let contacts = self.contacts();
        let loading = self.loading();
        let half = 0.5 * self.model.step;
        let walls = self.boundary.walls.iter().enumerate();
        let walls = walls
            .map(|(k, wall)| WallState {
                offset: wall.offset,
                velocity: wall.velocity + half * loading.wall_acceleration(&self.boundary, k),
            })
            .collect();
        let ledger = self.ledger(&grains, &contacts);
        Snapshot {
            state: State {
                time: self.start + self.boundary.sums.steps as f64 * self.model.step,
                grains,
                contacts,
                walls,
            },
            force,
            torque,
            wall_force: self.boundary.wall_force.clone(),
            held_force: self.boundary.held_force,
            driven_force: self.boundary.driven_force,
            sums: self.boundary.sums.clone(),
            ledger,
        }
    }

    /// Grains with velocities at the time of their positions, forces and torques.
    fn grains_now(&self) -> (Grains, Vec<DVec3>, Vec<DVec3>) {
        let sorted = &self.sorted;
        let n = sorted.id.len();
        // SAFETY: the solver is not stepping, so nobody writes.
        let (position, velocity, spin, rotation, orientation) = unsafe {
            (
                sorted.rows.position.read(),
                sorted.rows.velocity.read(),
                sorted.rows.spin.read(),
                sorted.rows.turned.read(),
                sorted.rows.orientation.read(),
            )
        };
        let spins = !spin.is_empty();
        let drive = 0.5 * self.model.step * self.loading().drive_acceleration(&self.boundary);
        let mut grains = Grains {
            id: (0..n as u32).collect(),
            radius: vec![0.0; n],
            mass: vec![0.0; n],
            moment_of_inertia: vec![0.0; n],
            position: vec![DVec3::ZERO; n],
            displacement: vec![DVec3::ZERO; n],
            velocity: vec![DVec3::ZERO; n],
            angular_velocity: vec![DVec3::ZERO; n],
            orientation: vec![DQuat::IDENTITY; n],
            constraint: vec![Default::default(); n],
        };
        let (mut forces, mut torques) = (vec![DVec3::ZERO; n], vec![DVec3::ZERO; n]);
        for slab in &sorted.slabs {
            for (own, k) in slab.own.clone().enumerate() {
                let id = sorted.id[k] as usize;
                let mut force = slab.force[own].xyz();
                let mut torque = if spins {
                    slab.torque[own].xyz()
                } else {
                    DVec3::ZERO
                };
                if let Some((outside_force, outside_torque)) = &self.outside {
                    force += outside_force[k].xyz();
                    torque += outside_torque[k].xyz();
                }
                grains.radius[id] = position[k].w();
                grains.mass[id] = sorted.mass[k];
                grains.moment_of_inertia[id] = sorted.moment_of_inertia[k];
                grains.position[id] = self.model.domain.inside(position[k].xyz());
                grains.displacement[id] = position[k].xyz() - sorted.origin[k];
                grains.velocity[id] = velocity[k].xyz() + 0.5 * sorted.kick[k] * force;
                if sorted.constraint[k].horizontal == crate::Horizontal::Driven {
                    grains.velocity[id].x = self.boundary.drive_velocity + drive;
                }
                grains.orientation[id] = orientation[k];
                if spins {
                    grains.angular_velocity[id] = spin[k].xyz() + 0.5 * sorted.twist[k] * torque;
                    grains.orientation[id] = turned(orientation[k], rotation[k].xyz());
                }
                grains.constraint[id] = sorted.constraint[k];
                forces[id] = force;
                torques[id] = torque;
            }
        }
        (grains, forces, torques)
    }

    /// The contacts of the last evaluation, sorted by their bodies.
    fn contacts(&self) -> Vec<Contact> {
        let sorted = &self.sorted;
        // SAFETY: the solver is not stepping, so nobody writes.
        let position = unsafe { sorted.rows.position.read() };
        let mut place = vec![0; sorted.id.len()];
        for (k, &id) in sorted.id.iter().enumerate() {
            place[id as usize] = k;
        }
        let mut contacts: Vec<Contact> = sorted
            .lasting()
            .into_iter()
            .map(|lasting| self.contact(lasting, position, &place))
            .collect();
        contacts.sort_unstable_by_key(|contact| (contact.i, contact.j));
        contacts
    }

    fn contact(&self, mut lasting: Lasting, position: &[Row], place: &[usize]) -> Contact {
        if let Body::Grain(b) = lasting.b
            && b < lasting.a
        {
            lasting = Lasting {
                a: b,
                b: Body::Grain(lasting.a),
                kept: lasting.kept.reversed(),
            };
        }
        let at = |id: u32| position[place[id as usize]];
        let x = at(lasting.a);
        let (branch, reach) = match lasting.b {
            Body::Grain(b) => {
                let d = self.model.domain.nearest_image(x.xyz() - at(b).xyz());
                (d, x.w() + at(b).w())
            }
            Body::Wall(k) => {
                let normal = self.model.walls[k as usize].normal;
                let offset = self.boundary.walls[k as usize].offset;
                (normal * (x.xyz().dot(normal) - offset), x.w())
            }
        };
        let kept = lasting.kept;
        Contact {
            i: lasting.a,
            j: lasting.b,
            history: History {
                spring: kept.spring.xyz(),
                rolling_spring: kept.rolling.xyz(),
                twisting_spring: kept.rolling.w(),
                sliding: kept.spring.w() > 0.5,
            },
            force: kept.force.xyz(),
            overlap: reach - branch.length(),
            branch,
        }
    }

    /// Energies now; sums stay zero.
    pub(crate) fn energies(&self) -> Ledger {
        let (grains, ..) = self.grains_now();
        Ledger::of_instant(&self.model, &grains, &self.contacts())
    }

    fn ledger(&self, grains: &Grains, contacts: &[Contact]) -> Ledger {
        let start = &self.ledger_start;
        let mut ledger = Ledger::of_instant(&self.model, grains, contacts);
        let loss = self.pending_losses();
        ledger.dissipated_friction = loss.friction;
        ledger.dissipated_viscosity = loss.viscosity;
        ledger.dissipated_rolling = loss.rolling;
        ledger.work_outside = loss.outside;
        ledger.work_companion = loss.companion + self.held_work();
        ledger.work_walls = self.boundary.work_walls;
        ledger.work_drive = self.boundary.work_drive;
        ledger.work_gravity -= start.work_gravity;
        ledger.residual = ledger.work() - ledger.dissipated() - (ledger.stored() - start.stored());
        ledger
    }

    /// Booked losses and those of the last evaluation, which the next kick will book.
    fn pending_losses(&self) -> crate::slab::Loss {
        let mut loss = self.losses();
        let spins = self.model.law.slides();
        for slab in &self.sorted.slabs {
            for own in 0..slab.own.len() {
                if spins {
                    loss.friction += slab.force[own].w();
                    loss.viscosity += slab.torque[own].w();
                } else {
                    loss.viscosity += slab.force[own].w();
                }
                loss.rolling += slab.rolling_loss.get(own).copied().unwrap_or(0.0);
            }
        }
        loss
    }
}

impl Ledger {
    /// Energy in motion and springs [J].
    pub fn stored(&self) -> f64 {
        self.kinetic
            + self.rotational
            + self.elastic_normal
            + self.elastic_tangential
            + self.elastic_rolling
    }

    /// Energy lost since the solver began [J].
    pub fn dissipated(&self) -> f64 {
        self.dissipated_friction + self.dissipated_viscosity + self.dissipated_rolling
    }

    /// Work done on the grains since the solver began [J].
    pub fn work(&self) -> f64 {
        self.work_walls
            + self.work_drive
            + self.work_gravity
            + self.work_outside
            + self.work_companion
    }
}
