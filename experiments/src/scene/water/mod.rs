//! `[water]`: the liquid, its lattice, what bounds it and what it flows through: water alone
//! ([`alone`]) and, beside `[grains]`, in the pores of a bed ([`pores`]).

pub mod alone;
mod bed;
mod describe;
mod end;
mod output;
pub mod pores;
mod settle;
mod sides;
mod signal;
mod solid;
mod start;

pub use alone::WaterScene;
pub use bed::kozeny_carman;
pub use end::End;
pub use pores::Pores;
pub use sides::{AXES, NAMES};

use super::reader::{Range, Reader, Table};
use super::units::{ACCELERATION, COMPRESSIBILITY, DENSITY, LENGTH, TIME, VELOCITY, VISCOSITY};
use lbm::{Bed, Ends, Fluid, Model, Regime, Scaling, Side, Signal, State};

/// Cells, x fastest, then y, then z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Their number along each axis.
    pub cells: [usize; 3],
    /// Their length [m].
    pub spacing: f64,
}

impl Lattice {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Lengths of the box [m].
    pub fn size(&self) -> [f64; 3] {
        self.cells.map(|n| n as f64 * self.spacing)
    }

    /// Its height [m].
    pub fn height(&self) -> f64 {
        self.size()[2]
    }

    /// Middle of a cell [m].
    pub fn middle(&self, cell: usize) -> [f64; 3] {
        let [nx, ny, _] = self.cells;
        [cell % nx, cell / nx % ny, cell / nx / ny].map(|k| (k as f64 + 0.5) * self.spacing)
    }
}

/// The numbers of the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Single precision: half the memory and time, and all that a GPU has.
    F32,
    /// Double precision.
    F64,
}

/// Water as a scene describes it, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// The description, with step and regime as they were chosen.
    pub model: Model,
    /// The numbers of the lattice.
    pub precision: Precision,
    /// Where it starts.
    pub start: State,
    /// Does it start from a state of a lattice with another step or density?
    pub other_lattice: bool,
    /// What follows for the lattice.
    pub scaling: Scaling,
}

impl Water {
    /// The cells.
    pub fn lattice(&self) -> Lattice {
        Lattice {
            cells: self.model.cells,
            spacing: self.model.spacing,
        }
    }

    /// Greatest diffusivity of pressure [m²/s]; infinite in free water, and where nothing resists.
    pub fn diffusivity(&self) -> f64 {
        let bed = self.model.bed.as_ref();
        if bed.is_some_and(|bed| bed.permeability.range()[1].is_infinite()) {
            return f64::INFINITY;
        }
        self.scaling.diffusivity[1] * self.model.spacing.powi(2) / self.scaling.step
    }
}

const WATER: &str = "[water] with spacing = \"0.1 mm\"";

/// Read `[water]` in a box of `size` [m] with walls at the ends of some axes.
pub fn read(root: &Table, reader: &Reader, size: [f64; 3], walled: [bool; 3]) -> Option<Water> {
    let table = root.table("water", WATER)?;
    let fluid = liquid(&table);
    let lattice = lattice(&table, reader, size);
    let precision = table.choice_or(
        "precision",
        &[("f64", Precision::F64), ("f32", Precision::F32)],
        Precision::F64,
    );
    let inertia = table.flag_or("inertia", false);
    let bed = bed::read(&table, lattice, size[2]);
    let ends = sides::read(&table, walled, table.has("bed"));
    // What stands in the cells can be read only once these are known.
    table.present(&["solid", "start"]);
    let solid = lattice.and_then(|cells| solid::read(&table, &cells, walled.map(|w| !w)));
    let start = lattice.and_then(|cells| start::read(&table, &cells, fluid, inertia));
    let acceleration = acceleration(&table);
    let regime = table.choice(
        "regime",
        &[
            ("incompressible", Regime::Incompressible),
            ("acoustic", Regime::Acoustic),
            ("diffusive", Regime::Diffusive),
        ],
    );
    let mut step = table.quantity("step", &TIME, Range::Positive);
    if let Some([saved, _]) = start.as_ref().and_then(|start| start.lattice)
        && !table.has("step")
    {
        // To the bit.
        table.choose("step", TIME.write(saved));
        step = Some(saved);
    }
    let fastest = match (&ends, &start) {
        (Some(ends), Some(start)) => fastest(ends).max(start.fastest),
        _ => 0.0,
    };
    let speed = table.quantity_or("speed", &VELOCITY, Range::NotNegative, fastest);
    let (lattice, ends, start) = (lattice?, ends?, start?);
    let (bed, acceleration) = (
        if table.has("bed") { Some(bed?) } else { None },
        acceleration?,
    );
    refuse_sloshing(&table, &ends, bed.as_ref(), acceleration);
    let model = Model {
        cells: lattice.cells,
        spacing: lattice.spacing,
        fluid,
        bed,
        ends,
        solid: solid?,
        acceleration,
        inertia,
        regime,
        step,
        speed,
    };
    settle::settle(&table, reader, model, precision, start)
}

