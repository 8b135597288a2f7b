//! `[grains]`: drawn at random, or from a bed or a state in a file.

use super::reader::{Range, Table};
use super::units::{DENSITY, LENGTH};
use crate::start::{LOOSE_FRACTION, RadiusLaw, Source};

const GRAINS: &str = "[grains] with count = 1000, radius = \"10 mm\", density = \"2600 kg/m^3\"";
const RADIUS: &str = "radius = { law = \"uniform\", min = \"9 mm\", max = \"11 mm\" }";

/// Radii from those of clay to those of boulders, and far beyond both [m].
const SIZES: Range = Range::Within(1e-8, 1e2);
/// Densities from that of foam to some thousand times that of rock [kg/m³]: slow runs may scale
/// it for longer steps.
const DENSITIES: Range = Range::Within(10.0, 1e7);

/// Solid fractions of a loose start: from a grain in a tower to where places are hard to find.
const FRACTIONS: Range = Range::Within(1e-6, 0.33);

/// Read `[grains]` and the file that it names.
pub fn read(root: &Table) -> Option<Source> {
    root.missing("grains", GRAINS);
    let table = root.table("grains", GRAINS)?;
    match table.present(&["state", "bed"])[..] {
        [] => random(&table),
        ["state"] => {
            let why = "stands in the state that is read";
            table.refuse(&["count", "radius", "density", "solid_fraction"], why);
            let path = table.path("state")?;
            let saved = crate::output::state::load(&path)
                .map_err(|error| table.wrong("state", format!("cannot be read: {error:#}")))
                .ok()?;
            if saved.state.grains.is_empty() {
                table.wrong("state", "holds no grain".into());
                return None;
            }
            Some(Source::State(Box::new(saved)))
        }
        ["bed"] => {
            let why = "stands in the bed that is read";
            table.refuse(&["count", "radius", "solid_fraction"], why);
            let density = density(&table);
            let path = table.path("bed")?;
            let bed = crate::bed::read(&path)
                .map_err(|error| table.wrong("bed", format!("cannot be read: {error:#}")))
                .ok()?;
            if bed.radius.is_empty() {
                table.wrong("bed", "holds no grain".into());
                return None;
            }
            Some(Source::Bed {
                bed,
                density: density?,
            })
        }
        _ => {
            table.refuse(
                &["count", "radius", "density", "solid_fraction"],
                "stands in the file that is read",
            );
            table.wrong("bed", "contradicts state; remove one of them".into());
            None
        }
    }
}

fn density(table: &Table) -> Option<f64> {
    table.missing("density", "density = \"2600 kg/m^3\"");
    table.quantity("density", &DENSITY, DENSITIES)
}

/// Beyond what memory holds anywhere, and below the 134 million rows that the neighbour
/// lists of `dem` can number.
const MOST: i64 = 100_000_000;

fn random(table: &Table) -> Option<Source> {
    let density = density(table);
    let law = radius(table);
    let stated = table.integer("count", 1, "1000");
    // A list without a count is taken grain by grain.
    let of_list = match &law {
        Some(RadiusLaw::Listed { values, .. }) => Some(values.len() as i64),
        Some(_) => None,
        // What could not be read may have been a list.
        None => Some(1),
    };
    if of_list.is_none() {
        table.missing("count", "count = 1000");
    }
    let count = if table.has("count") {
        stated?
    } else {
        table.choose("count", of_list?);
        of_list?
    };
    let fraction = if table.has("solid_fraction") {
        table.number("solid_fraction", FRACTIONS, "0.1")?
    } else {
        table.choose("solid_fraction", LOOSE_FRACTION);
        LOOSE_FRACTION
    };
    if count > MOST {
        table.wrong(
            "count",
            format!("is {count}; at most {MOST} grains fit one run"),
        );
        return None;
    }
    Some(Source::Loose {
        count: count as usize,
        law: law?,
        density: density?,
        fraction,
    })
}

