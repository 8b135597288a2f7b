//! What is at the bottom and the top wall: in `[water]` for all phases, in a phase for itself.

use crate::scene::reader::Table;
use crate::scene::units::{STRESS, VELOCITY};
use crate::scene::water::signal;
use coupling::NormalStress;
use lbm::{Side, Signal};

/// The water at the walls, and what the stress on the upper one is.
#[derive(Clone, Debug, PartialEq)]
pub struct Edges {
    /// At the bottom and at the top: tight ([`Side::FreeSlip`]), a pressure, or a flux.
    pub sides: [Side; 2],
    /// What a `normal_stress` on the top wall is.
    pub normal_stress: NormalStress,
}

impl Edges {
    /// Tight walls, total stresses.
    pub fn tight() -> Self {
        Self {
            sides: [Side::FreeSlip, Side::FreeSlip],
            normal_stress: NormalStress::Total,
        }
    }
}

const NAMES: [&str; 2] = ["bottom", "top"];
const STRESSES: [(&str, NormalStress); 2] = [
    ("total", NormalStress::Total),
    ("effective", NormalStress::Effective),
];
const PHASE: &str =
    "water = { top = \"drained\", bottom = \"tight\" }, or \"none\" for a dry phase";

/// Those of `[water]`: walls of which nothing is said are tight, and stresses total.
pub fn read(water: &Table) -> Option<Edges> {
    let sides = water.table_or_empty("sides", "[water.sides] with top = \"drained\"")?;
    for name in ["left", "right", "front", "back"] {
        sides.refuse(&[name], "is periodic where there are grains");
    }
    let read = NAMES.map(|name| {
        if !sides.has(name) {
            sides.choose(name, "tight");
            return Some(Side::FreeSlip);
        }
        side(&sides, name)
    });
    let normal_stress = water.choice_or("normal_stress", &STRESSES, NormalStress::Total);
    let [bottom, top] = read;
    Some(Edges {
        sides: [bottom?, top?],
        normal_stress,
    })
}

/// Those of a phase, which has `common` ones where it says nothing; none: it is dry. None in the
/// outer: they are wrong.
pub fn of_phase(phase: &Table, common: Option<&Edges>) -> Option<Option<Edges>> {
    let Some(common) = common else {
        phase.refuse(&["water"], "has a meaning only in a scene with [water]");
        return Some(None);
    };
    if !phase.has("water") {
        return Some(Some(common.clone()));
    }
    if phase.is_word("water", "none") {
        return Some(None);
    }
    let table = phase.table("water", PHASE)?;
    let mut edges = common.clone();
    let mut whole = true;
    for (name, own) in NAMES.into_iter().zip(&mut edges.sides) {
        if table.has(name) {
            match side(&table, name) {
                Some(side) => *own = side,
                None => whole = false,
            }
        }
    }
    if table.has("normal_stress") {
        match table.choice("normal_stress", &STRESSES) {
            Some(stress) => edges.normal_stress = stress,
            None => whole = false,
        }
    }
    whole.then_some(Some(edges))
}

fn side(table: &Table, name: &'static str) -> Option<Side> {
    if !table.is_table(name) {
        let words = [("tight", false), ("drained", true)];
        return Some(match table.choice(name, &words)? {
            true => Side::Pressure(Signal::Steady(0.0)),
            false => Side::FreeSlip,
        });
    }
    let example = format!("{name} = {{ pressure = \"1 kPa\" }}");
    let side = table.table(name, &example)?;
    if side.has("flux") {
        side.refuse(&["pressure"], "contradicts flux");
        return signal::read(&side, "flux", &VELOCITY).map(Side::Flux);
    }
    side.missing(
        "pressure",
        "pressure = \"1 kPa\", beyond that of the water at rest, or flux = \"1 mm/s\" into the bed",
    );
    signal::read(&side, "pressure", &STRESS).map(Side::Pressure)
}
