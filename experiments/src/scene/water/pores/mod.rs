//! `[water]` beside `[grains]`: the water in the pores of a bed.

mod cells;
mod describe;
mod edges;
mod law;
mod plausible;

pub use describe::{DILATION, Suction};
pub use edges::{Edges, of_phase};
pub use plausible::{check, warnings};

use super::liquid;
use crate::scene::reader::{Range, Table};
use crate::scene::units::{MODULUS, STRESS};
use coupling::{Cavitation, Model, Resistance};
use lbm::Fluid;

/// Water between grains as a scene describes it, checked, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Pores {
    /// Number of cells along x, y and, from the bottom to the top wall, along z.
    pub cells: [usize; 3],
    /// Length of a cell along x and y [m].
    pub spacing: f64,
    /// How many cells the weights of a grain reach.
    pub reach: Reach,
    /// What fills the pores.
    pub fluid: Fluid,
    /// What resists its flow.
    pub resistance: Resistance,
    /// Where the water breaks; none: it bears any tension.
    pub cavitation: Option<Cavitation>,
    /// Grain steps from one exchange to the next; none: chosen.
    pub exchange: Option<u64>,
    /// Grain steps from one fluid step to the next; none: chosen from accuracy.
    pub interval: Option<u64>,
    /// Where the stiffness of the skeleton comes from.
    pub stiffness: Stiffness,
    /// Load of a grain, over the mean one, at which it counts half.
    pub loose: f64,
    /// What is at the walls where a phase says nothing.
    pub edges: Edges,
}

/// How many cells the weights of a grain reach along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Three, for cells of about two diameters.
    Three,
    /// Five, for cells of about one.
    Five,
}

impl Reach {
    /// Its number.
    pub fn count(self) -> usize {
        match self {
            Self::Three => 3,
            Self::Five => 5,
        }
    }
}

/// Where the stiffness of the skeleton comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffness {
    /// It is not known.
    Unknown,
    /// The scene says it [Pa].
    Given(f64),
    /// It is measured on the dry bed when water comes to it.
    Measured,
}

/// What the water needs to know of the grains.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    /// Lengths of the box along x and y [m].
    pub size: [f64; 2],
    /// Is it periodic there?
    pub periodic: [bool; 2],
    /// Mean diameter [m].
    pub diameter: f64,
    /// Height from wall to wall when the water comes, as far as it can be known [m].
    pub height: f64,
    /// Cells of the water that the grains come with, if they do.
    pub cells: Option<[usize; 3]>,
}

const WATER: &str = "[water] with bed.permeability = \"1e-12 m^2\"";

/// `[water]` of which the walls have been read: phases speak of them, and how high the cells are
/// follows from the phases.
pub struct Begun<'a> {
    table: Table<'a>,
    edges: Option<Edges>,
}

impl<'a> Begun<'a> {
    /// Begin; none: the scene has no such table.
    pub fn of(root: &Table<'a>) -> Option<Self> {
        let table = root.table("water", WATER)?;
        let edges = edges::read(&table);
        Some(Self { table, edges })
    }

    /// What is at the walls where a phase says nothing; tight ones where that is wrong.
    pub fn edges(&self) -> Edges {
        self.edges.clone().unwrap_or_else(Edges::tight)
    }

    /// Read the rest; none: something is wrong. Without `around`, which could not be read, only
    /// words are checked.
    pub fn finish(self, around: Option<&Around>) -> Option<Pores> {
        rest(&self.table, self.edges, around)
    }
}

fn rest(table: &Table, edges: Option<Edges>, around: Option<&Around>) -> Option<Pores> {
    let only_alone = "belongs to water alone; between grains the bed tells";
    table.refuse(
        &[
            "precision",
            "inertia",
            "solid",
            "start",
            "acceleration",
            "regime",
            "step",
            "speed",
        ],
        only_alone,
    );
    let fluid = liquid(table);
    let lattice = cells::read(table, around);
    let resistance = law::read(table, around.map_or(1.0, |around| around.diameter));
    let cavitation = cavitation(table);
    let exchange = steps(table, "exchange", "2");
    let interval = steps(table, "interval", "64");
    let stiffness = stiffness(table);
    let loose = loose(table);
    let (cells, spacing, reach) = lattice?;
    Some(Pores {
        cells,
        spacing,
        reach,
        fluid,
        resistance: resistance?,
        cavitation: cavitation?,
        exchange: exchange?,
        interval: interval?,
        stiffness: stiffness?,
        loose: loose?,
        edges: edges?,
    })
}

/// Where the water breaks, as the pressure beyond that at rest; none in the outer: it is wrong.
fn cavitation(table: &Table) -> Option<Option<Cavitation>> {
    if !table.has("cavitation") {
        table.choose("cavitation", "none");
        return Some(None);
    }
    if table.is_word("cavitation", "none") {
        return Some(None);
    }
    let pressure = table.quantity("cavitation", &STRESS, Range::Any)?;
    if pressure >= 0.0 {
        let what = "is not below zero: it is vapour pressure less that of the water at rest";
        table.wrong("cavitation", format!("{what}; write e.g. \"-100 kPa\""));
        return None;
    }
    Some(Some(Cavitation { pressure }))
}

/// Grain steps, or none where they are to be chosen.
fn steps(table: &Table, key: &'static str, example: &'static str) -> Option<Option<u64>> {
    if !table.has(key) {
        table.choose(key, "auto");
        return Some(None);
    }
    if table.is_word(key, "auto") {
        return Some(None);
    }
    let steps = table.integer(key, 1, example);
    steps.map(|steps| Some(steps as u64))
}

fn stiffness(table: &Table) -> Option<Stiffness> {
    if !table.has("stiffness") {
        table.choose("stiffness", "measured");
        return Some(Stiffness::Measured);
    }
    if table.is_word("stiffness", "measured") {
        return Some(Stiffness::Measured);
    }
    if table.is_word("stiffness", "unknown") {
        return Some(Stiffness::Unknown);
    }
    let modulus = table.quantity("stiffness", &MODULUS, Range::Positive);
    modulus.map(Stiffness::Given)
}

/// For soft and stiff grains: `coupling/studies/loose.csv`.
const LOOSE: f64 = 1.0;

fn loose(table: &Table) -> Option<f64> {
    if !table.has("loose") {
        table.choose("loose", LOOSE);
        return Some(LOOSE);
    }
    table.number("loose", Range::Positive, "1")
}

impl Pores {
    /// The description for a phase with `edges`, where the skeleton is so stiff [Pa].
    pub fn model(&self, edges: &Edges, stiffness: Option<f64>) -> Model {
        Model {
            sides: edges.sides.clone(),
            normal_stress: edges.normal_stress,
            cavitation: self.cavitation,
            exchange: self.exchange,
            interval: self.interval,
            stiffness,
            loose: self.loose,
            ..Model::new(self.cells, self.fluid, self.resistance)
        }
    }

    /// Permeability to a slow flow at a porosity [m²].
    pub fn permeability(&self, porosity: f64) -> f64 {
        self.fluid.viscosity / self.resistance.at(&self.fluid, porosity, 0.0)
    }
}
