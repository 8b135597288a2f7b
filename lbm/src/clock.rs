//! When the steps of a run happen.

/// Simulated time by steps. A start that is a whole number of steps is counted in steps, so that a
/// run that goes on from a state has the times, and so the sides, of one that was not stopped: to
/// the bit.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// [s]
    start: f64,
    /// Steps between `start` and the first one.
    before: f64,
    /// [s]
    step: f64,
}

impl Clock {
    /// A clock that shows `start` [s] and advances by `step` [s].
    pub fn new(start: f64, step: f64) -> Self {
        let before = (start / step).round();
        let (start, before) = match before * step == start {
            true => (0.0, before),
            false => (start, 0.0),
        };
        Self {
            start,
            before,
            step,
        }
    }

    /// Time [s] after so many steps, or half steps.
    pub fn after(&self, steps: f64) -> f64 {
        self.start + (self.before + steps) * self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_goes_on_shows_the_times_of_one_that_was_not_stopped() {
        let step = 17.102_666_666_666_6;
        let whole = Clock::new(0.0, step);
        for stopped in 0..3000 {
            let rest = Clock::new(whole.after(f64::from(stopped)), step);
            let all = f64::from(stopped) + 700.5;
            assert_eq!(rest.after(700.5), whole.after(all), "{stopped}");
        }
        assert_eq!(Clock::new(0.3, 1.0).after(2.0), 2.3);
    }
}
