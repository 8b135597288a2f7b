//! The fields of `fluid.nc`.

use crate::scene::water::{Water, porosity};
use dem::output::{Storage, Variable};
use lbm::Snapshot;

/// A quantity of each cell.
#[derive(Debug)]
pub struct Field {
    /// How the file describes it.
    pub variable: Variable,
    /// Does it never change? Then it has no time.
    pub still: bool,
    /// Is it written where a scene says nothing?
    pub chosen: fn(&Water) -> bool,
    /// Why it makes no sense for this water; none: it does.
    pub refused: fn(&Water) -> Option<&'static str>,
    /// Its values, x fastest; the components of a vector together.
    pub read: fn(&Water, &Snapshot) -> Vec<f64>,
}

const CELL: &[&str] = &["z", "y", "x"];
const VECTOR: &[&str] = &["z", "y", "x", "component"];

const fn variable(
    name: &'static str,
    dims: &'static [&'static str],
    units: &'static str,
    long_name: &'static str,
) -> Variable {
    Variable {
        name,
        dims,
        units,
        long_name,
        storage: Storage::Single,
    }
}

/// All of them. Solid cells have no pressure and no flow.
pub static FIELDS: &[Field] = &[
    Field {
        variable: variable(
            "pressure",
            CELL,
            "Pa",
            "pressure of the water beyond that at rest",
        ),
        still: false,
        chosen: |_| true,
        refused: |_| None,
        read: |water, now| {
            let each = now.pressure.iter().enumerate();
            each.map(|(cell, &p)| if fluid(water, cell) { p } else { f64::NAN })
                .collect()
        },
    },
    Field {
        variable: variable("velocity", VECTOR, "m s-1", "velocity of the water"),
        still: false,
        chosen: |_| false,
        refused: |water| {
            let what = "what flows in a bed is \"darcy_flux\"";
            water.model.bed.as_ref().map(|_| what)
        },
        read: flux,
    },
    Field {
        variable: variable(
            "darcy_flux",
            VECTOR,
            "m s-1",
            "flux of water per area of the bed",
        ),
        still: false,
        chosen: |_| false,
        refused: |water| match water.model.bed {
            Some(_) => None,
            None => Some("free water has a \"velocity\""),
        },
        read: flux,
    },
    Field {
        variable: variable("porosity", CELL, "1", "part of the cell that water fills"),
        still: true,
        chosen: |water| water.model.bed.is_some() || !water.model.solid.is_empty(),
        refused: |_| None,
        read: |water, _| {
            (0..water.lattice().count())
                .map(|c| porosity(&water.model, c))
                .collect()
        },
    },
];

fn fluid(water: &Water, cell: usize) -> bool {
    water.model.solid.get(cell) != Some(&true)
}

fn flux(water: &Water, now: &Snapshot) -> Vec<f64> {
    let each = now.flux.iter().enumerate();
    let each = each.map(|(cell, &q)| if fluid(water, cell) { q } else { [f64::NAN; 3] });
    each.collect::<Vec<_>>().into_flattened()
}
