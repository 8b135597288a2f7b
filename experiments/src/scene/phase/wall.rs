//! `top` of a phase: how the upper wall moves, or what pushes it.

use super::Context;
use crate::scene::reader::{Range, Table};
use crate::scene::units::{DAMPING, FREQUENCY, MASS, STRESS, VELOCITY};
use dem::{StressLoad, WallMotion};

const TOP: &str = "top = { normal_stress = \"100 kPa\" }, or top = \"held\"";

pub(super) fn read(table: &Table, context: &Context) -> Option<WallMotion> {
    if !table.has("top") {
        table.choose("top", "held");
        return Some(WallMotion::Held);
    }
    if table.is_word("top", "held") {
        return Some(WallMotion::Held);
    }
    let top = table.table("top", TOP)?;
    match top.present(&["velocity", "normal_stress"])[..] {
        ["velocity"] => {
            let why = "belongs to a wall that carries a normal_stress";
            top.refuse(&["amplitude", "frequency", "mass", "damping"], why);
            // Towards the grains is down.
            let v = top.quantity("velocity", &VELOCITY, Range::Any)?;
            Some(WallMotion::Velocity(v))
        }
        ["normal_stress"] => stress(&top, context).map(WallMotion::Stress),
        [] => {
            top.present(&["amplitude", "frequency", "mass", "damping"]);
            top.wrong_here(format!("says nothing of the wall's load; write e.g. {TOP}"));
            None
        }
        _ => {
            top.present(&["amplitude", "frequency", "mass", "damping"]);
            top.wrong_here("has a velocity and a normal_stress; remove one of them".into());
            None
        }
    }
}

/// Ten times the impedance √(σ ρ) of grains that a stress σ accelerates: the wall settles
/// within one rearrangement of the grains and yet does not bounce.
fn default_damping(mean: f64, context: &Context) -> f64 {
    10.0 * context.area * (mean * context.density).sqrt()
}

fn stress(top: &Table, context: &Context) -> Option<StressLoad> {
    let mean = top.quantity("normal_stress", &STRESS, Range::Positive);
    let amplitude = top.quantity("amplitude", &STRESS, Range::NotNegative);
    let frequency = top.quantity("frequency", &FREQUENCY, Range::Positive);
    let mass = top.quantity_or("mass", &MASS, Range::Positive, context.mass);
    match top.present(&["amplitude", "frequency"])[..] {
        ["amplitude"] => top.missing("frequency", "frequency = \"1 Hz\""),
        ["frequency"] => top.missing("amplitude", "amplitude = \"10 kPa\""),
        _ => {}
    }
    let Some(mean) = mean else {
        top.present(&["damping"]);
        return None;
    };
    let damping = default_damping(mean, context);
    let damping = top.quantity_or("damping", &DAMPING, Range::NotNegative, damping);
    let amplitude = amplitude.unwrap_or(0.0);
    if amplitude >= mean {
        let what = "is not below normal_stress: the wall would leave the grains";
        top.wrong("amplitude", format!("{what}; write less than {mean} Pa"));
    }
    Some(StressLoad {
        mean,
        amplitude,
        frequency: frequency.unwrap_or(0.0),
        area: context.area,
        mass,
        damping,
    })
}
