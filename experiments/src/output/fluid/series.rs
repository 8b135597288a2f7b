//! `series.nc` of water: one number of each kind at each instant.

use super::{Scalar, WaterFrame};
use crate::output::OutputFile;
use crate::output::rows::Rows;
use anyhow::Result;

/// Rows kept together.
const CHUNK: usize = 256;

pub(super) struct SeriesFile {
    rows: Rows,
    scalars: Vec<&'static Scalar>,
}

impl SeriesFile {
    /// `rows` makes the file, given how many rows are kept together.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        scalars: Vec<&'static Scalar>,
    ) -> Result<Self> {
        let mut rows = rows(CHUNK)?;
        for scalar in &scalars {
            rows.define(&scalar.variable, &[CHUNK])?;
        }
        Ok(Self { rows, scalars })
    }
}

impl OutputFile<WaterFrame> for SeriesFile {
    fn write(&mut self, frame: &WaterFrame) -> Result<()> {
        self.rows.begin_at(frame.now.time)?;
        for scalar in &self.scalars {
            let value = (scalar.read)(&frame.water, &frame.now);
            self.rows.scalar(&scalar.variable, value)?;
        }
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
