//! The criterion that a bed is at rest.

use crate::protocol::TOP;
use crate::scene::Phase;
use dem::{Model, Snapshot, State, WallMotion};

/// Looks that must find rest in a row.
const LOOKS: u32 = 10;

/// Watches for the kinetic energy of wall and grains to stay below a fraction of the
/// elastic energy for as long as a grain needs to fall into a hole beside it, d √(ρ/σ): a
/// bed whose motion was just set to zero is not at rest yet. Grains that touch no other do
/// not count: what floats in a hole without gravity may spin for ever.
#[derive(Clone, Debug)]
pub struct RestWatch {
    every: u64,
    limit: Option<f64>,
    /// Mass of a wall that moves under a stress [kg].
    wall_mass: f64,
    in_a_row: u32,
}

impl RestWatch {
    /// Watch a phase that begins with `state`.
    pub fn new(phase: &Phase, model: &Model, state: &State) -> Self {
        let end = phase.end;
        // A strain under a given stress must be looked for; under a velocity it is known.
        let looks = end.at_rest.is_some()
            || end.strain.is_some() && matches!(model.drive, Some(dem::Drive::ShearStress(_)));
        let seconds = fall_time(model, state).unwrap_or(end.duration / 100.0);
        let every = (seconds / f64::from(LOOKS) / model.step).ceil() as u64;
        Self {
            every: if looks { every.max(1) } else { u64::MAX },
            limit: end.at_rest,
            wall_mass: match model.walls[TOP].motion {
                WallMotion::Stress(load) => load.mass,
                WallMotion::Held | WallMotion::Velocity(_) => 0.0,
            },
            in_a_row: 0,
        }
    }

    /// The first step after `done` at which to look.
    pub fn next(&self, done: u64) -> u64 {
        (done / self.every + 1).saturating_mul(self.every)
    }

    /// One look; true once the bed has been at rest long enough.
    pub fn at_rest(&mut self, now: &Snapshot) -> bool {
        let Some(limit) = self.limit else {
            return false;
        };
        let ledger = &now.ledger;
        let elastic = ledger.elastic_normal + ledger.elastic_tangential + ledger.elastic_rolling;
        let wall = 0.5 * self.wall_mass * now.state.walls[TOP].velocity.powi(2);
        let grains = &now.state.grains;
        let moving = (0..grains.len()).map(|k| {
            let (v, w) = (grains.velocity[k], grains.angular_velocity[k]);
            grains.mass[k] * v.length_squared() + grains.moment_of_inertia[k] * w.length_squared()
        });
        let touching = dem::measure::neighbours(&now.state);
        let of_bed = moving.zip(touching).filter(|&(_, touching)| touching > 0);
        let kinetic = 0.5 * of_bed.map(|(energy, _)| energy).sum::<f64>() + wall;
        let at_rest = elastic > 0.0 && kinetic < limit * elastic;
        self.in_a_row = if at_rest { self.in_a_row + 1 } else { 0 };
        self.in_a_row >= LOOKS
    }
}

/// Time in which a grain falls by its diameter under the load of the bed [s]; none without
/// a load.
fn fall_time(model: &Model, state: &State) -> Option<f64> {
    let grains = &state.grains;
    let volume: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    let density = grains.mass.iter().sum::<f64>() / volume;
    let diameter = 2.0 * grains.mean_radius();
    let wall = match model.walls[TOP].motion {
        WallMotion::Stress(load) => load.mean,
        WallMotion::Held | WallMotion::Velocity(_) => 0.0,
    };
    let load = wall.max(density * model.gravity.length() * diameter);
    (load > 0.0).then(|| diameter * (density / load).sqrt())
}
