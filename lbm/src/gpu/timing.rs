//! How long steps take on the device.

use super::solver::Solver;
use crate::Error;

/// Time of a stretch of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Steps made.
    pub steps: u64,
    /// By the device's own clock [s].
    pub seconds: f64,
}

impl Solver {
    /// Advance by up to `steps` steps, hundreds at most, on the device's own clock; none, and
    /// nothing done, where the device has no time stamps.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    pub fn time_steps(&mut self, steps: u64) -> Result<Option<Timing>, Error> {
        let Some(mut recording) = self.device.record_timed() else {
            return Ok(None);
        };
        recording.section("steps");
        let steps = steps.min(self.most_steps());
        let step = self.step.clone();
        self.record(&mut recording, &step, steps);
        let sections = recording.submit_timed()?;
        let seconds = sections.iter().map(|(_, seconds)| seconds).sum();
        Ok(Some(Timing { steps, seconds }))
    }
}
