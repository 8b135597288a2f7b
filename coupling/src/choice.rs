//! How often the fluid steps: from accuracy, not from stability.
//!
//! Between two fluid steps pressure follows the grains undrained, and at the fluid step the
//! grains stand still. The error grows with D_n, the lattice diffusivity of the interval: 3 % at
//! 0.25, 40 % at 13, where a drained bed looks twice as strong, without any sign of instability.
//! So n is the largest power of two, up to the renewal, with D_n ≤ 0.25. Where even one grain
//! step is too long, the fluid steps every time, several lattice steps each.
//!
//! Pores are open where pressure spreads over more than 16 cells² in a grain step, at real water and
//! grains of a millimetre over thousands, or without bounds where there is no grain: there
//! `open/mod.rs` solves for the water's momentum, every grain step, and nothing is chosen.
//!
//! A lattice step is diffusive and accurate up to D of about 0.15; `lbm` refuses longer ones, so
//! sub-steps are doubled until it agrees. At small n stiff water on a soft skeleton resonates with
//! the lattice's own waves (D_n above 0.2 while sound crosses less than 1.5 cells an interval):
//! four sub-steps at least.

use crate::{Error, Model};
use lbm::{Bed, Ends, Regime, Scaling};

/// The default bound of D_n, that above which there is a warning, and that of refusal.
const CHOSEN: f64 = 0.25;
pub(crate) const WARNED: f64 = 0.5;
pub(crate) const REFUSED: f64 = 3.0;
/// The most sub-steps of one fluid step.
const SUB_STEPS_MOST: u64 = 4096;

/// Grain steps of an interval, and lattice steps in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Steps {
    pub interval: u64,
    pub sub_steps: u64,
}

/// What the choice depends on.
pub(crate) struct Situation<'a> {
    pub model: &'a Model,
    /// Greatest diffusivity of the lattice in one grain step.
    pub diffusivity: f64,
    /// Cells that undrained sound crosses in a grain step.
    pub courant: f64,
    /// Storage over the compliance of the skeleton, φ β M.
    pub storage: f64,
    /// Grain step [s].
    pub step: f64,
}

/// The diffusivity of a grain step above which pores are open: a lattice would need dozens of
/// sub-steps.
const OPEN: f64 = 16.0;

/// Is what open pores need there? The water's mass enters the grains' motion a step late, which
/// is stable while ρ (1 - φ)/φ < ρ_s: at 1.6 times the density of water down to a porosity of 0.385.
pub(crate) fn open_is_possible(model: &Model, density: f64) -> Result<(), Error> {
    if model.cavitation.is_some() {
        return Err(Error::Invalid(
            "cavitation is not known to water in open pores (so permeable a bed is that, or one \
             with cells of clear water): leave it out, or bound the permeability from above"
                .into(),
        ));
    }
    let least = 1.6 * model.fluid.density;
    if density < least {
        return Err(Error::Invalid(format!(
            "grains of {density:.0} kg/m³ are too light for water in open pores, whose inertia \
             acts a step late: they need {least:.0} kg/m³"
        )));
    }
    Ok(())
}

impl Situation<'_> {
    /// Are the pores so open that the water's own mass holds it, and no lattice?
    pub fn is_open(&self) -> bool {
        // Infinite where there is no grain.
        self.model.interval.is_none() && self.diffusivity > OPEN
    }

    /// Choose the interval and its sub-steps for a lattice that `fits`.
    pub fn choose(
        &self,
        fluid: &mut lbm::Model,
        fits: impl Fn(&lbm::Model) -> Result<Scaling, lbm::Error>,
    ) -> Result<Steps, Error> {
        if !self.diffusivity.is_finite() {
            return Err(Error::Invalid(
                "a cell of the bed is of infinite permeability, since hardly a grain is in it: \
                 bound the permeability from above, or let the top wall down to the grains"
                    .into(),
            ));
        }
        let interval = self.interval()?;
        let most = self.diffusivity * interval as f64;
        let courant = self.courant * interval as f64;
        let resonates = self.storage < 0.3 && courant < 1.5 && most > 0.2;
        let many = interval == 1 && most > CHOSEN;
        let mut sub_steps = if resonates || many { 4 } else { 1 };
        loop {
            fluid.step = Some(interval as f64 * self.step / sub_steps as f64);
            match fits(fluid) {
                Ok(_) => break,
                Err(error) if sub_steps >= SUB_STEPS_MOST => return Err(Error::Water(error)),
                Err(_) => sub_steps *= 2,
            }
        }
        Ok(Steps {
            interval,
            sub_steps,
        })
    }

    fn interval(&self) -> Result<u64, Error> {
        let d = self.diffusivity;
        if let Some(n) = self.model.interval {
            let most = n as f64 * d;
            if n > 1 && most > REFUSED {
                let fitting = ((CHOSEN / d) as u64).max(1);
                return Err(Error::Invalid(format!(
                    "in {n} grain steps pressure diffuses over {most:.1} cells², more than \
                     {REFUSED}: such a run looks stable and invents strength; give an interval \
                     of {fitting} steps, or none"
                )));
            }
            return Ok(n);
        }
        let mut n = 1;
        while 2 * n <= self.model.renewal && 2.0 * n as f64 * d <= CHOSEN {
            n *= 2;
        }
        Ok(n)
    }
}

/// The description of the lattice: porosity and permeability come from the grains.
pub(crate) fn fluid_model(model: &Model, spacing: f64, bed: Bed) -> lbm::Model {
    let [bottom, top] = model.sides.clone();
    lbm::Model {
        cells: model.cells,
        spacing,
        fluid: model.fluid,
        bed: Some(bed),
        ends: [Ends::Periodic, Ends::Periodic, Ends::Walls(bottom, top)],
        solid: Vec::new(),
        acceleration: [0.0; 3],
        inertia: false,
        regime: Some(Regime::Diffusive),
        step: None,
        speed: 0.0,
    }
}
