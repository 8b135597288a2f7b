//! `series.nc`: one number of each kind at each instant.

use super::catalogue::{PROGRESS, Series};
use super::rows::Rows;
use super::{Frame, OutputFile};
use anyhow::Result;

/// Rows kept together.
const CHUNK: usize = 256;

pub(super) struct SeriesFile {
    rows: Rows,
    variables: Vec<Series>,
}

impl SeriesFile {
    /// `rows` makes the file, given how many rows are kept together.
    pub fn create(
        rows: impl FnOnce(usize) -> Result<Rows>,
        mut variables: Vec<Series>,
    ) -> Result<Self> {
        let mut rows = rows(CHUNK)?;
        // Phase and strain stand in every file without being asked for.
        let is_place = |s: &Series| PROGRESS.iter().any(|p| &p.variable == s.variable());
        variables.retain(|series| !is_place(series));
        for series in &variables {
            rows.define(series.variable(), &[CHUNK])?;
        }
        Ok(Self { rows, variables })
    }
}

impl OutputFile for SeriesFile {
    fn write(&mut self, frame: &Frame) -> Result<()> {
        self.rows.begin(frame)?;
        for series in &self.variables {
            self.rows.scalar(series.variable(), series.read(frame))?;
        }
        self.rows.end();
        Ok(())
    }

    fn sync(&mut self) -> Result<()> {
        self.rows.sync()
    }
}
