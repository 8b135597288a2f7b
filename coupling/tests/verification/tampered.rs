//! Water whose push is watched or spoiled, to show that a test sees it.

use coupling::Water;
use dem::{Companion, Moved, Row, Threads};
use std::ops::Range;
use std::sync::Mutex;

/// What happens to the forces on the grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spoilt {
    /// Nothing.
    Not,
    /// Pressure without drag, -V ∇p: a factor 1 - φ.
    PressureAlone(f64),
    /// Gathered by weights of its own: trilinear, from the gradient in the middle of cells.
    Trilinear,
}

/// Water, and what it does to the grains.
pub struct Tampered {
    pub water: Water<3>,
    pub spoilt: Spoilt,
    /// Sum of the forces on grains and walls [N], and of their sizes, at the last step.
    pub balance: Mutex<[f64; 4]>,
}

impl Tampered {
    pub fn new(water: Water<3>, spoilt: Spoilt) -> Self {
        Self {
            water,
            spoilt,
            balance: Mutex::new([0.0; 4]),
        }
    }
}

impl Companion for Tampered {
    fn arrange(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.water.arrange(bed)
    }
    fn follow(&self, moved: &Moved, threads: &Threads) {
        self.water.follow(moved, threads);
    }
    fn exchanges(&self, step: u64) -> bool {
        self.water.exchanges(step)
    }
    fn wants_to_be_alone(&self, step: u64) -> bool {
        self.water.wants_to_be_alone(step)
    }
    fn alone(&mut self, moved: &Moved) {
        self.water.alone(moved);
    }
    fn due(&self, step: u64) -> bool {
        self.water.due(step)
    }
    fn settle(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.water.settle(bed)
    }
    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        let mut pushed = vec![Row::ZERO; force.len()];
        self.water.push(moved, threads, own.clone(), &mut pushed);
        let mut balance = [0.0; 4];
        for row in &pushed {
            for lane in 0..3 {
                balance[lane] += row.0[lane];
                balance[3] += row.0[lane].abs();
            }
        }
        balance[2] += self.water.wall_force(1) - self.water.wall_force(0);
        *self.balance.lock().unwrap() = balance;
        match self.spoilt {
            Spoilt::Not => {}
            Spoilt::PressureAlone(solid) => {
                pushed
                    .iter_mut()
                    .for_each(|row| row.0 = row.0.map(|f| solid * f));
            }
            Spoilt::Trilinear => trilinear(&self.water, &moved.position[own], &mut pushed),
        }
        for (force, pushed) in force.iter_mut().zip(&pushed) {
            for lane in 0..3 {
                force.0[lane] += pushed.0[lane];
            }
        }
    }
    fn wall_force(&self, wall: usize) -> f64 {
        self.water.wall_force(wall)
    }
}

/// -V/(1 - φ) ∇p with the gradient in the middle of cells and trilinear weights.
fn trilinear(water: &Water<3>, grains: &[Row], force: &mut [Row]) {
    let now = water.snapshot();
    let [nx, ny, nz] = water.model().cells;
    let size = [
        crate::bed::SIDE / nx as f64,
        crate::bed::SIDE / ny as f64,
        now.height,
    ];
    let at = |i: i64, j: i64, k: i64| {
        let (i, j) = (i.rem_euclid(nx as i64), j.rem_euclid(ny as i64));
        let k = k.clamp(0, nz as i64 - 1);
        ((k * ny as i64 + j) * nx as i64 + i) as usize
    };
    for (grain, force) in grains.iter().zip(force) {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * grain.w().powi(3);
        let place = [0, 1, 2].map(|axis| grain.0[axis] / size[axis] - 0.5);
        let low = place.map(|x| x.floor());
        force.0 = [0.0; 4];
        for corner in 0..8 {
            let step = [corner & 1, corner >> 1 & 1, corner >> 2].map(f64::from);
            let cell = [0, 1, 2].map(|axis| (low[axis] + step[axis]) as i64);
            let weight: f64 = (0..3)
                .map(|axis| 1.0 - (place[axis] - low[axis] - step[axis]).abs())
                .product();
            let [i, j, k] = cell;
            let solid = 1.0 - now.porosity[at(i, j, k)];
            let p = |i, j, k| now.pressure[at(i, j, k)];
            let slopes = [
                p(i + 1, j, k) - p(i - 1, j, k),
                p(i, j + 1, k) - p(i, j - 1, k),
                p(i, j, k + 1) - p(i, j, k - 1),
            ];
            for lane in 0..3 {
                let slope = slopes[lane] / (2.0 * size[lane]);
                force.0[lane] -= weight * volume / solid * slope;
            }
        }
    }
}
