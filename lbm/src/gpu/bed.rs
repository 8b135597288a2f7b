//! A lattice in a bed of grains that lives on the same device: sources, storage and drag are written
//! there, by the grains' side, and the host hears no more than their extremes.
//!
//! The twins of [`advance_with`](Solver::advance_with), [`set_bed`](Solver::set_bed) and of
//! `contents` of the solver on the CPU. Steps are recorded in one recording with those of the grains
//! ([`Stretch`]). Some of them may turn out not to be due, because the grains did not get that far:
//! kernels look at a word, `guard`, and the host takes back what was not made
//! ([`Solver::take_back`]).

use super::flags;
use super::setting::Setting;
use super::sides::Given;
use super::solver::Solver;
use super::steps::ROWS;
use crate::clock::Clock;
use crate::{Error, Extremes, Model, Scaling};
use shaders::{Bindable, Bound, Flags, Recording, compose};

/// Kernels of a lattice whose bed lives on the device, bound.
pub struct Coupled {
    step: Bound,
    tell: Bound,
    lay: Bound,
}

/// Steps of one recording.
#[derive(Default)]
pub struct Stretch {
    odd: u64,
    given: Vec<Given>,
}

impl Solver {
    /// Let storage, drag and sources be written on the device: `inverse_storage`, `half_drag` and
    /// `sources`, one number for each place, among [`arrays`](Self::arrays). The kernels do nothing
    /// where the first word of `guard` is zero; flux and content of each cell go to `contents`.
    ///
    /// # Errors
    /// [`Error::Device`] when the device fails.
    pub fn couple(
        &mut self,
        guard: &dyn Bindable,
        contents: &dyn Bindable,
        factors: &dyn Bindable,
    ) -> Result<Coupled, Error> {
        self.arrays.make_sources(&self.device, self.grid.places())?;
        let mut named = self.arrays.named();
        named.extend([
            ("guard", guard),
            ("contents", contents),
            ("factors", factors),
        ]);
        let bind = |path: &str, entry: &str, flags: &Flags| {
            let kernel = self.device.kernel(&compose(path, flags)?, entry)?;
            Ok::<_, Error>(kernel.bind(&self.device, &named)?)
        };
        let guarded = self.flags.clone().set("GUARDED");
        Ok(Coupled {
            step: bind("lbm/step.wgsl", "time_step", &guarded.clone().set("SOURCE"))?,
            tell: bind("lbm/contents.wgsl", "tell", &guarded)?,
            lay: bind("lbm/lay.wgsl", "lay", &self.flags)?,
        })
    }

    /// The arrays of the lattice, by name.
    pub fn arrays(&self) -> Vec<(&str, &dyn Bindable)> {
        self.arrays.named()
    }

    /// Steps that a stretch may have at most.
    pub const STRETCH: u64 = ROWS as u64 - 2;

    /// Begin a stretch of steps.
    pub fn stretch(&self) -> Stretch {
        Stretch {
            odd: self.steps % 2,
            given: Vec::new(),
        }
    }

    /// Record `count` steps with the sources of the device, then what the cells hold.
    pub fn record_steps(
        &mut self,
        recording: &mut Recording,
        stretch: &mut Stretch,
        coupled: &Coupled,
        count: u64,
    ) {
        let groups = flags::groups(self.grid.cells);
        for _ in 0..count {
            let tick = stretch.odd + stretch.given.len() as u64;
            stretch.given.push(self.last);
            recording.dispatch_at(&coupled.step, tick as u32, groups);
            // What is emitted passes a side half a step later.
            let time = self.clock.after(self.steps as f64 + 0.5);
            self.last = Given::at(&self.model, &self.scaling, self.stretch, time);
            self.steps += 1;
        }
        self.record_contents(recording, stretch, coupled);
    }

    /// Record what the cells hold now.
    pub fn record_contents(&self, recording: &mut Recording, stretch: &Stretch, coupled: &Coupled) {
        let tick = stretch.odd + stretch.given.len() as u64;
        recording.dispatch_at(&coupled.tell, tick as u32, flags::groups(self.grid.cells));
    }

    /// Tell the device what the sides give in a stretch, before it is submitted.
    pub fn write_sides(&self, stretch: &Stretch) {
        let mut given = stretch.given.clone();
        given.push(self.last);
        self.device
            .write(&self.arrays.given, stretch.odd as usize, &given);
    }

    /// The last `count` steps that were recorded have not been made.
    pub fn take_back(&mut self, stretch: &Stretch, count: u64) {
        let made = stretch.given.len() - count as usize;
        if let Some(&last) = stretch.given.get(made) {
            self.last = last;
        }
        self.steps -= count;
    }

    /// The bed on the device is another one, with cells of height `thickness` [m]: the host's
    /// part of [`set_thickness`](Self::set_thickness) and [`set_bed`](Self::set_bed).
    ///
    /// # Errors
    /// [`Error::Invalid`] where this lattice is not stable or accurate for it.
    pub fn set_extremes(&mut self, thickness: f64, extremes: &Extremes) -> Result<(), Error> {
        let stretch = thickness / self.model.spacing;
        let scaling = self
            .scaling
            .with_extremes::<f32>(&self.model, extremes, stretch)?;
        self.stretch = stretch;
        self.scaling = scaling;
        self.write_setting();
        Ok(())
    }

    fn write_setting(&mut self) {
        let k = &mut self.coefficients;
        k.fill_constants(&self.model, &self.scaling, self.stretch);
        let setting = Setting::new(&self.model, &self.grid, k);
        self.device.write(&self.arrays.setting, 0, &[setting]);
    }

    /// Go on at `time` [s] with other steps and another density, `model` and `scaling`, in cells of
    /// height `thickness` [m]. The lattice is to be filled anew by [`record_lay`](Self::record_lay)
    /// before anything else. Returns by how much fluxes in lattice units grow, along x, y and z.
    pub fn change_scaling(
        &mut self,
        model: Model,
        scaling: Scaling,
        thickness: f64,
        time: f64,
    ) -> [f64; 3] {
        let before = self.scaling.flux_unit(self.stretch);
        self.stretch = thickness / model.spacing;
        self.model = model;
        self.scaling = scaling;
        self.clock = Clock::new(time, scaling.step);
        self.steps = 0;
        self.last = Given::fresh();
        self.write_setting();
        let after = self.scaling.flux_unit(self.stretch);
        [0, 1, 2].map(|axis| before[axis] / after[axis])
    }

    /// Record that populations are in equilibrium with what `contents` holds: flux, times
    /// `factors`, and content. Twin of `start.rs` of the CPU.
    pub fn record_lay(&self, recording: &mut Recording, coupled: &Coupled) {
        recording.dispatch(&coupled.lay, flags::groups(self.grid.cells));
    }
}
