//! What a run leaves behind: NetCDF files for analysis, and the state to go on from.

pub mod catalogue;
mod contacts;
mod grains;
pub mod netcdf;
mod profiles;
pub mod provenance;
mod rows;
mod series;
pub mod state;
mod writer;

pub use writer::Writer;

use anyhow::{Context, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is said about a run in the attributes of each of its files; the writer adds
/// version, commit and machine.
#[derive(Clone, Debug)]
pub struct Header {
    /// Title of the scene.
    pub title: String,
    /// The resolved scene, TOML.
    pub scene: String,
    /// Seed of the random start.
    pub seed: u64,
}

/// Which files are wanted, and which variables in them. `None`: no such file.
///
/// Time, phase and strain stand in every file without being asked for.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Names of the variables of `series.nc`.
    pub series: Option<Vec<String>>,
    /// Names of the variables of `profiles.nc`.
    pub profiles: Option<Vec<String>>,
    /// Names of the variables of `grains.nc`.
    pub grains: Option<Vec<String>>,
    /// Names of the variables of `contacts.nc`.
    pub contacts: Option<Vec<String>>,
    /// Edges of the profiles' layers along z [m], ascending.
    pub profile_edges: Vec<f64>,
}

/// One instant on its way to the files.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The description of the run.
    pub model: Arc<dem::Model>,
    /// What was read from the solver.
    pub snapshot: Arc<dem::Snapshot>,
    /// The sums at the last reading of the series, [`Sums::default`](dem::Sums) at the
    /// first one of a solver: interval means run from there.
    pub before: dem::Sums,
    /// Number of the phase, from 0.
    pub phase: u32,
    /// Shear strain since shearing began.
    pub strain: f64,
    /// Volumetric strain of the bed since the phase began, positive when it swells.
    pub dilation: f64,
    /// Does the frame go to `series.nc`?
    pub series: bool,
    /// Does the frame go to `profiles.nc`?
    pub profiles: bool,
    /// Does the frame go to `grains.nc`?
    pub grains: bool,
    /// Does the frame go to `contacts.nc`?
    pub contacts: bool,
}

/// Names of the files that a [`Writer`] may make.
pub const NAMES: [&str; 4] = [
    series::SeriesFile::NAME,
    profiles::ProfilesFile::NAME,
    grains::GrainsFile::NAME,
    contacts::ContactsFile::NAME,
];

/// One file of a run.
trait OutputFile: Send {
    /// Its name in the folder.
    fn name(&self) -> &'static str;
    /// Is `frame` for this file?
    fn wants(&self, frame: &Frame) -> bool;
    /// Add `frame`.
    fn write(&mut self, frame: &Frame) -> Result<()>;
    /// Put all that was added on the disk.
    fn sync(&mut self) -> Result<()>;
}

/// Where a file stands until it is whole and may take the place of an older one.
fn partial(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

/// Make the files of `plan` in the folder `dir`, as [`partial`] ones.
fn create_files(
    dir: &Path,
    header: &Header,
    plan: &Plan,
    phases: &[String],
    bed: &dem::Grains,
) -> Result<Vec<Box<dyn OutputFile>>> {
    use {contacts::ContactsFile, grains::GrainsFile, profiles::ProfilesFile, series::SeriesFile};

    let chosen = catalogue::Chosen::new(plan)?;
    let rows = |name| {
        let path = partial(&dir.join(name));
        move |chunk| rows::Rows::create(&path, header, phases, chunk)
    };
    let cannot = |name| format!("cannot make {}", dir.join(name).display());
    let mut files: Vec<Box<dyn OutputFile>> = Vec::new();
    if let Some(variables) = chosen.series {
        let name = SeriesFile::NAME;
        let file = SeriesFile::create(rows(name), variables);
        files.push(Box::new(file.with_context(|| cannot(name))?));
    }
    if let Some(fields) = chosen.profiles {
        let name = ProfilesFile::NAME;
        let file = ProfilesFile::create(rows(name), fields, plan.profile_edges.clone());
        files.push(Box::new(file.with_context(|| cannot(name))?));
    }
    if let Some(fields) = chosen.grains {
        let name = GrainsFile::NAME;
        let file = GrainsFile::create(rows(name), fields, bed);
        files.push(Box::new(file.with_context(|| cannot(name))?));
    }
    if let Some(fields) = chosen.contacts {
        let name = ContactsFile::NAME;
        let file = ContactsFile::create(rows(name), fields);
        files.push(Box::new(file.with_context(|| cannot(name))?));
    }
    Ok(files)
}
