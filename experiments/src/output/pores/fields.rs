//! The fields of `fluid.nc` between grains.

use coupling::Snapshot;
use dem::output::{Storage, Variable};

/// A quantity of each cell.
#[derive(Debug)]
pub struct Field {
    /// How the file describes it.
    pub variable: Variable,
    /// Its values, x fastest; the components of a vector together.
    pub read: fn(&Snapshot) -> Vec<f64>,
}

const fn field(
    name: &'static str,
    dims: &'static [&'static str],
    units: &'static str,
    long_name: &'static str,
    read: fn(&Snapshot) -> Vec<f64>,
) -> Field {
    let variable = Variable {
        name,
        dims,
        units,
        long_name,
        storage: Storage::Single,
    };
    Field { variable, read }
}

const CELL: &[&str] = &["z", "y", "x"];
const VECTOR: &[&str] = &["z", "y", "x", "component"];

/// All of them.
pub static FIELDS: &[Field] = &[
    field(
        "pressure",
        CELL,
        "Pa",
        "pressure of the water beyond that at rest",
        |now| now.pressure.clone(),
    ),
    field(
        "darcy_flux",
        VECTOR,
        "m s-1",
        "flux of water against the grains, per area of the bed",
        |now| now.flux.as_flattened().to_vec(),
    ),
    field(
        "porosity",
        CELL,
        "1",
        "part of the cell that water fills",
        |now| now.porosity.clone(),
    ),
    field(
        "vapour",
        CELL,
        "m3",
        "volume of vapour in the cell",
        |now| now.vapour.clone(),
    ),
];