/// Free water that a body force pushes against a side through which none passes would slosh for as
/// long as viscosity takes to calm it.
fn refuse_sloshing(table: &Table, ends: &[Ends; 3], bed: Option<&Bed>, acceleration: [f64; 3]) {
    if bed.is_some_and(|bed| bed.permeability.range()[1].is_finite()) {
        return;
    }
    let open = |side: &Side| matches!(side, Side::Pressure(_) | Side::Flux(_));
    for (axis, ends) in ends.iter().enumerate() {
        if let Ends::Walls(lower, upper) = ends
            && acceleration[axis] != 0.0
            && !(open(lower) && open(upper))
        {
            let along = AXES[axis];
            let what = format!(
                "pushes free water along {along} against a side through which none passes: it makes \
                 pressure, no flow, and the water sloshes; leave {along} out, since pressure counts \
                 from that at rest"
            );
            table.wrong("acceleration", what);
        }
    }
}

/// What a scene calls a regime.
pub fn word(regime: Regime) -> &'static str {
    match regime {
        Regime::Incompressible => "incompressible",
        Regime::Acoustic => "acoustic",
        Regime::Diffusive => "diffusive",
    }
}

/// From water thinned a billion times, for slow runs in a short time, to pitch [Pa s]; ice does not
/// flow through pores.
const FLOWS: Range = Range::Within(1e-12, 1e9);

fn liquid(table: &Table) -> Fluid {
    let example = "liquid = { density = \"1000 kg/m^3\", viscosity = \"1 mPa s\" }";
    let cold = Fluid::COLD_WATER;
    let Some(liquid) = table.table_or_empty("liquid", example) else {
        return cold;
    };
    let above = |key, kind, default| liquid.quantity_or(key, kind, Range::Positive, default);
    let viscosity = liquid.quantity_or("viscosity", &VISCOSITY, FLOWS, cold.viscosity);
    Fluid {
        density: above("density", &DENSITY, cold.density),
        viscosity,
        compressibility: above("compressibility", &COMPRESSIBILITY, cold.compressibility),
    }
}

/// Cells beyond what memory holds anywhere.
const MOST: f64 = 1e10;
/// How far a box may be from whole cells.
const WHOLE: f64 = 1e-6;

fn lattice(table: &Table, reader: &Reader, size: [f64; 3]) -> Option<Lattice> {
    table.missing("spacing", "spacing = \"0.1 mm\", the length of a cell");
    let spacing = table.quantity("spacing", &LENGTH, Range::Positive)?;
    let cells = size.map(|length| (length / spacing).round());
    for axis in 0..3 {
        let (length, whole) = (size[axis], cells[axis] * spacing);
        if cells[axis] < 1.0 || (whole / length - 1.0).abs() > WHOLE {
            let (along, least) = (AXES[axis], cells[axis].max(1.0));
            let message = format!(
                "is {length} m along {along}, not a whole number of cells of {spacing} m; write \
                 {:?}, or water.spacing = {:?}",
                LENGTH.write(least * spacing),
                LENGTH.write(length / least)
            );
            reader.wrong(&["box", "size"], message);
            return None;
        }
    }
    let count: f64 = cells.iter().product();
    if count > MOST {
        let what = format!("cuts the box into {count:.1e} cells, more than {MOST:.0e}");
        table.wrong("spacing", format!("{what}; write more"));
        return None;
    }
    Some(Lattice {
        cells: cells.map(|n| n as usize),
        spacing,
    })
}

fn acceleration(table: &Table) -> Option<[f64; 3]> {
    if !table.has("acceleration") {
        table.choose("acceleration", toml_edit::Array::from_iter(["0 m/s^2"; 3]));
        return Some([0.0; 3]);
    }
    let values = table.quantities("acceleration", &ACCELERATION, Range::Any)?;
    let count = values.len();
    let what = "write three (x, y, z), the body force over the density";
    let wrong = |_| table.wrong("acceleration", format!("has {count} components; {what}"));
    values.try_into().map_err(wrong).ok()
}

/// The highest speed that the sides prescribe [m/s].
fn fastest(ends: &[Ends; 3]) -> f64 {
    let of = |side: &Side| match side {
        Side::NoSlip(u) => u.iter().map(|u| u * u).sum::<f64>().sqrt(),
        Side::Flux(signal) => highest(signal),
        Side::FreeSlip | Side::Pressure(_) => 0.0,
    };
    let each = ends.iter().map(|ends| match ends {
        Ends::Walls(lower, upper) => of(lower).max(of(upper)),
        Ends::Periodic => 0.0,
    });
    each.fold(0.0, f64::max)
}

/// The greatest absolute value of a signal.
pub fn highest(signal: &Signal) -> f64 {
    match signal {
        Signal::Steady(value) => value.abs(),
        Signal::Sinusoidal {
            mean, amplitude, ..
        } => mean.abs() + amplitude.abs(),
        Signal::Table(points) => points
            .iter()
            .map(|point| point[1].abs())
            .fold(0.0, f64::max),
    }
}

/// The part of a cell that is pore, from 0 in a solid to 1 in free water.
pub fn porosity(model: &Model, cell: usize) -> f64 {
    if model.solid.get(cell) == Some(&true) {
        return 0.0;
    }
    model
        .bed
        .as_ref()
        .map_or(1.0, |bed: &Bed| bed.porosity.at(cell))
}
