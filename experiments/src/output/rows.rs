//! A NetCDF file that grows by one row with each frame.

use super::catalogue::PROGRESS;
use super::netcdf::{create, define, describe, put};
use super::pores::ON_CPU_ALONE;
use super::{Frame, Header, provenance};
use anyhow::Result;
use dem::output::{Storage, Variable};
use ndarray::{ArrayD, arr0};
use netcdf::FileMut;
use std::path::Path;

const TIME: Variable = Variable {
    name: "time",
    dims: &[],
    units: "s",
    long_name: "simulated time",
    storage: Storage::Double,
};

/// The file, and how many rows it has.
pub(super) struct Rows {
    pub file: FileMut,
    rows: usize,
    /// Names of the phases, if there is a protocol with a place in it for each row.
    phases: Option<Vec<String>>,
    /// Does a graphics device compute?
    on_gpu: bool,
    /// The last phase of which the coupling with the water was described.
    described: Option<u32>,
}

impl Rows {
    /// Make the file with its attributes, the unlimited dimension `time`, and, if there is one,
    /// where in the protocol of these `phases` each row was taken.
    ///
    /// `chunk`: number of rows kept together.
    pub fn create(
        path: &Path,
        header: &Header,
        phases: Option<&[String]>,
        chunk: usize,
    ) -> Result<Self> {
        let mut file = create(path)?;
        file.add_attribute("Conventions", "CF-1.11")?;
        for (name, text) in provenance::texts(header) {
            file.add_attribute(name, text)?;
        }
        if let Some(seed) = header.seed {
            file.add_attribute("seed", seed)?;
        }
        file.add_unlimited_dimension("time")?;
        define(&mut file, &TIME, &["time"], &[chunk])?;
        for place in PROGRESS.iter().filter(|_| phases.is_some()) {
            define(&mut file, &place.variable, &["time"], &[chunk])?;
        }
        if let Some(phases) = phases.filter(|phases| !phases.is_empty()) {
            let numbers: Vec<_> = (0..phases.len() as i64).collect();
            // The words of flag_meanings are separated by blanks.
            let names: Vec<_> = phases.iter().map(|name| name.replace(' ', "_")).collect();
            describe(&mut file, "phase", "flag_values", numbers)?;
            describe(&mut file, "phase", "flag_meanings", names.join(" "))?;
        }
        Ok(Self {
            file,
            rows: 0,
            on_gpu: header.backend == "gpu",
            phases: phases.map(<[String]>::to_vec),
            described: None,
        })
    }

    /// Define a variable over time and its own dimensions.
    ///
    /// xarray takes the place in the protocol as its coordinates.
    pub fn define(&mut self, variable: &Variable, chunk: &[usize]) -> Result<()> {
        let dims = [&["time"], variable.dims].concat();
        define(&mut self.file, variable, &dims, chunk)?;
        if self.on_gpu && ON_CPU_ALONE.contains(&variable.name) {
            let comment = "no number: computed with --backend cpu alone";
            describe(&mut self.file, variable.name, "comment", comment)?;
        }
        match self.phases {
            Some(_) => describe(&mut self.file, variable.name, "coordinates", "phase strain"),
            None => Ok(()),
        }
    }

    /// Begin a row at `time` [s].
    pub fn begin_at(&mut self, time: f64) -> Result<()> {
        self.scalar(&TIME, time)
    }

    /// Begin the row of `frame`.
    pub fn begin(&mut self, frame: &Frame) -> Result<()> {
        self.begin_at(frame.snapshot.state.time)?;
        for place in PROGRESS {
            self.scalar(&place.variable, (place.read)(frame))?;
        }
        self.describe_coupling(frame)
    }

    /// Say once in each phase what the numbers of its coupling with water are.
    fn describe_coupling(&mut self, frame: &Frame) -> Result<()> {
        let Some(water) = &frame.water else {
            return Ok(());
        };
        if self.described.replace(frame.phase) == Some(frame.phase) {
            return Ok(());
        }
        let names = self.phases.as_ref();
        if let Some(name) = names.and_then(|names| names.get(frame.phase as usize)) {
            let rate = dem::measure::strain_rate(&frame.model, &frame.snapshot).abs();
            let report = water.attribute(rate).to_string();
            self.file
                .add_attribute(&format!("coupling_{name}"), report)?;
        }
        Ok(())
    }

    /// Write a value into the row.
    pub fn scalar(&mut self, variable: &Variable, value: f64) -> Result<()> {
        self.array(variable, &arr0(value).into_dyn())
    }

    /// Write an array into the row.
    pub fn array(&mut self, variable: &Variable, values: &ArrayD<f64>) -> Result<()> {
        let start = [vec![self.rows], vec![0; values.ndim()]].concat();
        put(&mut self.file, variable, &start, values)
    }

    /// End the row.
    pub fn end(&mut self) {
        self.rows += 1;
    }

    /// Put all rows on the disk: a run that is killed keeps only what was synchronised.
    pub fn sync(&mut self) -> Result<()> {
        Ok(self.file.sync()?)
    }
}
