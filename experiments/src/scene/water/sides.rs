//! `[water.sides]`: what is at the six sides of the box, by the names of its walls.

use super::signal;
use crate::scene::reader::{Range, Table};
use crate::scene::units::{STRESS, VELOCITY};
use lbm::{Ends, Side};

/// Names of the lower and the upper side of each axis, as the walls of grains have them.
pub const NAMES: [[&str; 2]; 3] = [["left", "right"], ["front", "back"], ["bottom", "top"]];
/// The axes.
pub const AXES: [&str; 3] = ["x", "y", "z"];

const SIDES: &str = "[water.sides] with top = \"no-slip\"";

/// Read the sides. Axes that are not `walled` are periodic; walls of which nothing is said are
/// tight: water sticks to them, but not to those of a bed.
pub fn read(water: &Table, walled: [bool; 3], bed: bool) -> Option<[Ends; 3]> {
    let sides = water.table_or_empty("sides", SIDES)?;
    let default = if bed {
        Side::FreeSlip
    } else {
        Side::NoSlip([0.0; 3])
    };
    let mut ends = [(); 3].map(|()| Some(Ends::Periodic));
    for axis in 0..3 {
        let names = NAMES[axis];
        if !walled[axis] {
            let along = AXES[axis];
            let what = format!("is periodic; write box.sides.{along} = \"walls\", or");
            for name in sides.present(&names) {
                sides.wrong(name, format!("{what} remove it"));
            }
            continue;
        }
        let [lower, upper] = names.map(|name| one(&sides, name, axis, &default));
        ends[axis] = lower
            .zip(upper)
            .map(|(lower, upper)| Ends::Walls(lower, upper));
    }
    let fluxes = ends.iter().flatten().filter(|ends| has_flux(ends)).count();
    if fluxes > 1 {
        let what = "prescribe a flux at the ends of more than one axis, whose edges meet";
        sides.wrong_here(format!("{what}; prescribe a pressure at the others"));
        return None;
    }
    let [x, y, z] = ends;
    Some([x?, y?, z?])
}

fn has_flux(ends: &Ends) -> bool {
    match ends {
        Ends::Walls(lower, upper) => [lower, upper]
            .iter()
            .any(|side| matches!(side, Side::Flux(_))),
        Ends::Periodic => false,
    }
}

fn one(sides: &Table, name: &'static str, axis: usize, default: &Side) -> Option<Side> {
    if !sides.has(name) {
        let word = match default {
            Side::FreeSlip => "free-slip",
            _ => "no-slip",
        };
        sides.choose(name, word);
        return Some(default.clone());
    }
    if !sides.is_table(name) {
        let words = [("no-slip", false), ("free-slip", true)];
        return Some(match sides.choice(name, &words)? {
            true => Side::FreeSlip,
            false => Side::NoSlip([0.0; 3]),
        });
    }
    let example = format!("{name} = {{ pressure = \"1 kPa\" }}");
    let side = sides.table(name, &example)?;
    match side.present(&["velocity", "pressure", "flux"])[..] {
        ["velocity"] => {
            let velocity = vector(&side, "velocity")?;
            if velocity[axis] != 0.0 {
                let along = AXES[axis];
                let what = format!("leads away from the side, along {along}");
                side.wrong(
                    "velocity",
                    format!("{what}; a side moves only along itself"),
                );
                return None;
            }
            Some(Side::NoSlip(velocity))
        }
        ["pressure"] => signal::read(&side, "pressure", &STRESS).map(Side::Pressure),
        ["flux"] => signal::read(&side, "flux", &VELOCITY).map(Side::Flux),
        [] => {
            let what = "says neither velocity, pressure nor flux";
            side.wrong_here(format!("{what}; write e.g. {example}"));
            None
        }
        ref several => {
            let several = several.join(" and ");
            side.wrong_here(format!("has {several}; keep one of them"));
            None
        }
    }
}

/// Three components along x, y and z of a velocity [m/s].
pub fn vector(table: &Table, key: &'static str) -> Option<[f64; 3]> {
    let values = table.quantities(key, &VELOCITY, Range::Any)?;
    let count = values.len();
    let wrong = |_| {
        table.wrong(
            key,
            format!("has {count} components; write three (x, y, z)"),
        )
    };
    values.try_into().map_err(wrong).ok()
}
