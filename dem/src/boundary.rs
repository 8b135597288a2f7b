//! Walls and driven layers: what moves by sums of forces.
//!
//! Every thread holds a copy and advances it by itself from the same gauges, so that no
//! step needs a third barrier. Works are trapezoidal: the mean of the force before and
//! after a drift, times the drift.

use std::ops::Range;

use crate::{Drive, Model, Sums, WallMotion, WallState};

/// The moving boundaries and their sums.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundary {
    /// Walls; velocities half a step behind, as those of the grains.
    pub walls: Vec<WallState>,
    /// Offsets when the solver began [m].
    pub start: Vec<f64>,
    /// Velocity of the driven layer along x [m/s], half a step behind.
    pub drive_velocity: f64,
    /// Forces of the last evaluation: grains on walls, x forces on the layers [N].
    pub wall_force: Vec<f64>,
    pub held_force: f64,
    pub driven_force: f64,
    /// Forces of a companion on walls along minus their normals [N].
    pub companion_force: Vec<f64>,
    /// Step of the last exchange with it; steps that had passed since the one before, and before that.
    pub exchanged: u64,
    pub passed: [u64; 2],
    /// Offsets of the walls at the last exchange [m], and their ways until then.
    pub left: Vec<f64>,
    pub ways: Vec<f64>,
    /// Sums of these forces since the solver began.
    pub sums: Sums,
    /// Work on the grains since the solver began [J].
    pub work_walls: f64,
    pub work_drive: f64,
    /// Bound on the way of any grain or wall since the last search [m].
    pub travel: f64,
}

/// What the boundary needs to know of the run.
#[derive(Clone, Copy)]
pub(crate) struct Loading<'a> {
    pub model: &'a Model,
    /// Time of step zero [s].
    pub start: f64,
    /// Mass of the driven layer [kg].
    pub driven_mass: f64,
}

impl Loading<'_> {
    fn time(&self, steps: u64) -> f64 {
        self.start + steps as f64 * self.model.step
    }

    /// Acceleration of wall `k` along its normal at the instant of `boundary` [m/s²].
    pub fn wall_acceleration(&self, boundary: &Boundary, k: usize) -> f64 {
        match self.model.walls[k].motion {
            WallMotion::Held | WallMotion::Velocity(_) => 0.0,
            WallMotion::Stress(load) => {
                let pushed = load.stress(self.time(boundary.sums.steps)) * load.area;
                let damped = load.damping * boundary.walls[k].velocity;
                let together = boundary.companion_force[k];
                (pushed - boundary.wall_force[k] - together - damped) / load.mass
            }
        }
    }

    /// Acceleration of the driven layer [m/s²].
    pub fn drive_acceleration(&self, boundary: &Boundary) -> f64 {
        match self.model.drive {
            Some(Drive::ShearStress(stress)) if self.driven_mass > 0.0 => {
                let pushed = stress * self.model.domain.area();
                (pushed + boundary.driven_force) / self.driven_mass
            }
            _ => 0.0,
        }
    }
}

impl Boundary {
    /// Kick and drift of walls and layer, and the first half of their works.
    pub fn advance(&mut self, loading: Loading) {
        let step = loading.model.step;
        for k in 0..self.walls.len() {
            let velocity = self.walls[k].velocity + step * loading.wall_acceleration(self, k);
            self.walls[k].velocity = velocity;
            self.walls[k].offset = match loading.model.walls[k].motion {
                // A product: round-off does not add up over millions of steps.
                WallMotion::Velocity(velocity) => {
                    self.start[k] + velocity * step * (self.sums.steps + 1) as f64
                }
                WallMotion::Held | WallMotion::Stress(_) => self.walls[k].offset + step * velocity,
            };
        }
        self.drive_velocity += step * loading.drive_acceleration(self);
        self.add_half_works(loading);
    }

    /// An exchange with a companion begins: time and ways since the last one.
    pub fn exchange(&mut self) {
        let step = self.sums.steps + 1;
        self.passed = [step - self.exchanged, self.passed[0]];
        self.exchanged = step;
        self.leave();
    }

    /// Ways of the walls begin here.
    pub fn leave(&mut self) {
        self.left.resize(self.walls.len(), f64::NAN);
        self.ways.resize(self.walls.len(), 0.0);
        for ((wall, left), way) in self.walls.iter().zip(&mut self.left).zip(&mut self.ways) {
            *way = if left.is_nan() {
                0.0
            } else {
                wall.offset - *left
            };
            *left = wall.offset;
        }
    }

    /// Take the forces of the start from the gauges: one for each wall, then the held and
    /// the driven layer.
    pub fn begin(&mut self, gauges: &[Range<usize>], values: &[f64]) {
        let gauge = |k: usize| sum(&values[gauges[k].clone()]);
        let walls = self.walls.len();
        for k in 0..walls {
            self.wall_force[k] = gauge(k);
        }
        self.held_force = gauge(walls);
        self.driven_force = gauge(walls + 1);
    }

    /// The same after a step: sums, and the second half of the works.
    pub fn read(&mut self, loading: Loading, gauges: &[Range<usize>], values: &[f64]) {
        self.begin(gauges, values);
        for (sum, force) in self.sums.wall_force.iter_mut().zip(&self.wall_force) {
            *sum += force;
        }
        self.sums.held_force += self.held_force;
        self.sums.driven_force += self.driven_force;
        self.sums.steps += 1;
        self.add_half_works(loading);
    }

    fn add_half_works(&mut self, loading: Loading) {
        let half = 0.5 * loading.model.step;
        for (wall, force) in self.walls.iter().zip(&self.wall_force) {
            self.work_walls += half * force * wall.velocity;
        }
        let force = match loading.model.drive {
            // What keeps the velocity: the opposite of what the grains exert.
            Some(Drive::Velocity(_)) => -self.driven_force,
            Some(Drive::ShearStress(stress)) => stress * loading.model.domain.area(),
            None => 0.0,
        };
        self.work_drive += half * force * self.drive_velocity;
    }

    /// The fastest wall [m/s].
    pub fn wall_speed(&self) -> f64 {
        let speeds = self.walls.iter().map(|wall| wall.velocity.abs());
        speeds.fold(0.0, f64::max)
    }
}

/// Sum in a fixed order, four at a time.
fn sum(values: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let chunks = values.chunks_exact(4);
    let rest: f64 = chunks.remainder().iter().sum();
    for chunk in chunks {
        for lane in 0..4 {
            lanes[lane] += chunk[lane];
        }
    }
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + rest
}