#[derive(Clone, Copy)]
enum Law {
    Single,
    Uniform,
    LogNormal,
    Listed,
}

fn radius(table: &Table) -> Option<RadiusLaw> {
    table.missing("radius", RADIUS);
    if !table.is_table("radius") {
        let radius = table.quantity("radius", &LENGTH, SIZES);
        return radius.map(RadiusLaw::Single);
    }
    let table = table.table("radius", RADIUS)?;
    let laws = [
        ("single", Law::Single),
        ("uniform", Law::Uniform),
        ("log-normal", Law::LogNormal),
        ("listed", Law::Listed),
    ];
    if !table.has("law") {
        table.missing(
            "law",
            "law = \"uniform\", or \"single\", \"log-normal\", \"listed\"",
        );
        // Which other keys may stand here depends on the law.
        table.present(&[
            "value", "min", "max", "median", "spread", "values", "shares",
        ]);
        return None;
    }
    let law = table.choice("law", &laws);
    let Some(law) = law else {
        table.present(&[
            "value", "min", "max", "median", "spread", "values", "shares",
        ]);
        return None;
    };
    let length = |key, example: &str| {
        table.missing(key, example);
        table.quantity(key, &LENGTH, SIZES)
    };
    match law {
        Law::Single => length("value", "value = \"10 mm\"").map(RadiusLaw::Single),
        Law::Uniform => {
            let min = length("min", "min = \"9 mm\"");
            let max = length("max", "max = \"11 mm\"");
            let (min, max) = (min?, max?);
            if min > max {
                table.wrong("min", "is above max; exchange them".into());
                return None;
            }
            Some(RadiusLaw::Uniform { min, max })
        }
        Law::LogNormal => {
            let median = length("median", "median = \"10 mm\"");
            table.missing("spread", "spread = 0.3 (standard deviation of ln R)");
            let spread = table.number("spread", Range::Above(0.0, 10.0), "0.3");
            let (Some(median), Some(spread)) = (median, spread) else {
                table.present(&["min", "max"]);
                return None;
            };
            // Two standard deviations hold 95 % of the grains.
            let bound = |key, sign: f64| {
                let default = median * (sign * 2.0 * spread).exp();
                table.quantity_or(key, &LENGTH, SIZES, default)
            };
            let (min, max) = (bound("min", -1.0), bound("max", 1.0));
            // About 0.4 ln(max / min) / spread of the draws fall between the two.
            if (max / min).ln() < 0.01 * spread {
                let what = "is so large that hardly a radius falls between min and max";
                table.wrong("spread", format!("{what}; write law = \"uniform\""));
                return None;
            }
            if min >= median || max <= median {
                let what = "is not between min and max; write e.g. min = median / 3";
                table.wrong("median", what.into());
                return None;
            }
            Some(RadiusLaw::LogNormal {
                median,
                spread,
                min,
                max,
            })
        }
        Law::Listed => {
            table.missing("values", "values = [\"5 mm\", \"10 mm\"]");
            let values = table.quantities("values", &LENGTH, SIZES);
            let example = "shares = [0.7, 0.3], the shares of the number of grains";
            let shares = table.numbers("shares", Range::NotNegative, example);
            let values = values?;
            if values.is_empty() {
                table.wrong(
                    "values",
                    "is empty; write e.g. [\"5 mm\", \"10 mm\"]".into(),
                );
                return None;
            }
            let shares = shares.unwrap_or_else(|| {
                let equal = vec![1.0; values.len()];
                table.choose("shares", toml_edit::Array::from_iter(equal.clone()));
                equal
            });
            if shares.len() != values.len() {
                let (n, m) = (shares.len(), values.len());
                table.wrong(
                    "shares",
                    format!("has {n} entries for {m} values; write {m}"),
                );
                return None;
            }
            if shares.iter().sum::<f64>() <= 0.0 {
                table.wrong("shares", "are all zero; write e.g. [0.7, 0.3]".into());
                return None;
            }
            Some(RadiusLaw::Listed { values, shares })
        }
    }
}
