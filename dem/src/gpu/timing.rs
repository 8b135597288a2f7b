//! Where the time of a step goes.

use super::solver::Solver;
use super::steps::GROUP;
use crate::Error;

/// Times of the sections of a stretch of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Steps made.
    pub steps: u64,
    /// Neighbour searches among them.
    pub searches: u64,
    /// `check` of the lists, `search` where one is due (else its empty dispatches), `steps`, and
    /// `settle`, which counts them [s].
    pub sections: Vec<(&'static str, f64)>,
}

impl Solver {
    /// Advance by about `steps` steps, hundreds at most, with time stamps around each kind of
    /// kernel; none, and nothing done, where the device has no time stamps. Stamps part the
    /// kernels more than they are in [`advance`](Self::advance).
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    pub fn time(&mut self, steps: u64) -> Result<Option<Timing>, Error> {
        let groups = steps.div_ceil(GROUP as u64);
        let begun = (self.control.base, self.control.searches);
        self.write_end(begun.0 + (groups * GROUP as u64) as u32);
        let mut each = Vec::new();
        for _ in 0..groups {
            let Some(mut recording) = self.device.record_timed() else {
                self.write_end(begun.0);
                return Ok(None);
            };
            self.search.record(&mut recording);
            recording.section("steps");
            for tick in 0..GROUP as u32 {
                self.record_step(&mut recording, tick, false);
            }
            recording.section("settle");
            self.search.settle(&mut recording);
            each.extend(recording.submit_timed()?);
        }
        let control = self.device.read(&self.arrays.control)?[0];
        self.heed(control)?;
        // Lists may have ended before a group did: what was asked for is what was made.
        self.write_end(self.control.base);
        self.since_taken += u64::from(self.control.base - begun.0);
        self.find_neighbours()?;
        let mut sections: Vec<(&'static str, f64)> = Vec::new();
        for (name, seconds) in each {
            match sections.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += seconds,
                None => sections.push((name, seconds)),
            }
        }
        Ok(Some(Timing {
            steps: u64::from(self.control.base - begun.0),
            searches: u64::from(self.control.searches - begun.1),
            sections,
        }))
    }
}
