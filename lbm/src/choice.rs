//! Which step and which density: the fastest that are right.
//!
//! - incompressible: S = 3 whatever β, ρ₀ = ρ; Δt such that flow is slow against waves;
//! - acoustic: ρ₀ = ρ/φ (of the mean porosity; ρ where there is free water), Δt = Δx/c with
//!   S = 3 in the cells of the least storage;
//! - diffusive: Δt from D, and ρ₀ free: as small as S ≥ 3 allows, but large enough for
//!   σ ≤ 10, above which pressure is smoothed at the scale of cells whatever the permeability.

use crate::lanes::Real;
use crate::limits::{DAMPING_LEAST, length, shortest_time};
use crate::scaling::STORAGE_LEAST;
use crate::{Error, Model, Regime, Scaling};

/// The drag σ per step above which τ⁺ would not follow it any more (`scaling.rs`), and pressure
/// would be smoothed at the scale of cells: twice as fast at σ = 100 and four cells a wave.
const DRAG_MOST: f64 = 10.0;
/// Room for cells that get lower while running.
const STORAGE_ROOM: f64 = 1.25;
/// The diffusivity, in cells² per step.
const DIFFUSIVITY: f64 = 0.1;
/// Steps per period of what the sides do.
const STEPS_PER_PERIOD: f64 = 100.0;
/// The Mach number.
const MACH: f64 = 0.05;
/// By how much the choice stays away from what is refused.
const MARGIN: f64 = 1.2;

/// Extremes of the bed: all that a lattice must know of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Least and greatest porosity.
    pub porosity: [f64; 2],
    /// Mean porosity.
    pub mean_porosity: f64,
    /// Least and greatest permeability of the cells of the bed [m²].
    pub permeability: [f64; 2],
    /// The same of k/φ.
    pub mobility: [f64; 2],
    /// Are there cells without grains?
    pub free_cells: bool,
}

impl Extremes {
    /// Those of `model`.
    pub fn of(model: &Model) -> Self {
        let mut found = Self {
            porosity: [f64::INFINITY, 0.0],
            mean_porosity: 1.0,
            permeability: [f64::INFINITY, 0.0],
            mobility: [f64::INFINITY, 0.0],
            free_cells: false,
        };
        let Some(bed) = &model.bed else {
            found.porosity = [1.0; 2];
            found.free_cells = true;
            return found;
        };
        let widen = |range: &mut [f64; 2], x: f64| {
            *range = [range[0].min(x), range[1].max(x)];
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for cell in 0..model.cells.iter().product() {
            if model.solid.get(cell) == Some(&true) {
                continue;
            }
            let (porosity, permeability) = (bed.porosity.at(cell), bed.permeability.at(cell));
            widen(&mut found.porosity, porosity);
            (sum, count) = (sum + porosity, count + 1.0);
            if permeability.is_finite() {
                widen(&mut found.permeability, permeability);
                widen(&mut found.mobility, permeability / porosity);
            } else {
                found.free_cells = true;
            }
        }
        found.mean_porosity = sum / count;
        found
    }
}

impl Scaling {
    /// Choose what `model` leaves open, for numbers of type `T` and cells of height
    /// `thickness` [m].
    ///
    /// # Errors
    /// [`Error::Invalid`] for what cannot be stable or accurate, with the remedy.
    pub fn choose<T: Real>(model: &Model, thickness: f64) -> Result<Self, Error> {
        crate::check::check(model)?;
        Self::choose_for::<T>(model, &Extremes::of(model), thickness)
    }

    /// The same for a bed of these extremes, whatever fields `model` has: for beds that live where
    /// the host does not see them.
    ///
    /// # Errors
    /// As [`choose`](Self::choose).
    pub fn choose_for<T: Real>(
        model: &Model,
        extremes: &Extremes,
        thickness: f64,
    ) -> Result<Self, Error> {
        let regime = model.regime.unwrap_or_else(|| regime(model, extremes));
        let (dx, fluid) = (model.spacing, model.fluid);
        let stretch = thickness / dx;
        let flat = stretch.min(1.0);
        let viscosity = fluid.viscosity / fluid.density;
        let fastest = shortest_time(model) / STEPS_PER_PERIOD;

        let (step, density) = match regime {
            Regime::Incompressible => {
                let by_speed = MACH / 3f64.sqrt() * dx / model.speed;
                let by_viscosity = dx * dx / (6.0 * viscosity);
                let step = by_speed.min(by_viscosity).min(fastest);
                (model.step.unwrap_or(step), fluid.density)
            }
            Regime::Acoustic => {
                let density = match extremes.free_cells {
                    true => fluid.density,
                    false => fluid.density / extremes.mean_porosity,
                };
                let storage = extremes.porosity[0] * fluid.compressibility * density;
                let step = dx * (storage * flat / STORAGE_LEAST).sqrt();
                (model.step.unwrap_or(step.min(fastest)), density)
            }
            Regime::Diffusive => {
                let [_, mobility] = extremes.mobility;
                let diffusivity = mobility / (fluid.viscosity * fluid.compressibility);
                // Where permeability varies much, drag is weak in the most permeable cells, and
                // only smaller steps keep waves across the box down.
                let drag = DRAG_MOST * extremes.permeability[0] / extremes.permeability[1];
                let reach = length(model) / (MARGIN * DAMPING_LEAST * std::f64::consts::PI);
                let chosen = DIFFUSIVITY.min(drag * reach * reach);
                let step = chosen * dx * dx / diffusivity * flat * flat;
                let step = model.step.unwrap_or(step.min(fastest));
                let least = STORAGE_ROOM * STORAGE_LEAST / flat * (step / dx).powi(2)
                    / (extremes.porosity[0] * fluid.compressibility);
                let drag = fluid.viscosity * step / extremes.permeability[0];
                (step, least.max(drag / DRAG_MOST))
            }
        };

        let scaling = Self::of(model, extremes, regime, step, density);
        scaling.judge::<T>(model, stretch)?;
        Ok(scaling)
    }

    /// The same lattice for another bed.
    ///
    /// # Errors
    /// [`Error::Invalid`] where it would not be stable or accurate.
    pub(crate) fn with_bed<T: Real>(&self, model: &Model, stretch: f64) -> Result<Self, Error> {
        self.with_extremes::<T>(model, &Extremes::of(model), stretch)
    }

    /// The same for a bed of these extremes.
    ///
    /// # Errors
    /// As above.
    pub(crate) fn with_extremes<T: Real>(
        &self,
        model: &Model,
        extremes: &Extremes,
        stretch: f64,
    ) -> Result<Self, Error> {
        let new = Self::of(model, extremes, self.regime, self.step, self.density);
        new.judge::<T>(model, stretch)?;
        Ok(new)
    }
}

/// The regime for numbers that leave it open.
fn regime(model: &Model, extremes: &Extremes) -> Regime {
    if model.bed.is_none() {
        return Regime::Incompressible;
    }
    if extremes.free_cells {
        return Regime::Acoustic;
    }
    // Drag per step of a lattice that carries sound: where it is strong, pressure spreads over
    // a cell by diffusion, more slowly than by sound.
    let fluid = model.fluid;
    let density = fluid.density / extremes.mean_porosity;
    let storage = extremes.porosity[0] * fluid.compressibility * density;
    let step = model.spacing * (storage / STORAGE_LEAST).sqrt();
    let drag = fluid.viscosity * step / (density * extremes.permeability[1]);
    match drag >= 1.0 {
        true => Regime::Diffusive,
        false => Regime::Acoustic,
    }
}
