//! `[water.bed]`: porosity and permeability, the same everywhere or by layers.

use super::Lattice;
use crate::scene::reader::{Range, Table};
use crate::scene::units::{LENGTH, PER_LENGTH, PERMEABILITY};
use lbm::{Bed, Field};

const BED: &str = "[water.bed] with porosity = 0.4, permeability = \"1e-13 m^2\"";
const LAYER: &str =
    "[[water.bed.layer]] with top = \"0.5 m\", porosity = 0.4, permeability = \"1e-13 m^2\"";

/// What the water sees of one kind of bed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ground {
    porosity: f64,
    /// [m²]
    permeability: f64,
    /// [1/m]; zero: Darcy alone.
    forchheimer: f64,
}

/// Kozeny-Carman's permeability of grains of diameter `d` [m]: k = d² φ³ / (180 (1 - φ)²).
/// Source: Carman (1937), Trans. Inst. Chem. Eng. 15, 150.
pub fn kozeny_carman(porosity: f64, d: f64) -> f64 {
    d * d * porosity.powi(3) / (180.0 * (1.0 - porosity).powi(2))
}

/// Forchheimer's coefficient after Ergun [1/m]: b = 1.75 (1 - φ) / (φ³ d).
/// Source: Ergun (1952), Chem. Eng. Prog. 48, 89.
fn ergun(porosity: f64, d: f64) -> f64 {
    1.75 * (1.0 - porosity) / (porosity.powi(3) * d)
}

/// Read the bed of a box of such a `height` [m]; none: free water, or what could not be read and
/// is noted. The `lattice` may be wrong for its part.
pub fn read(water: &Table, lattice: Option<Lattice>, height: f64) -> Option<Bed> {
    if !water.has("bed") {
        return None;
    }
    let table = water.table("bed", BED)?;
    if !table.has("layer") {
        let ground = ground(&table)?;
        let drag = Some(Field::Uniform(ground.forchheimer));
        return Some(Bed {
            porosity: Field::Uniform(ground.porosity),
            permeability: Field::Uniform(ground.permeability),
            forchheimer: drag.filter(|_| ground.forchheimer > 0.0),
        });
    }
    let why = "stands in each layer";
    table.refuse(
        &["porosity", "permeability", "forchheimer", "grain_size"],
        why,
    );
    layers(&table, lattice, height)
}

/// Layers from the bottom to the top; a cell belongs to the one in which its middle lies.
fn layers(table: &Table, lattice: Option<Lattice>, height: f64) -> Option<Bed> {
    let layers = table.tables("layer", LAYER);
    if layers.is_empty() {
        table.wrong("layer", format!("is empty; write e.g. {LAYER}"));
    }
    let mut read: Vec<(f64, Option<Ground>)> = Vec::new();
    for (k, layer) in layers.iter().enumerate() {
        let last = k + 1 == layers.len();
        let below = read.last().map_or(0.0, |(top, _)| *top);
        if !last {
            layer.missing("top", "top = \"0.5 m\", the height of its upper end");
        }
        let top = layer.quantity("top", &LENGTH, Range::Positive);
        let top = top.unwrap_or(if last { height } else { below });
        if layer.has("top") && top <= below {
            layer.wrong(
                "top",
                format!("is {top} m, not above {below} m, where it begins"),
            );
        }
        if last && top < height * (1.0 - 1e-9) {
            let what = format!("leaves the box without a bed from {top} m to {height} m");
            layer.wrong("top", format!("{what}; leave it out in the last layer"));
        }
        let middle = |z: usize, spacing: f64| (z as f64 + 0.5) * spacing;
        let holds = |lattice: Lattice| {
            let mut middles = (0..lattice.cells[2]).map(|z| middle(z, lattice.spacing));
            middles.any(|middle| below <= middle && middle < top)
        };
        if top > below && lattice.is_some_and(|lattice| !holds(lattice)) {
            let what = format!("from {below:.4e} m to {top:.4e} m holds the middle of no cell");
            let remedy = "make it thicker, water.spacing smaller, or remove it";
            layer.wrong_here(format!("{what}; {remedy}"));
        }
        read.push((top, ground(layer)));
    }
    let lattice = lattice?;
    let grounds: Vec<Ground> = (0..lattice.cells[2])
        .map(|z| {
            let middle = (z as f64 + 0.5) * lattice.spacing;
            let layer = read.iter().find(|(top, _)| middle < *top).or(read.last());
            layer.and_then(|(_, ground)| *ground)
        })
        .collect::<Option<_>>()?;
    let field = |of: fn(&Ground) -> f64| {
        let plane = lattice.cells[0] * lattice.cells[1];
        let each = grounds.iter().map(of);
        Field::Cells(each.flat_map(|x| std::iter::repeat_n(x, plane)).collect())
    };
    let drag = grounds.iter().any(|ground| ground.forchheimer > 0.0);
    Some(Bed {
        porosity: field(|ground| ground.porosity),
        permeability: field(|ground| ground.permeability),
        forchheimer: drag.then(|| field(|ground| ground.forchheimer)),
    })
}

fn ground(table: &Table) -> Option<Ground> {
    table.missing("porosity", "porosity = 0.4");
    table.missing(
        "permeability",
        "permeability = \"1e-13 m^2\", or \"kozeny-carman\" with grain_size = \"1 mm\", or \
         \"infinite\"",
    );
    let porosity = table.number("porosity", Range::Above(0.0, 1.0), "0.4");
    let by_size = table.is_word("permeability", "kozeny-carman");
    let ergun_drag = table.is_word("forchheimer", "ergun");
    let size = table.quantity("grain_size", &LENGTH, Range::Positive);
    if by_size || ergun_drag {
        table.missing(
            "grain_size",
            "grain_size = \"1 mm\", the diameter of the grains",
        );
    } else {
        let why = "is of use only with permeability = \"kozeny-carman\" or forchheimer = \"ergun\"";
        table.refuse(&["grain_size"], why);
    }
    let of_grains = |law: fn(f64, f64) -> f64| porosity.zip(size).map(|(p, d)| law(p, d));
    let permeability = if by_size {
        if porosity == Some(1.0) {
            table.wrong("porosity", "is 1: there are no grains; write less".into());
            return None;
        }
        of_grains(kozeny_carman)
    } else if table.is_word("permeability", "infinite") {
        Some(f64::INFINITY)
    } else {
        table.quantity("permeability", &PERMEABILITY, Range::Within(1e-30, 1.0))
    };
    if !table.has("forchheimer") {
        table.choose("forchheimer", "none");
    }
    let forchheimer = if ergun_drag {
        of_grains(ergun)
    } else if !table.has("forchheimer") || table.is_word("forchheimer", "none") {
        Some(0.0)
    } else {
        table.quantity("forchheimer", &PER_LENGTH, Range::NotNegative)
    };
    Some(Ground {
        porosity: porosity?,
        permeability: permeability?,
        forchheimer: forchheimer?,
    })
}
