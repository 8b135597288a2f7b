//! What f32 may do to each quantity of a snapshot.
//!
//! The GPU rounds velocities, forces and springs to f32 in every step. What that may do is
//! measured, not guessed: the CPU runs once more from a start that is off by the roundings of one
//! step ([`nudged`]). The state is rounded when it is handed over, and then in each of n steps. If
//! each of these grows as the one at the start did, a quantity is off by at most n + 1 times what
//! the two CPU runs are apart ([`allowed`]); to which the roundings of the reading are added.

use crate::compare::{Amounts, ENERGIES, apart};
use dem::{Body, Contact, Drive, Horizontal, Model, Snapshot, State, WallMotion};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Half a unit in the last place of f32, relative.
pub const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// Roundings of a velocity in one step: of the force, its product with dt/m, the sum, and the way.
const STEP: f64 = 4.0;

/// Roundings of one reading: a force is a dozen operations, a grain has up to a dozen contacts,
/// and roundings of both signs cancel in part.
const READING: f64 = 16.0;

/// Sizes of what is rounded.
struct Sizes {
    speed: f64,
    spin: f64,
    force: f64,
    wall_force: f64,
    spring: f64,
    radius: f64,
    smallest: f64,
    lightest: f64,
    /// dt/M of the lightest wall under stress, times its load.
    wall_kick: f64,
    /// Energy that goes through contacts, walls and drive in a step [J].
    through: f64,
    energy: f64,
}

impl Sizes {
    fn of(s: &Snapshot, model: &Model) -> Self {
        let grains = &s.state.grains;
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let walls = || s.state.walls.iter().map(|wall| wall.velocity.abs());
        let speed = largest(&mut grains.velocity.iter().map(|v| v.length()).chain(walls()));
        let spin = largest(&mut grains.angular_velocity.iter().map(|w| w.length()));
        let radius = largest(&mut grains.radius.iter().copied());
        let contacts = &s.state.contacts;
        let elastic = largest(&mut contacts.iter().map(|c| c.force.length()));
        let law = &model.law;
        // Dashpots take differences of the speeds that are rounded.
        let force = elastic + law.normal_damping() * (speed + radius * spin);
        let history = contacts.iter().map(|c| {
            let turned = c.history.rolling_spring.length();
            c.history
                .spring
                .length()
                .max(turned)
                .max(c.history.twisting_spring.abs())
        });
        let slip = model.step * (speed + radius * spin);
        let spring = largest(&mut history.into_iter()) + slip;
        let smallest = grains.radius.iter().copied().fold(f64::INFINITY, f64::min);
        let lightest = grains.mass.iter().copied().fold(f64::INFINITY, f64::min);
        let mut wall_kick: f64 = 0.0;
        for wall in &model.walls {
            if let WallMotion::Stress(load) = wall.motion {
                let push = (load.mean.abs() + load.amplitude.abs()) * load.area;
                wall_kick = wall_kick.max(model.step / load.mass * push);
            }
        }
        let wall_force = largest(&mut s.wall_force.iter().map(|f| f.abs()));
        let layers = s.held_force.abs() + s.driven_force.abs();
        let between = |c: &Contact| {
            let end = |k: u32| {
                let k = k as usize;
                (
                    grains.velocity[k],
                    grains.radius[k] * grains.angular_velocity[k].length(),
                )
            };
            let (v, turning) = end(c.i);
            let (w, other) = match c.j {
                Body::Grain(j) => end(j),
                Body::Wall(k) => (
                    model.walls[k as usize].normal * s.state.walls[k as usize].velocity,
                    0.0,
                ),
            };
            c.force.length() * (v.distance(w) + turning + other)
        };
        let ends = (s.wall_force.iter().sum::<f64>() + layers) * speed;
        let power = contacts.iter().map(between).sum::<f64>() + ends;
        let l = &s.ledger;
        let stored = l.kinetic + l.rotational + l.elastic_normal + l.elastic_tangential;
        Self {
            speed,
            spin,
            force,
            wall_force: wall_force + layers + force,
            spring,
            radius,
            smallest,
            lightest,
            wall_kick,
            through: power * model.step,
            energy: stored + l.elastic_rolling + l.work_gravity.abs(),
        }
    }

    /// Change of velocity in a step.
    fn kick(&self, model: &Model) -> f64 {
        model.step / self.lightest * self.force
    }

    fn twist(&self, model: &Model) -> f64 {
        // Of a sphere, dt/I R F.
        2.5 * self.kick(model) / self.smallest
    }

