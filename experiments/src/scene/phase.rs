//! `[[phase]]`: the laboratory protocol.

mod end;
mod shear;
mod wall;

pub use end::End;
pub use shear::Shear;

use super::bounds;
use super::contact::{friction, with_friction};
use super::layers::Room;
use super::reader::{Range, Table};
use super::units::LENGTH;
use super::water::pores::{self, Edges};
use dem::{ContactLaw, WallMotion};
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
    let top = wall::read(table, context);
    let shear = shear::read(table);
    let layer = if table.has("shear") {
        table.quantity_or("layer", &LENGTH, Range::Positive, context.diameter)
    } else {
        table.refuse(&["layer"], "has a meaning only where there is shear");
        context.diameter
    };
    let law = law(table, context);
    let gravity = bounds::gravity(table).unwrap_or(context.gravity);
    let end = end::read(table, shear);
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
