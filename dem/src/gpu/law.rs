//! The contact law as the kernels read it: constants in f32, and the scene's choices as flags.
//!
//! Twin: shaders/dem/contact/types.wgsl (constants) and law.wgsl (the menu).

use crate::contact::{ContactLaw, Tension, Turning};
use crate::{Error, contact};
use bytemuck::{Pod, Zeroable};
use shaders::Flags;

/// Constants of all parts that a law can have; zero in those that it lacks.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Law {
    /// Spring and dashpot along the normal.
    pub normal: NormalPart,
    /// Tangential spring, dashpot and slider.
    pub sliding: SlidingPart,
    /// Rolling resistance.
    pub rolling: TurningPart,
    /// Twisting resistance.
    pub twisting: TurningPart,
}

/// Spring and dashpot along the normal.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct NormalPart {
    /// [N/m]
    pub stiffness: f32,
    /// [N s/m]
    pub damping: f32,
    /// Smallest force allowed [N]: zero where tension is clipped, else lower than any.
    pub floor: f32,
    unused: f32,
}

/// Tangential spring, dashpot and slider.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct SlidingPart {
    /// [N/m]
    pub stiffness: f32,
    /// [N s/m]
    pub damping: f32,
    /// μ_s
    pub friction_static: f32,
    /// μ_d
    pub friction_dynamic: f32,
}

/// Spring, dashpot and slider against rolling or twisting.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TurningPart {
    /// [N/m]
    pub stiffness: f32,
    /// [N s/m]
    pub damping: f32,
    /// μ_r or μ_w
    pub friction: f32,
    unused: f32,
}

impl Law {
    /// The constants of `law`.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a number that f32 does not hold.
    pub fn of(law: &ContactLaw) -> Result<Self, Error> {
        let zero = contact::Sliding {
            stiffness: 0.0,
            damping: 0.0,
            friction_static: 0.0,
            friction_dynamic: 0.0,
        };
        let (sliding, rolling, twisting, clipped) = match law {
            ContactLaw::Linear(law) => {
                let clipped = law.tension == Tension::Clip;
                let turns = law.rolling.is_some() || law.twisting.is_some();
                // Where only one of the two is there, the other has a spring without friction.
                let missing = turns.then_some(Turning::NONE);
                let (rolling, twisting) = (law.rolling.or(missing), law.twisting.or(missing));
                (law.sliding.unwrap_or(zero), rolling, twisting, clipped)
            }
            ContactLaw::LinearLammps(law) => {
                let sliding = contact::Sliding {
                    stiffness: law.tangential_stiffness,
                    damping: law.tangential_damping,
                    friction_static: law.friction,
                    friction_dynamic: law.friction,
                };
                (sliding, None, None, false)
            }
        };
        Ok(Self {
            normal: NormalPart {
                stiffness: number("normal stiffness", law.normal_stiffness())?,
                damping: number("normal damping", law.normal_damping())?,
                floor: if clipped { 0.0 } else { f32::MIN },
                unused: 0.0,
            },
            sliding: SlidingPart {
                stiffness: number("tangential stiffness", sliding.stiffness)?,
                damping: number("tangential damping", sliding.damping)?,
                friction_static: number("static friction", sliding.friction_static)?,
                friction_dynamic: number("dynamic friction", sliding.friction_dynamic)?,
            },
            rolling: turning("rolling", rolling)?,
            twisting: turning("twisting", twisting)?,
        })
    }
}

/// What `law` compiles in, and the sums of the ledger where the scene keeps them.
pub fn flags(law: &ContactLaw, ledger: bool) -> Flags {
    Flags::new()
        .set_if("SLIDES", law.slides())
        .set_if("TURNS", law.turns())
        .set_if("LAMMPS", matches!(law, ContactLaw::LinearLammps(_)))
        .set_if("LEDGER", ledger)
}

fn turning(name: &str, part: Option<Turning>) -> Result<TurningPart, Error> {
    let Some(part) = part else {
        return Ok(TurningPart::zeroed());
    };
    Ok(TurningPart {
        stiffness: number(&format!("{name} stiffness"), part.stiffness)?,
        damping: number(&format!("{name} damping"), part.damping)?,
        friction: number(&format!("{name} friction"), part.friction)?,
        unused: 0.0,
    })
}

/// `x` in f32, which rounds it; its range is smaller, too.
fn number(name: &str, x: f64) -> Result<f32, Error> {
    let rounded = x as f32;
    if rounded.is_normal() || x == 0.0 {
        return Ok(rounded);
    }
    Err(Error::Invalid(format!(
        "contact law: {name} {x:e} is out of the GPU's range, {:.0e} to {:.0e}: use the CPU",
        f32::MIN_POSITIVE,
        f32::MAX
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Linear;

    const SMOOTH: Linear = Linear {
        normal_stiffness: 1e9,
        normal_damping: 0.0,
        tension: Tension::Keep,
        sliding: None,
        rolling: None,
        twisting: None,
    };

    #[test]
    fn a_law_without_friction_compiles_none() {
        let flags = flags(&ContactLaw::Linear(SMOOTH), true);
        assert!(flags.has("LEDGER") && !flags.has("SLIDES") && !flags.has("TURNS"));
        let law = Law::of(&ContactLaw::Linear(SMOOTH)).unwrap();
        assert_eq!(law.sliding.stiffness, 0.0);
        assert!(law.normal.floor < -1e38);
    }

    #[test]
    fn numbers_that_f32_does_not_hold_are_refused_by_name() {
        let law = Linear {
            normal_stiffness: 1e39,
            ..SMOOTH
        };
        let wrong = Law::of(&ContactLaw::Linear(law)).unwrap_err().to_string();
        assert!(wrong.contains("normal stiffness 1e39"), "{wrong}");
    }
}
