//! How often grains and water exchange, and the fluid steps: from accuracy, not from stability alone.
//!
//! From one exchange to the next, m grain steps, forces are held. Of the waves on the lattice the
//! fastest turn by about 1.2 c/Δ, with the speed c of undrained sound; ahead of time (`trend.rs`) they are
//! stable up to a turn of 1.1 in m = 8 steps, and 1.7 in 2. Where water drains meanwhile they are
//! slower and damped. So m is 4, or the largest power of two in which sound crosses 0.6 cells at most.
//! Longer exchanges are no good to loose grains, whose drag they make weaker: stiff beds (k_n = 1e9 N/m) that
//! consolidate lose 0.3 % of their pressure by m = 4, and 2.5 % by 8.
//!
//! Between two fluid steps pressure follows the grains undrained, and at the fluid step the
//! grains stand still. The error grows with D_n, the lattice diffusivity of the interval: 3 % at
//! 0.25, 40 % at 13, where a drained bed looks twice as strong, without any sign of instability.
//! So n is the largest power of two, up to 64, with D_n ≤ 0.25. Where even the steps of one
//! exchange are too long, the fluid steps at each one, several lattice steps each: then pressure that is
//! held is one that has drained, and nothing is invented.
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
use lbm::{Bed, Ends, Fluid, Regime, Scaling};

/// The default bound of D_n, that above which there is a warning, and that of refusal.
const CHOSEN: f64 = 0.25;
pub(crate) const WARNED: f64 = 0.5;
pub(crate) const REFUSED: f64 = 3.0;
/// The most grain steps from one fluid step to the next.
const INTERVAL_MOST: u64 = 64;
/// The most sub-steps of one fluid step.
const SUB_STEPS_MOST: u64 = 4096;

/// The most grain steps from one exchange to the next, the most cells that sound crosses in them, and
/// the number of these that is refused.
const EXCHANGE_MOST: u64 = 4;
const SOUND_MOST: f64 = 0.6;
const SOUND_REFUSED: f64 = 0.9;

/// Grain steps from one exchange to the next, those of an interval, and lattice steps in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Steps {
    pub exchange: u64,
    pub interval: u64,
    pub sub_steps: u64,
}

impl Steps {
    pub const EVERY_ONE: Self = Self {
        exchange: 1,
        interval: 1,
        sub_steps: 1,
    };
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
pub const OPEN: f64 = 16.0;

/// Least density of grains in open pores [kg/m³].
pub fn open_needs_density(fluid: &Fluid) -> f64 {
    1.6 * fluid.density
}

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
    let least = open_needs_density(&model.fluid);
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
        let exchange = self.exchange()?;
        let interval = self.interval(exchange)?;
        let most = self.diffusivity * interval as f64;
        let courant = self.courant * interval as f64;
        let resonates = self.storage < 0.3 && courant < 1.5 && most > 0.2;
        let many = interval == exchange && most > CHOSEN;
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
            exchange,
            interval,
            sub_steps,
        })
    }

    fn exchange(&self) -> Result<u64, Error> {
        let given = self.model.interval;
        if let Some(m) = self.model.exchange {
            if let Some(n) = given.filter(|n| n % m != 0) {
                return Err(Error::Invalid(format!(
                    "the fluid steps at exchanges between grains and water: an interval of {n} grain \
                     steps is no multiple of an exchange of {m}"
                )));
            }
            let crossed = m as f64 * self.courant;
            if m > 1 && crossed > SOUND_REFUSED {
                let fitting = ((SOUND_MOST / self.courant) as u64).max(1);
                return Err(Error::Invalid(format!(
                    "in an exchange of {m} grain steps sound crosses {crossed:.2} cells, more than \
                     {SOUND_REFUSED}: pressure that is held so long feeds waves; give an exchange of \
                     {fitting} steps, or none"
                )));
            }
            return Ok(m);
        }
        let fits = |m: u64| {
            m <= EXCHANGE_MOST
                && m as f64 * self.courant <= SOUND_MOST
                && given.is_none_or(|n| n % m == 0)
        };
        let mut m = 1;
        while self.model.predicts && fits(2 * m) {
            m *= 2;
        }
        Ok(m)
    }

    fn interval(&self, exchange: u64) -> Result<u64, Error> {
        let d = self.diffusivity;
        if let Some(n) = self.model.interval {
            let most = n as f64 * d;
            if n > exchange && most > REFUSED {
                let fitting = ((CHOSEN / d) as u64).max(1);
                return Err(Error::Invalid(format!(
                    "in {n} grain steps pressure diffuses over {most:.1} cells², more than \
                     {REFUSED}: such a run looks stable and invents strength; give an interval \
                     of {fitting} steps, or none"
                )));
            }
            return Ok(n);
        }
        let mut n = exchange;
        while 2 * n <= INTERVAL_MOST && 2.0 * n as f64 * d <= CHOSEN {
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
