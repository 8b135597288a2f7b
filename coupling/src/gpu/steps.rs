//! The steps: recorded in groups, and heard of.

use super::arrays::BLOCK;
use super::coupled::Coupled;
use super::kernels::Over;
use super::numbers::drags_every;
use crate::{Error, NormalStress};
use lbm::Side;
use shaders::{Array, Bound, Recording, groups};

/// Threads of a workgroup.
const THREADS: u32 = 64;
/// Grains times steps of a submission: drivers that also serve a screen take a device for lost that
/// works on one for seconds.
const SUBMITTED: u64 = 1 << 27;

impl<const N: usize> Coupled<N> {
    /// Advance by `steps` grain steps, and the water with them.
    ///
    /// # Errors
    /// [`Error`] when the numbers run away, the bed has become one that cannot be coupled, or the
    /// device fails.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        let end = self.grains.steps_made() + steps;
        while self.grains.steps_made() < end {
            let recording = self.device.record();
            self.group(end, recording, |recording| recording.submit())?;
        }
        Ok(self.grains.see_to_lists()?)
    }

    /// The same, about `steps` steps, hundreds at most, with time stamps around each kind of
    /// kernel: seconds of `check` and `search` of the lists, `order` (of the lists of cells),
    /// `grains`, `prediction`, `fluid`, `renewal` and `settle`. None, and nothing done, where the
    /// device has no time stamps. Stamps part the kernels more than they are otherwise.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    pub fn time_steps(&mut self, steps: u64) -> Result<Option<Vec<(&'static str, f64)>>, Error> {
        let end = self.grains.steps_made() + steps;
        let mut sections: Vec<(&'static str, f64)> = Vec::new();
        while self.grains.steps_made() < end {
            let Some(recording) = self.device.record_timed() else {
                return Ok(None);
            };
            self.group(end, recording, |recording| {
                for (name, seconds) in recording.submit_timed()? {
                    match sections.iter_mut().find(|(known, _)| *known == name) {
                        Some((_, sum)) => *sum += seconds,
                        None => sections.push((name, seconds)),
                    }
                }
                Ok(())
            })?;
        }
        self.grains.see_to_lists()?;
        Ok(Some(sections))
    }

    /// The step in which weights are next renewed: one with an exchange.
    fn next_renewal(&self) -> u64 {
        let due = self.renewed_at + self.model.renews_every(self.step);
        due.next_multiple_of(self.choice.exchange)
    }

    /// Are loose grains dragged at the exchange of this step? Not with the forces at which water joins,
    /// nor with weights that faces had not when they took.
    fn drags(&self, step: u64, renewal: u64) -> bool {
        step > 0 && step.is_multiple_of(drags_every(&self.choice)) && step != renewal
    }

    /// Make a group of steps, until `end` at most: into `recording`, which `submit` hands over.
    fn group(
        &mut self,
        end: u64,
        mut recording: Recording,
        submit: impl FnOnce(Recording) -> Result<(), shaders::Error>,
    ) -> Result<(), Error> {
        let made = self.grains.steps_made();
        let renewal = self.next_renewal();
        let in_stretch = (lbm::gpu::Solver::STRETCH / self.choice.sub_steps).max(1);
        let at_once = (SUBMITTED / self.grains.grains().max(1) as u64).max(1);
        let most = (in_stretch * self.choice.interval)
            .min(dem::gpu::Solver::GROUP as u64)
            .min(at_once);
        let goal = end.min(renewal).min(made + most);

        self.grains.ask_until(goal)?;
        self.grains.begin_group(&mut recording);
        recording.section("order");
        recording.dispatch(&self.renewal.number, self.over(Over::Grains));
        recording.dispatch(&self.renewal.relabel, self.over(Over::Grains));
        let mut stretch = self.fluid.stretch();
        let mut drained = vec![(self.fluid_at, self.let_out)];
        // Of the push that the group begins with, which is made.
        let mut taken_off = vec![[0.0; 2]];
        for step in made + 1..=goal {
            let tick = (step - made) as u32;
            recording.section("grains");
            self.grains
                .record_next(&mut recording, tick - 1, step == renewal);
            taken_off.push(self.taken_off());
            if !step.is_multiple_of(self.choice.exchange) {
                continue;
            }
            recording.section("prediction");
            let drags = self.drags(step, renewal);
            let drains = step - self.fluid_at >= self.choice.interval;
            self.record_follow(&mut recording, tick, drags, drains);
            if drains {
                recording.section("fluid");
                self.dispatch(&mut recording, &self.of_lattice.drain, tick, Over::Cells);
                self.fluid.record_steps(
                    &mut recording,
                    &mut stretch,
                    &self.of_fluid,
                    self.choice.sub_steps,
                );
                self.see_sides((step - self.fluid_at) as f64 * self.step);
                self.fluid_at = step;
                drained.push((step, self.let_out));
                recording.section("prediction");
                let feel = &self.steps.feel_drained;
                self.dispatch(&mut recording, feel, tick, Over::Cells);
                taken_off[tick as usize] = self.taken_off();
            }
            if step != renewal {
                self.record_push(&mut recording, tick, drags);
            }
        }
        recording.section("settle");
        self.grains.end_group(&mut recording);
        if goal == renewal {
            self.prepare_renewal(renewal);
            self.renewal.record(&mut recording, |over| self.over(over));
        }
        self.fluid.write_sides(&stretch);
        self.write_taken_off(&taken_off);
        submit(recording)?;

        let mut reading = self.device.reading();
        let progress = self.grains.ask_progress(&mut reading);
        let found = (goal == renewal).then(|| self.renewal.ask(&mut reading, &self.arrays));
        let arrived = reading.wait()?;
        self.grains.hear(&arrived, progress)?;
        let now = self.grains.steps_made();
        // What was recorded behind the end of the lists was not made.
        let late = drained.iter().filter(|(step, _)| *step > now).count() as u64;
        self.fluid.take_back(&stretch, late * self.choice.sub_steps);
        drained.retain(|(step, _)| *step <= now);
        if let Some(&last) = drained.last() {
            (self.fluid_at, self.let_out) = last;
        }
        match found {
            Some(found) if now == renewal => self.renew(renewal, &arrived, found),
            _ => Ok(()),
        }
    }

    /// The water follows the motion until step `tick` of a group; `drags`: loose grains are dragged,
    /// `drains`: a step of the fluid comes next.
    fn record_follow(&self, recording: &mut Recording, tick: u32, drags: bool, drains: bool) {
        let kernels = &self.steps;
        let mut over = |bound: &Bound, over: Over| self.dispatch(recording, bound, tick, over);
        let scatter = match drags {
            true => &kernels.scatter_both,
            false => &kernels.scatter,
        };
        over(scatter, Over::Lists);
        if let Some(add_up) = &kernels.add_up {
            over(add_up, Over::Cells);
        }
        over(&kernels.means, Over::Cells);
        if drags {
            if let Some(add_up) = &kernels.add_up_drags {
                over(add_up, Over::Cells);
            }
            over(&kernels.react, Over::Cells);
        }
        match drains {
            true => over(&kernels.collect, Over::Cells),
            false => over(&kernels.collect_and_feel, Over::Cells),
        }
    }

    /// The water pushes grains and walls until the next exchange.
    fn record_push(&self, recording: &mut Recording, tick: u32, drags: bool) {
        let kernels = &self.steps;
        let mut over = |bound: &Bound, over: Over| self.dispatch(recording, bound, tick, over);
        over(&kernels.push, Over::Cells);
        if let Some(widen) = &kernels.widen {
            over(widen, Over::Cells);
        }
        if let Some(widen) = kernels.widen_easing.as_ref().filter(|_| drags) {
            over(widen, Over::Cells);
        }
        over(&kernels.gather, Over::Grains);
    }

    /// The same with new weights, between two groups.
    pub(super) fn record_push_anew(&self, recording: &mut Recording) {
        self.dispatch(recording, &self.steps.feel_renewed, 0, Over::Cells);
        self.record_push(recording, 0, false);
    }

    /// What the water is like now, for who reads: between two exchanges too.
    pub(super) fn record_look(&self, recording: &mut Recording) {
        let kernels = &self.steps;
        let mut over = |bound: &Bound, over: Over| self.dispatch(recording, bound, 0, over);
        over(&self.renewal.number, Over::Grains);
        over(&self.renewal.relabel, Over::Grains);
        over(&kernels.scatter_look, Over::Lists);
        if let Some(add_up) = &kernels.add_up {
            over(add_up, Over::Cells);
        }
        over(&kernels.means, Over::Cells);
        over(&kernels.look, Over::Cells);
    }

    fn dispatch(&self, recording: &mut Recording, bound: &Bound, tick: u32, over: Over) {
        recording.dispatch_at(bound, tick, self.over(over));
    }

    pub(super) fn over(&self, over: Over) -> [u32; 3] {
        over.groups(self.grains.grains(), self.lattice.count())
    }

    /// What sides of prescribed flux let out in a fluid step over `time` [s].
    fn see_sides(&mut self, time: f64) {
        let now = self.fluid.time();
        for (out, side) in self.let_out.iter_mut().zip(&self.model.sides) {
            if let Side::Flux(signal) = side {
                *out -= signal.at(now) * self.lattice.area() * time;
            }
        }
    }

    /// What the bottom and the top wall do not feel of the water's force now [N].
    pub(super) fn taken_off(&self) -> [f32; 2] {
        let area = self.lattice.area();
        [0, 1].map(
            |side| match (self.model.normal_stress, &self.model.sides[side]) {
                (NormalStress::Effective, Side::Pressure(signal)) => {
                    (signal.at(self.fluid.time()) * area) as f32
                }
                _ => 0.0,
            },
        )
    }

    pub(super) fn write_taken_off(&self, rows: &[[f32; 2]]) {
        let to: &Array<[f32; 2]> = &self.arrays.taken_off;
        self.device.write(to, 0, rows);
    }
}

impl Over {
    /// Workgroups for so many grains and cells.
    pub fn groups(self, grains: usize, cells: usize) -> [u32; 3] {
        match self {
            Self::Grains => groups(grains, THREADS),
            Self::Cells => groups(cells, THREADS),
            Self::Counts => groups(cells + 1, THREADS),
            Self::Lists => groups(cells, 1),
            Self::Blocks => groups(cells + 1, BLOCK as u32),
            Self::One => [1, 1, 1],
        }
    }
}
