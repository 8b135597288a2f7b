//! Between SI and lattice units; nowhere else.
//!
//! A lattice unit of length is the spacing Δx, one of time the step Δt, one of density ρ₀.
//! With c = Δx/Δt, a pressure p is P = p/(ρ₀ c²), a flux q is j = q/c, and
//!
//! - storage S = φ β ρ₀ c²: content of a cell at unit pressure,
//! - drag σ = μ Δt / (ρ₀ k), so that Darcy's law is j = -∇P/σ,
//! - diffusivity D = 1/(S σ) = k Δt / (μ φ β Δx²).
//!
//! ρ₀ is the inertia of the water on the lattice, and waves of pressure run at 1/√S cells per
//! step, at most 1/√3. How Δt and ρ₀ are chosen is in `choice.rs`.
//!
//! Cells of height hΔx hold h S, and have drag σ/h along x, y and σ h along z: fluxes count per
//! cell face, so j_x = h q_x/c and j_z = q_z/c. Their inertia is off by the same factors.

use crate::choice::Extremes;
use crate::{Model, Regime};
use std::fmt;

/// The numbers of a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// What the lattice gets right.
    pub regime: Regime,
    /// Length of a cell along x and y [m].
    pub spacing: f64,
    /// Time step [s].
    pub step: f64,
    /// Density of the lattice [kg/m³]: the inertia of the water.
    pub density: f64,
    /// Density of the water [kg/m³].
    pub true_density: f64,
    /// Viscosity of the water [Pa s].
    pub viscosity: f64,
    /// Compressibility of the water [1/Pa].
    pub compressibility: f64,
    /// Relaxation time τ⁺ of the even populations, in steps.
    pub tau_even: f64,
    /// Relaxation time τ⁻ of the odd ones.
    pub tau_odd: f64,
    /// Least and greatest drag σ.
    pub drag: [f64; 2],
    /// Least and greatest storage S.
    pub storage: [f64; 2],
    /// Least and greatest diffusivity D; infinite in free water.
    pub diffusivity: [f64; 2],
    /// The expected speed over that of the lattice's waves.
    pub mach: f64,
}

/// Storage below which populations at rest would have to be negative.
pub(crate) const STORAGE_LEAST: f64 = 3.0;
/// τ⁺ - 1/2 over σ where the viscosity is that of the lattice. A wave of pressure with κ radians
/// a cell then decays by 1/S over (σ/2)/(1 - cos κ) + (τ⁺ - 1/2) - σ/4 a step, which is κ²/Sσ to
/// fourth order; twice or half of it leaves 5 % at eight cells a wave. The reach of a shear,
/// √((τ⁺ - 1/2)/3σ), is a quarter of a cell.
/// Proof: lbm/tests/verification/porous.rs
const TAU_OVER_DRAG: f64 = 1.0 / 6.0;
/// Bounds of the same. At the lower one a wave over 64 cells that drag leaves alone loses 4e-4 of
/// its height in a period.
const TAU_RANGE: [f64; 2] = [0.001, 2.0];
/// The least τ⁺ - 1/2 where free water carries sound: its own viscosity would be as good as none.
const TAU_FREE: f64 = 0.02;
/// The part of a difference in pressure between cells that may pass while the bed still counts
/// as undrained.
const UNDRAINED: f64 = 0.01;

impl Scaling {
    /// The numbers of a lattice of this step [s] and density [kg/m³].
    pub(crate) fn of(
        model: &Model,
        extremes: &Extremes,
        regime: Regime,
        step: f64,
        density: f64,
    ) -> Self {
        let (dx, fluid) = (model.spacing, model.fluid);
        let speed = dx / step;
        let storage = match regime {
            Regime::Incompressible => [STORAGE_LEAST; 2],
            _ => extremes
                .porosity
                .map(|phi| phi * fluid.compressibility * density * speed * speed),
        };
        let drag = |k: f64| fluid.viscosity * step / (density * k);
        let [low, high] = extremes.permeability;
        let (drag, diffusivity) = match (&model.bed, regime) {
            (None, _) => ([0.0; 2], [f64::INFINITY; 2]),
            (_, Regime::Incompressible) => {
                let drag = [drag(high), drag(low)];
                (drag, [drag[1], drag[0]].map(|s| 1.0 / (STORAGE_LEAST * s)))
            }
            _ => {
                let unit = step / (fluid.viscosity * fluid.compressibility * dx * dx);
                ([drag(high), drag(low)], extremes.mobility.map(|m| m * unit))
            }
        };
        let drag = if extremes.free_cells {
            [0.0, drag[1]]
        } else {
            drag
        };
        let true_tau = 3.0 * fluid.viscosity * step / (density * dx * dx);
        let lattice_tau = (TAU_OVER_DRAG * drag[0]).clamp(TAU_RANGE[0], TAU_RANGE[1]);
        let (tau, magic) = match regime {
            Regime::Incompressible => (true_tau, 3.0 / 16.0),
            Regime::Acoustic if extremes.free_cells => (true_tau.max(TAU_FREE), 3.0 / 16.0),
            _ => (lattice_tau, 0.25),
        };
        Self {
            regime,
            spacing: dx,
            step,
            density,
            true_density: fluid.density,
            viscosity: fluid.viscosity,
            compressibility: fluid.compressibility,
            tau_even: 0.5 + tau,
            tau_odd: 0.5 + magic / tau,
            drag,
            storage,
            diffusivity,
            mach: model.speed / speed * storage[0].sqrt(),
        }
    }

