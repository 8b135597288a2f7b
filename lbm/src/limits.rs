//! What cannot be stable or accurate, and is refused with the remedy.

use crate::check::refuse;
use crate::lanes::Real;
use crate::scaling::STORAGE_LEAST;
use crate::{Ends, Error, Model, Regime, Scaling, Side};

/// The greatest diffusivity, in cells² per step, that is not a wave.
const DIFFUSIVITY_MOST: f64 = 0.5;
/// The fewest steps per period of what the sides do.
const STEPS_PER_PERIOD: f64 = 20.0;
/// Drag over what is critical for the longest wave in the box; at 6 the error is 0.4 %.
pub(crate) const DAMPING_LEAST: f64 = 5.0;
/// The greatest Mach number.
const MACH_MOST: f64 = 0.3;
/// The greatest τ⁺ - 1/2: beyond, viscous stress takes steps to build up.
const TAU_MOST: f64 = 3.0;
/// The greatest speed times spacing over kinematic viscosity: a driven cube at 21 is stable, at
/// 31 it is not.
const REYNOLDS_MOST: f64 = 25.0;

impl Scaling {
    /// Refuse what cannot be stable or accurate.
    pub(crate) fn judge<T: Real>(&self, model: &Model, stretch: f64) -> Result<(), Error> {
        let step = self.step;
        let fastest = shortest_time(model) / STEPS_PER_PERIOD;
        if step > fastest {
            return refuse(format!(
                "step {step:.3e} s: a period of what the sides of the box do takes less than \
                 {} steps; give a step of at most {fastest:.3e} s, or a finer spacing",
                STEPS_PER_PERIOD
            ));
        }
        self.judge_stretch(stretch)?;
        if self.mach > MACH_MOST {
            return refuse(format!(
                "Mach number {:.2} of the lattice at {} m/s is above {MACH_MOST}; give a step of at most \
                 {:.3e} s",
                self.mach,
                model.speed,
                step * MACH_MOST / self.mach
            ));
        }
        let tau = self.tau_even - 0.5;
        if tau > TAU_MOST {
            return refuse(format!(
                "relaxation time {:.2} steps is above {}; give a step of at most {:.3e} s",
                self.tau_even,
                TAU_MOST + 0.5,
                step * TAU_MOST / tau
            ));
        }
        if model.inertia && self.regime == Regime::Incompressible {
            let reynolds = model.speed * self.spacing * self.true_density / self.viscosity;
            if reynolds > REYNOLDS_MOST {
                return refuse(format!(
                    "Reynolds number {reynolds:.0} of a cell is above {REYNOLDS_MOST}; give a \
                     spacing of at most {:.2e} m",
                    self.spacing * REYNOLDS_MOST / reynolds
                ));
            }
        }
        if self.regime == Regime::Incompressible {
            return Ok(());
        }
        // Pressure that drains from a box of L cells changes by (π/2L)² D of itself per step. At
        // D = ε L² a column is right to one per cent; below, rounding stops it.
        let floor = T::EPSILON * length(model).powi(2);
        let least = self.diffusivity[0];
        if least < floor {
            return refuse(format!(
                "pressure diffuses over {least:.1e} cells² a step, so little that rounding stops it \
                 (the least is {floor:.1e}); give a longer step, for which the diffusive regime \
                 has room, or a lattice of f64"
            ));
        }
        if self.regime == Regime::Acoustic {
            return Ok(());
        }
        let flat = stretch.min(1.0);
        let most = self.diffusivity[1] / (flat * flat);
        if most > DIFFUSIVITY_MOST {
            return refuse(format!(
                "pressure diffuses over {most:.2} cells² a step, more than {}; give a step of at \
                 most {:.3e} s",
                DIFFUSIVITY_MOST,
                step * DIFFUSIVITY_MOST / most
            ));
        }
        let waves = self.drag[0] * self.storage[0].sqrt() / std::f64::consts::PI;
        let damping = waves * length(model);
        if damping < DAMPING_LEAST {
            return refuse(format!(
                "drag {:.1e} a step damps waves across the box only {damping:.1} times as much as \
                 critical, less than {DAMPING_LEAST}: the run would not be diffusive. Ask for the \
                 acoustic regime, or for a shorter step",
                self.drag[0]
            ));
        }
        Ok(())
    }

    /// Refuse cells of `stretch` times the spacing in height that are too flat for this lattice.
    pub(crate) fn judge_stretch(&self, stretch: f64) -> Result<(), Error> {
        let storage = self.storage[0] * stretch.min(1.0);
        if storage < STORAGE_LEAST * (1.0 - 1e-9) {
            return refuse(format!(
                "storage {storage:.2} of cells of {stretch:.3} spacings in height is below \
                 {STORAGE_LEAST}; {}",
                match self.regime {
                    Regime::Diffusive => "begin anew with cells of this height".to_owned(),
                    _ => format!(
                        "give a step of at most {:.3e} s",
                        self.step * (storage / STORAGE_LEAST).sqrt()
                    ),
                }
            ));
        }
        Ok(())
    }
}

/// The longest side of the box in cells; a wave is no shorter than four of them.
pub(crate) fn length(model: &Model) -> f64 {
    model.cells.into_iter().max().unwrap_or(1).max(4) as f64
}

/// The shortest time in which a side of the box varies [s].
pub(crate) fn shortest_time(model: &Model) -> f64 {
    let mut shortest = f64::INFINITY;
    for ends in &model.ends {
        if let Ends::Walls(lower, upper) = ends {
            for side in [lower, upper] {
                if let Side::Pressure(signal) | Side::Flux(signal) = side {
                    shortest = shortest.min(signal.shortest_time());
                }
            }
        }
    }
    shortest
}
