//! `end` of a phase: when it is over.

use super::Shear;
use super::shear::SHEAR;
use crate::scene::reader::{Range, Table};
use crate::scene::units::TIME;

/// When a phase ends: at the first of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Duration [s]; infinite where a strain is sure to come.
    pub duration: f64,
    /// Shear strain of this phase [-], without its sign.
    pub strain: Option<f64>,
    /// Kinetic energy, the wall's too, as a fraction of the elastic energy [-].
    pub at_rest: Option<f64>,
}

const END: &str = "end = { duration = \"1 s\" }";

pub(super) fn read(table: &Table, shear: Option<Shear>) -> Option<End> {
    table.missing("end", END);
    let end = table.table("end", END)?;
    let duration = end.quantity("duration", &TIME, Range::Positive);
    let strain = end.number("strain", Range::Positive, "1.0");
    let at_rest = end.number("at_rest", Range::Positive, "1e-3");
    let longest = end.quantity("max_duration", &TIME, Range::Positive);
    let max = "max_duration = \"5 s\"";
    match end.present(&["duration", "strain", "at_rest"])[..] {
        ["duration"] => {
            end.refuse(&["max_duration"], "adds nothing to duration");
            Some(End {
                duration: duration?,
                strain: None,
                at_rest: None,
            })
        }
        ["strain"] => {
            let sure = match shear {
                Some(Shear::StrainRate(v) | Shear::Velocity(v)) if v != 0.0 => true,
                Some(Shear::Stress(_)) => {
                    end.missing(
                        "max_duration",
                        &format!("{max}: a bed may not yield to a stress"),
                    );
                    false
                }
                Some(_) => {
                    end.wrong(
                        "strain",
                        "never comes at zero velocity; write a duration".into(),
                    );
                    false
                }
                None => {
                    // A shear that could not be read has been told already.
                    if !table.has("shear") {
                        let what = "never comes without shear";
                        end.wrong("strain", format!("{what}; write a duration, or {SHEAR}"));
                    }
                    false
                }
            };
            let never = if sure { Some(f64::INFINITY) } else { None };
            Some(End {
                duration: longest.or(never)?,
                strain: Some(strain?),
                at_rest: None,
            })
        }
        ["at_rest"] => {
            end.missing(
                "max_duration",
                &format!("{max}: the bed may not come to rest"),
            );
            if matches!(shear, Some(Shear::StrainRate(v) | Shear::Velocity(v)) if v != 0.0) {
                end.wrong(
                    "at_rest",
                    "never comes while a layer is driven; write a strain".into(),
                );
            }
            Some(End {
                duration: longest?,
                strain: None,
                at_rest: Some(at_rest?),
            })
        }
        [] => {
            end.wrong_here(format!(
                "says not when; write e.g. {END}, {{ strain = 1.0 }} or \
                 {{ at_rest = 1e-3, {max} }}"
            ));
            None
        }
        ref several => {
            let several = several.join(" and ");
            end.wrong_here(format!(
                "has {several}; keep one of them (and max_duration)"
            ));
            None
        }
    }
}
