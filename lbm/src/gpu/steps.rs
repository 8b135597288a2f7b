//! Steps on the device: recorded by the hundred, handed over, heard of later.

use super::flags;
use super::sides::Given;
use super::solver::Solver;
use crate::Error;
use shaders::{Bound, Recording};
use std::collections::VecDeque;

/// Steps of one submission at most; even, so that a number is as odd as that of its step.
const MOST: u64 = 256;
/// Cells times steps of one submission at most: about a tenth of a second on a fast device, and
/// less than what an operating system takes for a hang on a slow one.
const MOST_CELLS: u64 = 1 << 31;
/// Numbers of steps in a submission, the first of which may be odd, and of what is read between
/// them where grains go along; then two for a reading, between even steps and between odd ones.
pub(super) const TICKS: usize = ROWS + 2;
pub(super) const ROWS: usize = 2048;
/// Threads of a workgroup in finite.wgsl.
const THREADS: u32 = 64;

impl Solver {
    /// Make `steps` steps, and wait for them. Numbers that run away are seen some hundred steps
    /// later.
    pub(super) fn walk(&mut self, step: Bound, steps: u64) -> Result<(), Error> {
        let mut left = steps;
        let mut pending = VecDeque::new();
        while left > 0 {
            let made = left.min(self.most_steps());
            left -= made;
            let mut recording = self.device.record();
            self.record(&mut recording, &step, made);
            let groups = shaders::groups(self.grid.places(), THREADS);
            recording.dispatch(&self.finite, groups);
            recording.submit()?;
            let mut reading = self.device.reading();
            let wrong = reading.add(&self.arrays.wrong, 0..1);
            pending.push_back((reading.start(), wrong));
            // One to work on, and one to go on with.
            let ahead = if left > 0 { 2 } else { 0 };
            while pending.len() > ahead
                && let Some((reading, wrong)) = pending.pop_front()
            {
                if reading.wait()?.take(wrong) != [0] {
                    return Err(Error::run_away(self.steps, &self.scaling));
                }
            }
        }
        Ok(())
    }

    /// The most steps of one submission from here on.
    pub(super) fn most_steps(&self) -> u64 {
        let most = (MOST_CELLS / self.fluid.len() as u64).clamp(2, MOST);
        most - self.steps % 2
    }

    /// Record `count` steps from here on, and tell the device what the sides give in them.
    pub(super) fn record(&mut self, recording: &mut Recording, step: &Bound, count: u64) {
        let odd = self.steps % 2;
        let groups = flags::groups(self.grid.cells);
        let mut given = Vec::new();
        for k in 0..count {
            given.push(self.last);
            recording.dispatch_at(step, (odd + k) as u32, groups);
            // What is emitted passes a side half a step later.
            let time = self.clock.after((self.steps + k) as f64 + 0.5);
            self.last = Given::at(&self.model, &self.scaling, self.stretch, time);
        }
        self.device.write(&self.arrays.given, odd as usize, &given);
        self.steps += count;
    }

    /// Tell the device what the sides gave last: the number of a reading.
    pub(super) fn write_last(&self) -> u32 {
        let tick = ROWS as u64 + self.steps % 2;
        self.device
            .write(&self.arrays.given, tick as usize, &[self.last]);
        tick as u32
    }
}
