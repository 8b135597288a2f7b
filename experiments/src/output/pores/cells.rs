//! `fluid.nc` between grains: every cell at some instants, in layers that follow the top wall.

use super::{Cells, Field};
use crate::output::fluid::define_axis;
use crate::output::netcdf::{define, describe, label, put};
use crate::output::rows::Rows;
use crate::output::{Frame, OutputFile};
use crate::protocol::TOP;
use crate::scene::water::AXES;
use anyhow::Result;
use dem::measure;
use dem::output::{Storage, Variable};
use ndarray::{Array1, ArrayD};

/// Rows of time kept together.
const CHUNK: usize = 256;
/// Numbers of a chunk, about 4 MiB; layers beyond go into the next one.
const NUMBERS: usize = 1 << 20;

const Z: Variable = Variable {
    name: "z",
    dims: &["z"],
    units: "1",
    long_name: "height of the middle of the cell over that of the top wall",
    storage: Storage::Double,
};
const HEIGHT: Variable = Variable {
    name: "height",
    dims: &[],
    units: "m",
    long_name: "height of the top wall over the bottom, between which the cells are stretched",
    storage: Storage::Double,
};

pub(in crate::output) struct CellsFile {
    rows: Rows,
    fields: Vec<&'static Field>,
    count: [usize; 3],
}

impl CellsFile {
    /// `rows` makes the file, given how many rows are kept together.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        fields: Vec<&'static Field>,
        cells: Cells,
    ) -> Result<Self> {
        let mut rows = rows(CHUNK)?;
        let file = &mut rows.file;
        label(file, "component", "component of a vector", &AXES)?;
        file.add_dimension("bound", 2)?;
        let [nx, ny, nz] = cells.count;
        file.add_dimension("z", nz)?;
        define(file, &Z, Z.dims, &[nz])?;
        describe(file, "z", "axis", "Z")?;
        describe(file, "z", "positive", "up")?;
        let middles = Array1::from_iter((0..nz).map(|k| (k as f64 + 0.5) / nz as f64));
        put(file, &Z, &[0], &middles.into_dyn())?;
        for along in [1, 0] {
            define_axis(file, along, cells.count[along], cells.spacing)?;
        }
        rows.define(&HEIGHT, &[CHUNK])?;
        let layers = (NUMBERS / (nx * ny)).clamp(1, nz);
        for field in &fields {
            let chunk = [1, layers, ny, nx, 3];
            rows.define(&field.variable, &chunk[..=field.variable.dims.len()])?;
        }
        Ok(Self {
            rows,
            fields,
            count: cells.count,
        })
    }
}

impl OutputFile for CellsFile {
    /// A dry phase leaves no rows.
    fn write(&mut self, frame: &Frame) -> Result<()> {
        let Some(water) = &frame.water else {
            return Ok(());
        };
        self.rows.begin(frame)?;
        let height = measure::wall_height(&frame.model, &frame.snapshot.state, TOP);
        self.rows.scalar(&HEIGHT, height)?;
        let [nx, ny, nz] = self.count;
        let shape = [nz, ny, nx, 3];
        for field in &self.fields {
            let shape = shape[..field.variable.dims.len()].to_vec();
            let values = ArrayD::from_shape_vec(shape, (field.read)(&water.now))?;
            self.rows.array(&field.variable, &values)?;
        }
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
