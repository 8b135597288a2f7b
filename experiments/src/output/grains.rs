//! `grains.nc`: every grain at some instants.

use super::netcdf::{define, label, put};
use super::rows::Rows;
use super::{Frame, OutputFile};
use anyhow::Result;
use dem::Grains;
use dem::output::{Field, FieldReading, Storage, Variable};
use ndarray::Array1;

/// Rows of time, phase and strain kept together; each row of grains is a chunk.
const CHUNK: usize = 256;

const GRAIN: Variable = Variable {
    name: "grain",
    dims: &["grain"],
    units: "1",
    long_name: "identity of the grain",
    storage: Storage::Integer,
};
const RADIUS: Variable = Variable {
    name: "radius",
    dims: &["grain"],
    units: "m",
    long_name: "radius of the grain",
    storage: Storage::Double,
};

pub(super) struct GrainsFile {
    rows: Rows,
    fields: Vec<&'static Field>,
}

impl GrainsFile {
    /// `rows` makes the file, given how many rows are kept together.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        fields: Vec<&'static Field>,
        grains: &Grains,
    ) -> Result<Self> {
        let mut rows = rows(CHUNK)?;
        let n = grains.len();

        let file = &mut rows.file;
        label(file, "component", "component of a vector", &["x", "y", "z"])?;
        let parts = ["x", "y", "z", "w"];
        label(
            file,
            "quaternion",
            "part of a quaternion, w is real",
            &parts,
        )?;
        file.add_dimension("grain", n)?;
        let id = grains.id.iter().map(|&id| f64::from(id)).collect();
        for (variable, values) in [(GRAIN, id), (RADIUS, grains.radius.clone())] {
            define(file, &variable, variable.dims, &[n])?;
            put(file, &variable, &[0], &Array1::from_vec(values).into_dyn())?;
        }

        for field in &fields {
            let parts = match field.variable.dims.get(1) {
                Some(&"quaternion") => 4,
                _ => 3,
            };
            let chunk = [1, n, parts];
            rows.define(&field.variable, &chunk[..=field.variable.dims.len()])?;
        }
        Ok(Self { rows, fields })
    }
}

impl OutputFile for GrainsFile {
    fn write(&mut self, frame: &Frame) -> Result<()> {
        let reading = FieldReading {
            model: &frame.model,
            now: &frame.snapshot,
            edges: &[],
        };
        self.rows.begin(frame)?;
        for field in &self.fields {
            self.rows.array(&field.variable, &(field.read)(&reading))?;
        }
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
