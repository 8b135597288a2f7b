//! `[[phase]]`: the laboratory protocol.

use super::bounds;
use super::contact::{friction, with_friction};
use super::layers::Room;
use super::reader::{Range, Table};
use super::units::{DAMPING, FREQUENCY, LENGTH, MASS, RATE, STRESS, TIME, VELOCITY};
use super::water::pores::{self, Edges};
use dem::{ContactLaw, StressLoad, WallMotion};
use glam::DVec3;

/// One phase of the protocol.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// How the top wall moves.
    pub top: WallMotion,
    /// What moves the upper layer; none: all grains are free.
    pub shear: Option<Shear>,
    /// Thickness of the held and of the driven layer [m].
    pub layer: f64,
    /// How grains push each other.
    pub law: ContactLaw,
    /// Acceleration of gravity [m/s²].
    pub gravity: DVec3,
    /// The water at its walls; none: the grains are dry.
    pub water: Option<Edges>,
    /// What becomes of the motion at its start.
    pub start: Motion,
    /// When it ends.
    pub end: End,
}

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

/// The motion of grains and walls when a phase starts. Springs of contacts are always kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// All velocities and spins are set to zero.
    Rest,
    /// They go on as they are.
    Keep,
    /// Set to rest, then velocities along x that rise in a straight line from the held to
    /// the driven layer.
    Profile,
}

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

/// What phases need to know of the rest of the scene.
#[derive(Clone, Copy, Debug)]
pub struct Context {
    /// Area of the box [m²].
    pub area: f64,
    /// Mass of all grains [kg].
    pub mass: f64,
    /// Density of the grains [kg/m³].
    pub density: f64,
    /// Largest diameter [m].
    pub diameter: f64,
    /// Room for layers.
    pub room: Room,
    /// The scene's contact law.
    pub law: ContactLaw,
    /// The scene's gravity [m/s²].
    pub gravity: DVec3,
}

const PHASE: &str = "[[phase]] with name = \"settle\", end = { duration = \"1 s\" }";
const TOP: &str = "top = { normal_stress = \"100 kPa\" }, or top = \"held\"";
const SHEAR: &str = "shear = { strain_rate = \"0.25 1/s\" }";
const END: &str = "end = { duration = \"1 s\" }";

/// Read all phases; `water`: what is at the walls where a phase says nothing, if there is water.
pub fn read(root: &Table, context: &Context, water: Option<&Edges>) -> Vec<Phase> {
    root.missing("phase", PHASE);
    if !root.has("phase") {
        return Vec::new();
    }
    let tables = root.tables("phase", PHASE);
    let mut names: Vec<String> = Vec::new();
    let mut phases = Vec::new();
    let mut settled = false;
    for table in &tables {
        let name = name(table, &names);
        names.extend(name.clone());
        let phase = one(table, name.unwrap_or_default(), context, water, settled);
        // What could not be read may have settled the bed or not.
        settled |= phase.as_ref().is_some_and(settles);
        phases.extend(phase);
    }
    if tables.is_empty() && root.is_list("phase") {
        root.wrong("phase", format!("is empty; write e.g. {PHASE}"));
    }
    phases
}

fn name(table: &Table, taken: &[String]) -> Option<String> {
    table.missing("name", "name = \"shear\"");
    let name = table.text("name")?;
    let plain = |c: char| c.is_alphanumeric() || "-_".contains(c);
    if name.is_empty() || !name.chars().all(plain) {
        let what = "must be of letters, digits, - and _";
        table.wrong(
            "name",
            format!("is {name:?}, {what}; write e.g. name = \"shear\""),
        );
    } else if taken.iter().any(|other| other == name) {
        table.wrong(
            "name",
            format!("{name:?} is taken by an earlier phase; choose another"),
        );
    }
    Some(name.to_string())
}

/// Does a bed lie or stand under a load at the end of `phase`?
fn settles(phase: &Phase) -> bool {
    phase.gravity.z != 0.0 || matches!(phase.top, WallMotion::Stress(_))
}

fn one(
    table: &Table,
    name: String,
    context: &Context,
    water: Option<&Edges>,
    settled: bool,
) -> Option<Phase> {
    let top = top(table, context);
    let shear = shear(table);
    let layer = if table.has("shear") {
        table.quantity_or("layer", &LENGTH, Range::Positive, context.diameter)
    } else {
        table.refuse(&["layer"], "has a meaning only where there is shear");
        context.diameter
    };
    let law = law(table, context);
    let gravity = bounds::gravity(table).unwrap_or(context.gravity);
    let end = end(table, shear);
    let water = pores::of_phase(table, water);
    if let (
        Some(Some(_)),
        Some(End {
            at_rest: Some(_), ..
        }),
    ) = (&water, end)
    {
        let what = "tells that grains rest, not that the water has drained";
        let message = format!("{what}; write a duration, or water = \"none\" for a dry phase");
        table.wrong("end", message);
    }
    if matches!(water, Some(Some(_))) && (gravity.x, gravity.y) != (0.0, 0.0) {
        let what = "must be along z under water, whose pressure counts from that at rest";
        let message = format!("{what}; leave tilt out, or write water = \"none\"");
        table.wrong(if table.has("tilt") { "tilt" } else { "gravity" }, message);
    }
    if table.has("shear")
        && let Some(why) = context.room.refuses(layer, settled)
    {
        table.wrong("layer", why);
    }
    let shear = if table.has("shear") {
        Some(shear?)
    } else {
        None
    };
    let by_velocity = matches!(shear, Some(Shear::StrainRate(_) | Shear::Velocity(_)));
    let default = if by_velocity {
        Motion::Profile
    } else {
        Motion::Rest
    };
    let start = start(table, default);
    if start == Motion::Profile && !by_velocity {
        let what = "is \"profile\", which needs a shear by strain_rate or velocity";
        table.wrong("start", format!("{what}; write \"rest\" or \"keep\""));
    }
    Some(Phase {
        name,
        top: top?,
        shear,
        layer,
        law,
        gravity,
        water: water?,
        start,
        end: end?,
    })
}

fn start(table: &Table, default: Motion) -> Motion {
    let words = [
        ("rest", Motion::Rest),
        ("keep", Motion::Keep),
        ("profile", Motion::Profile),
    ];
    table.choice_or("start", &words, default)
}

fn law(table: &Table, context: &Context) -> ContactLaw {
    let friction = if !table.has("friction") {
        return context.law;
    } else if table.is_word("friction", "none") {
        None
    } else {
        let Some(friction) = friction(table) else {
            return context.law;
        };
        Some(friction)
    };
    with_friction(context.law, friction).unwrap_or_else(|what| {
        table.wrong("friction", what);
        context.law
    })
}

fn top(table: &Table, context: &Context) -> Option<WallMotion> {
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

fn shear(table: &Table) -> Option<Shear> {
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

fn end(table: &Table, shear: Option<Shear>) -> Option<End> {
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
