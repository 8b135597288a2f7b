//! `[end]`: how long water alone runs.

use crate::scene::reader::{Range, Table};
use crate::scene::units::TIME;
use lbm::{Ends, Model, Side, Signal};

/// When a run ends: at the first of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Duration [s].
    pub duration: f64,
    /// What is still missing of the steady flow, over the fastest flow so far [-].
    pub steady: Option<f64>,
}

const END: &str = "[end] with duration = \"1 s\", or steady = 1e-6, max_duration = \"10 s\"";

/// Read `[end]`; `model`, if it could be read, tells whether a flow can become steady.
pub fn read(root: &Table, model: Option<&Model>) -> Option<End> {
    root.missing("end", END);
    let end = root.table("end", END)?;
    let duration = end.quantity("duration", &TIME, Range::Positive);
    let longest = end.quantity("max_duration", &TIME, Range::Positive);
    let steady = end.number("steady", Range::Within(1e-13, 0.1), "1e-6");
    match end.present(&["duration", "steady"])[..] {
        ["duration"] => {
            end.refuse(&["max_duration"], "adds nothing to duration");
            Some(End {
                duration: duration?,
                steady: None,
            })
        }
        ["steady"] => {
            let example = "max_duration = \"10 s\": the flow may not become steady";
            end.missing("max_duration", example);
            if model.is_some_and(varies) {
                let what = "never comes at a side that varies for ever";
                end.wrong("steady", format!("{what}; write a duration"));
            }
            Some(End {
                duration: longest?,
                steady: Some(steady?),
            })
        }
        [] => {
            end.wrong_here(format!("says not when; write e.g. {END}"));
            None
        }
        _ => {
            let what = "contradicts steady, which goes with max_duration";
            end.wrong("duration", format!("{what}; remove one of them"));
            None
        }
    }
}

fn varies(model: &Model) -> bool {
    let sinusoidal = |side: &Side| match side {
        Side::Pressure(signal) | Side::Flux(signal) => {
            matches!(signal, Signal::Sinusoidal { amplitude, .. } if *amplitude != 0.0)
        }
        Side::NoSlip(_) | Side::FreeSlip => false,
    };
    model.ends.iter().any(|ends| match ends {
        Ends::Walls(lower, upper) => sinusoidal(lower) || sinusoidal(upper),
        Ends::Periodic => false,
    })
}
