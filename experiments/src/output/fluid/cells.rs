//! `fluid.nc`: every cell at some instants.

use super::{Field, WaterFrame};
use crate::output::OutputFile;
use crate::output::netcdf::{define, describe, label, put};
use crate::output::rows::Rows;
use crate::scene::water::{AXES, Water};
use anyhow::Result;
use dem::output::{Storage, Variable};
use ndarray::{Array, Array1, ArrayD};
use netcdf::FileMut;

/// Rows of time kept together; each row of cells is cut into chunks of at most so many layers
/// that it can be read in part.
const CHUNK: usize = 256;
/// Numbers of a chunk, about 4 MiB.
const NUMBERS: usize = 1 << 20;

const PLACES: [Variable; 3] = [
    place("x", &["x"], "middle of the cell along x"),
    place("y", &["y"], "middle of the cell along y"),
    place("z", &["z"], "height of the middle of the cell"),
];
const BOUNDS: [Variable; 3] = [
    place(
        "x_bounds",
        &["x", "bound"],
        "where the cell begins and ends along x",
    ),
    place(
        "y_bounds",
        &["y", "bound"],
        "where the cell begins and ends along y",
    ),
    place(
        "z_bounds",
        &["z", "bound"],
        "heights between which the cell lies",
    ),
];

const fn place(
    name: &'static str,
    dims: &'static [&'static str],
    long_name: &'static str,
) -> Variable {
    Variable {
        name,
        dims,
        units: "m",
        long_name,
        storage: Storage::Double,
    }
}

pub(super) struct CellsFile {
    rows: Rows,
    fields: Vec<&'static Field>,
}

impl CellsFile {
    /// `rows` makes the file, given how many rows are kept together. What never changes is
    /// written now.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        fields: Vec<&'static Field>,
        water: &Water,
    ) -> Result<Self> {
        let mut rows = rows(CHUNK)?;
        let file = &mut rows.file;
        label(file, "component", "component of a vector", &AXES)?;
        file.add_dimension("bound", 2)?;
        let lattice = water.lattice();
        for axis in (0..3).rev() {
            define_axis(file, axis, lattice.cells[axis], lattice.spacing)?;
        }
        describe(file, "z", "positive", "up")?;
        let [nx, ny, nz] = lattice.cells;
        let layers = (NUMBERS / (nx * ny)).clamp(1, nz);
        let still = |field: &&Field| field.still;
        for field in &fields {
            let chunk = [1, layers, ny, nx, 3];
            let dims = field.variable.dims;
            if field.still {
                define(
                    &mut rows.file,
                    &field.variable,
                    dims,
                    &chunk[1..=dims.len()],
                )?;
            } else {
                rows.define(&field.variable, &chunk[..=dims.len()])?;
            }
        }
        let now = lbm::Snapshot {
            time: 0.0,
            thickness: water.start.thickness,
            pressure: Vec::new(),
            flux: Vec::new(),
            content: 0.0,
        };
        for field in fields.iter().copied().filter(still) {
            let values = values(field, water, &now)?;
            put(
                &mut rows.file,
                &field.variable,
                &vec![0; values.ndim()],
                &values,
            )?;
        }
        let fields = fields.into_iter().filter(|field| !field.still).collect();
        Ok(Self { rows, fields })
    }
}

/// Define the dimension along `axis` of `n` cells `dx` [m] long, and where they lie; `bound`
/// is defined before.
pub(in crate::output) fn define_axis(
    file: &mut FileMut,
    axis: usize,
    n: usize,
    dx: f64,
) -> Result<()> {
    file.add_dimension(AXES[axis], n)?;
    define(file, &PLACES[axis], PLACES[axis].dims, &[n])?;
    define(file, &BOUNDS[axis], BOUNDS[axis].dims, &[n, 2])?;
    describe(file, AXES[axis], "bounds", BOUNDS[axis].name)?;
    describe(file, AXES[axis], "axis", AXES[axis].to_uppercase().as_str())?;
    let middles = Array1::from_iter((0..n).map(|k| (k as f64 + 0.5) * dx));
    put(file, &PLACES[axis], &[0], &middles.into_dyn())?;
    let edges = Array::from_shape_fn((n, 2), |(k, side)| (k + side) as f64 * dx);
    put(file, &BOUNDS[axis], &[0, 0], &edges.into_dyn())
}

/// The values of a field along z, y, x, and the components of a vector last.
fn values(field: &Field, water: &Water, now: &lbm::Snapshot) -> Result<ArrayD<f64>> {
    let [nx, ny, nz] = water.model.cells;
    let shape = [nz, ny, nx, 3];
    let values = (field.read)(water, now);
    Ok(ArrayD::from_shape_vec(
        shape[..field.variable.dims.len()].to_vec(),
        values,
    )?)
}

impl OutputFile<WaterFrame> for CellsFile {
    fn write(&mut self, frame: &WaterFrame) -> Result<()> {
        self.rows.begin_at(frame.now.time)?;
        for field in &self.fields {
            let values = values(field, &frame.water, &frame.now)?;
            self.rows.array(&field.variable, &values)?;
        }
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
