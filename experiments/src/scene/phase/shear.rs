//! `shear` of a phase: what moves the upper layer.

use crate::scene::reader::{Range, Table};
use crate::scene::units::{RATE, STRESS, VELOCITY};

/// What moves the upper layer along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shear {
    /// A velocity of this times the bed's height at the start of the phase [1/s].
    StrainRate(f64),
    /// This velocity [m/s].
    Velocity(f64),
    /// This shear stress [Pa].
    Stress(f64),
}

/// How a shear is written.
pub(super) const SHEAR: &str = "shear = { strain_rate = \"0.25 1/s\" }";

pub(super) fn read(table: &Table) -> Option<Shear> {
    if !table.has("shear") {
        return None;
    }
    let shear = table.table("shear", SHEAR)?;
    match shear.present(&["strain_rate", "velocity", "shear_stress"])[..] {
        ["strain_rate"] => {
            let rate = shear.quantity("strain_rate", &RATE, Range::Any)?;
            Some(Shear::StrainRate(rate))
        }
        ["velocity"] => {
            let v = shear.quantity("velocity", &VELOCITY, Range::Any)?;
            Some(Shear::Velocity(v))
        }
        ["shear_stress"] => {
            let tau = shear.quantity("shear_stress", &STRESS, Range::Any)?;
            Some(Shear::Stress(tau))
        }
        [] => {
            let what = "needs strain_rate, velocity or shear_stress";
            shear.wrong_here(format!("{what}; write e.g. {SHEAR}"));
            None
        }
        ref several => {
            let several = several.join(" and ");
            shear.wrong_here(format!("has {several}; keep one of them"));
            None
        }
    }
}