    /// Speed of a cell per step [m/s].
    fn speed(&self) -> f64 {
        self.spacing / self.step
    }

    /// A lattice pressure of one [Pa].
    pub fn pressure_unit(&self) -> f64 {
        self.density * self.speed().powi(2)
    }

    /// Lattice fluxes of one along x, y and z in cells `stretch` spacings high [m/s].
    pub(crate) fn flux_unit(&self, stretch: f64) -> [f64; 3] {
        let speed = self.speed();
        [speed / stretch, speed / stretch, speed]
    }

    /// Body force on the lattice for an acceleration [m/s²].
    pub(crate) fn force(&self, acceleration: [f64; 3], stretch: f64) -> [f64; 3] {
        let unit = self.pressure_unit() / self.spacing / self.true_density;
        let [x, y, z] = acceleration.map(|a| a / unit);
        [x, y, stretch * z]
    }

    /// Storage S of cubic cells with this porosity.
    pub(crate) fn storage(&self, porosity: f64) -> f64 {
        match self.regime {
            Regime::Incompressible => STORAGE_LEAST,
            _ => porosity * self.compressibility * self.pressure_unit(),
        }
    }

    /// Drag σ of cubic cells with this permeability [m²].
    pub(crate) fn drag(&self, permeability: f64) -> f64 {
        self.viscosity * self.step / (self.density * permeability)
    }

    /// Forchheimer's drag at unit flux for his coefficient [1/m].
    pub(crate) fn forchheimer(&self, coefficient: f64) -> f64 {
        coefficient * self.spacing * self.true_density / self.density
    }

    /// Content gained per step for a source [1/s].
    pub(crate) fn source(&self, rate: f64, stretch: f64) -> f64 {
        rate * self.step * stretch
    }

    /// Does so little pressure diffuse in `duration` [s] that each cell keeps its water? Then
    /// nothing can be learnt from solving for the flow: the bed is undrained, and pressure follows
    /// from what each cell alone is squeezed by.
    ///
    /// Between two cells the part D t/Δx² of their difference in pressure passes; up to one per
    /// cent, the error that rounding may make too, it counts as none. Free water and
    /// incompressible flow are never undrained.
    pub fn is_undrained(&self, duration: f64) -> bool {
        // Without drag nothing diffuses, and water flows all the same.
        let slow = |diffusivity: f64| diffusivity * duration < UNDRAINED * self.step;
        self.regime != Regime::Incompressible && self.drag[0] > 0.0 && slow(self.diffusivity[1])
    }

    /// Kinematic viscosity of the lattice [m²/s]; more than that of the water where sheared
    /// water is not resolved.
    pub fn lattice_viscosity(&self) -> f64 {
        (self.tau_even - 0.5) / 3.0 * self.spacing.powi(2) / self.step
    }
}

impl fmt::Display for Scaling {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let regime = match self.regime {
            Regime::Incompressible => "incompressible",
            Regime::Acoustic => "acoustic",
            Regime::Diffusive => "diffusive",
        };
        writeln!(out, "water: {regime}, step {:.3e} s", self.step)?;
        writeln!(
            out,
            "  relaxation times {:.4} (even) and {:.4} (odd) steps, viscosity {:.3e} m²/s",
            self.tau_even,
            self.tau_odd,
            self.lattice_viscosity()
        )?;
        writeln!(
            out,
            "  drag {:.2e} to {:.2e}, storage {:.3} to {:.3}, diffusivity {:.2e} to {:.2e} cells² \
             a step",
            self.drag[0],
            self.drag[1],
            self.storage[0],
            self.storage[1],
            self.diffusivity[0],
            self.diffusivity[1]
        )?;
        write!(out, "  Mach number of the lattice {:.2e}", self.mach)
    }
}
