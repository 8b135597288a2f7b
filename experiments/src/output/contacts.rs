//! `contacts.nc`: every contact at some instants, ragged.
//!
//! The contacts of all rows stand one after another along `contact`; row t has `count[t]`
//! of them and begins at `offset[t]` (a contiguous ragged array of the CF conventions).

use super::netcdf::{define, describe, label, put};
use super::rows::Rows;
use super::{Frame, OutputFile};
use anyhow::Result;
use dem::output::{Field, FieldReading, Storage, Variable};

/// Rows of time, phase, strain, offset and count kept together.
const CHUNK: usize = 256;
/// Contacts kept together.
const CONTACT_CHUNK: usize = 4096;

const OFFSET: Variable = Variable {
    name: "offset",
    dims: &[],
    units: "1",
    long_name: "index of the row's first contact",
    storage: Storage::Integer,
};
const COUNT: Variable = Variable {
    name: "count",
    dims: &[],
    units: "1",
    long_name: "number of the row's contacts",
    storage: Storage::Integer,
};

pub(super) struct ContactsFile {
    rows: Rows,
    fields: Vec<&'static Field>,
    /// Contacts written so far.
    written: usize,
}

impl ContactsFile {
    /// `rows` makes the file, given how many rows are kept together.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        fields: Vec<&'static Field>,
    ) -> Result<Self> {
        let mut rows = rows(CHUNK)?;
        for variable in [OFFSET, COUNT] {
            rows.define(&variable, &[CHUNK])?;
        }
        let file = &mut rows.file;
        describe(file, "count", "sample_dimension", "contact")?;
        label(file, "component", "component of a vector", &["x", "y", "z"])?;
        label(file, "member", "member of a pair", &["i", "j"])?;
        file.add_unlimited_dimension("contact")?;
        for field in &fields {
            let width = match field.variable.dims.get(1) {
                Some(&"member") => 2,
                _ => 3,
            };
            let dims = field.variable.dims;
            define(
                file,
                &field.variable,
                dims,
                &[CONTACT_CHUNK, width][..dims.len()],
            )?;
        }
        Ok(Self {
            rows,
            fields,
            written: 0,
        })
    }
}

impl OutputFile for ContactsFile {
    fn write(&mut self, frame: &Frame) -> Result<()> {
        let reading = FieldReading {
            model: &frame.model,
            now: &frame.snapshot,
            edges: &[],
        };
        let count = frame.snapshot.state.contacts.len();
        self.rows.begin(frame)?;
        self.rows.scalar(&OFFSET, self.written as f64)?;
        self.rows.scalar(&COUNT, count as f64)?;
        for field in &self.fields {
            let values = (field.read)(&reading);
            let start = [self.written, 0];
            put(
                &mut self.rows.file,
                &field.variable,
                &start[..values.ndim()],
                &values,
            )?;
        }
        self.written += count;
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