    /// What one reading of each quantity may be off by.
    fn reading(&self, model: &Model, steps: u64, extent: f64) -> Amounts {
        let exact = 4.0 * f64::EPSILON * extent;
        let speed = self.speed + self.kick(model) + self.wall_kick;
        let turned = self.force * self.radius;
        let sums = self.energy + self.through * steps as f64;
        let mut sizes = Amounts::from([
            ("velocity", speed),
            ("spin", self.spin + self.twist(model)),
            ("orientation", 1.0),
            ("force", self.force),
            ("torque", turned),
            ("contact force", self.force),
            ("spring", self.spring),
            ("rolling spring", self.spring),
            ("twisting spring", self.spring),
            ("wall velocity", speed),
            ("force on a wall or layer", self.wall_force),
            ("mean force", self.wall_force),
        ]);
        for (name, _) in ENERGIES {
            sizes.insert(name, sums);
        }
        sizes
            .values_mut()
            .for_each(|size| *size *= READING * ROUNDING);
        for name in ["place", "way", "overlap", "branch", "wall place"] {
            sizes.insert(name, exact);
        }
        sizes.insert("flags", 0.0);
        sizes
    }
}

/// What the GPU may be off by, from CPU runs `cpu` and `nudged` of the same start.
pub fn allowed(cpu: &Snapshot, nudged: &Snapshot, start: &Snapshot, model: &Model) -> Amounts {
    let steps = cpu.sums.steps;
    let grown = apart(cpu, nudged, model);
    let each = cpu.state.grains.position.iter();
    let extent = each.fold(0.0_f64, |a, x| a.max(x.abs().max_element()));
    let sizes = [cpu, start].map(|s| {
        let sizes = Sizes::of(s, model);
        (sizes.spin, sizes.reading(model, steps, extent))
    });
    let mut allowed = Amounts::new();
    for (name, grown) in grown {
        let [now, then] = [0, 1].map(|k: usize| sizes[k].1[name]);
        allowed.insert(name, (steps + 1) as f64 * grown + now.max(then));
    }
    // Prescribed velocities are rounded once for all steps; and so is what comes of them.
    let driven = match model.drive {
        Some(Drive::Velocity(velocity)) => velocity.abs(),
        _ => 0.0,
    };
    let walls = model.walls.iter().map(|wall| match wall.motion {
        WallMotion::Velocity(velocity) => velocity.abs(),
        _ => 0.0,
    });
    let way = walls.fold(driven, f64::max) * steps as f64 * model.step;
    for name in ["place", "way", "wall place", "overlap", "branch"] {
        *allowed.entry(name).or_default() += STEP * ROUNDING * way;
    }
    // Both add up rotations as vectors for a while, the CPU for 64 steps: what is left out is at
    // most half the product of any two parts.
    let spin = sizes.iter().map(|s| s.0).fold(0.0, f64::max);
    let angle = spin * steps.min(64) as f64 * model.step;
    *allowed.entry("orientation").or_default() += 0.5 * angle * angle;
    allowed
}

/// `state` with every velocity, spin and spring off by the rounding of one step, in directions of
/// chance. `cpu` is the reading of that state.
pub fn nudged(state: &State, cpu: &Snapshot, model: &Model) -> State {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut direction = || {
        loop {
            let v = DVec3::from([0, 1, 2].map(|_| random.random_range(-1.0..1.0)));
            if (0.1..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    };
    let sizes = Sizes::of(cpu, model);
    let mut state = state.clone();
    let grains = &mut state.grains;
    for k in 0..grains.len() {
        let kick = model.step / grains.mass[k] * sizes.force;
        let by = STEP * ROUNDING * (sizes.speed + kick);
        grains.velocity[k] += by * direction();
        if grains.constraint[k].horizontal == Horizontal::Driven {
            // One velocity of the layer: the chances of its grains would cancel.
            grains.velocity[k].x += by;
        }
        let twist = 2.5 * kick / grains.radius[k];
        grains.angular_velocity[k] += STEP * ROUNDING * (sizes.spin + twist) * direction();
    }
    for contact in &mut state.contacts {
        let by = STEP * ROUNDING * sizes.spring;
        let history = &mut contact.history;
        if history.spring != DVec3::ZERO {
            history.spring += by * direction();
        }
        if history.rolling_spring != DVec3::ZERO {
            history.rolling_spring += by * direction();
            history.twisting_spring += by * direction().x;
        }
    }
    for wall in &mut state.walls {
        wall.velocity += STEP * ROUNDING * (sizes.speed + sizes.wall_kick);
    }
    state
}
