//! Forces and torques from outside.

use super::solver::Solver;
use crate::Error;
use glam::DVec3;

impl Solver {
    /// Outside forces change at this instant, half a step ahead of the velocities: the half
    /// step until now belongs to the old ones, the half step to come to the new ones.
    ///
    /// Once there have been any, steps are made by the kernel that reads them, zeros too.
    pub(super) fn change_outside(&mut self, new: Option<Vec<[DVec3; 2]>>) -> Result<(), Error> {
        if self.outside == new {
            return Ok(());
        }
        let n = self.start.grains.len();
        let zero = || vec![[DVec3::ZERO; 2]; n];
        let after = new.clone().unwrap_or_else(zero);
        let before = std::mem::replace(&mut self.outside, new).unwrap_or_else(zero);
        // The first kick of all is half a one, and all made by the forces of the start.
        let share = if self.control.base == 0 { 0.0 } else { 0.5 };
        let more = before.iter().zip(&after);
        let more = more.map(|(b, a)| [share * (b[0] - a[0]), share * (b[1] - a[1])]);
        let rows = after.iter().copied().chain(more).flatten();
        let rows: Vec<[f32; 4]> = rows.map(|v| v.as_vec3().extend(0.0).to_array()).collect();
        let changed = [self.control.base];
        match &self.arrays.outside {
            Some((outside, step)) => {
                self.device.write(outside, 0, &rows);
                self.device.write(step, 0, &changed);
            }
            None => {
                let outside = self.device.array_of("outside", &rows)?;
                let step = self.device.array_of("changed", &changed)?;
                self.arrays.outside = Some((outside, step));
                self.flags = self.flags.clone().set("OUTSIDE");
                self.bind_steps()?;
            }
        }
        Ok(())
    }
}
