//! How many steps to make between looks at the clock.

use std::time::Instant;

/// How many steps to make at once, so that the bar moves and Ctrl-C is heard. It has no
/// influence on results: readings and criteria are at fixed steps.
#[derive(Debug, Default)]
pub struct Pace {
    per_second: f64,
}

impl Pace {
    pub fn steps(&self) -> u64 {
        ((0.1 * self.per_second) as u64).max(1)
    }

    pub fn time<T>(&mut self, steps: u64, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let result = work();
        let now = steps as f64 / begun.elapsed().as_secs_f64().max(1e-9);
        self.per_second = if self.per_second > 0.0 {
            0.8 * self.per_second + 0.2 * now
        } else {
            now
        };
        result
    }

    pub fn steps_per_second(&self) -> f64 {
        self.per_second
    }
}
