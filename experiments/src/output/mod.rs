//! What a run leaves behind: NetCDF files for analysis, and the state to go on from.

pub mod catalogue;
mod contacts;
pub mod fluid;
mod grains;
mod hdf;
pub mod netcdf;
mod pore_state;
pub mod pores;
mod profiles;
pub mod provenance;
mod rows;
mod series;
pub mod state;
pub mod water_state;
mod writer;

pub use writer::Writer;

use anyhow::{Context, Result};
use dem::output::{CONTACTS, GRAINS};
use enum_map::{Enum, EnumMap};
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
    /// Seed of the random start; none where nothing is random.
    pub seed: Option<u64>,
    /// Who computed: `cpu` or `gpu`.
    pub backend: &'static str,
    /// Its name.
    pub device: String,
}

/// The NetCDF files of a run.
#[derive(Clone, Copy, Debug, Enum, PartialEq, Eq)]
pub enum FileKind {
    /// One number of each kind at each instant.
    Series,
    /// Means over horizontal layers.
    Profiles,
    /// Every grain.
    Grains,
    /// Every contact.
    Contacts,
    /// Every cell of water.
    Fluid,
}

impl FileKind {
    /// What scenes call it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Series => "series",
            Self::Profiles => "profiles",
            Self::Grains => "grains",
            Self::Contacts => "contacts",
            Self::Fluid => "fluid",
        }
    }

    /// Its name in the folder of the results.
    pub fn file_name(self) -> String {
        format!("{}.nc", self.key())
    }

    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        EnumMap::<Self, ()>::default()
            .into_iter()
            .map(|(kind, ())| kind)
    }
}

/// Which files are wanted, and which variables in them.
///
/// Time, phase and strain stand in every file without being asked for.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Names of the variables of each file; none: no such file.
    pub variables: EnumMap<FileKind, Option<Vec<String>>>,
    /// Edges of the profiles' layers along z [m], ascending.
    pub profile_edges: Vec<f64>,
    /// The cells of the water between the grains; none: they are dry.
    pub cells: Option<pores::Cells>,
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
    /// The water between the grains; none: they are dry now.
    pub water: Option<Arc<pores::PoreReading>>,
    /// Number of the phase, from 0.
    pub phase: u32,
    /// Shear strain since shearing began.
    pub strain: f64,
    /// Volumetric strain of the bed since the phase began, positive when it swells.
    pub dilation: f64,
    /// To which files the frame goes.
    pub due: EnumMap<FileKind, bool>,
}

/// One instant of any run, on its way to the files.
pub trait Moment: Send + 'static {
    /// Does it go to this file?
    fn goes_to(&self, kind: FileKind) -> bool;
    /// When it was [s].
    fn time(&self) -> f64;
}

impl Moment for Frame {
    fn goes_to(&self, kind: FileKind) -> bool {
        self.due[kind]
    }

    fn time(&self) -> f64 {
        self.snapshot.state.time
    }
}

/// One file of a run.
trait OutputFile<F = Frame>: Send {
    /// Add `frame`.
    fn write(&mut self, frame: &F) -> Result<()>;
    /// Put all that was added on the disk.
    fn sync(&mut self) -> Result<()>;
}

type Files<F = Frame> = Vec<(FileKind, Box<dyn OutputFile<F>>)>;

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
) -> Result<Files> {
    let mut files = Files::new();
    for (kind, names) in &plan.variables {
        let Some(names) = names else { continue };
        let path = dir.join(kind.file_name());
        let rows = |chunk| rows::Rows::create(&partial(&path), header, Some(phases), chunk);
        let file = create_file(kind, names, rows, plan, bed);
        let cannot = || format!("cannot make {}", path.display());
        files.push((kind, file.with_context(cannot)?));
    }
    Ok(files)
}

fn create_file(
    kind: FileKind,
    names: &[String],
    rows: impl FnOnce(usize) -> Result<rows::Rows>,
    plan: &Plan,
    bed: &dem::Grains,
) -> Result<Box<dyn OutputFile>> {
    let fields =
        |all| catalogue::named(all, names, |field: &dem::output::Field| field.variable.name);
    Ok(match kind {
        FileKind::Series => {
            let all: Vec<_> = match plan.cells {
                Some(_) => catalogue::wet_series().collect(),
                None => catalogue::series().collect(),
            };
            let variables = catalogue::named(&all, names, |series| series.variable().name)?;
            let variables = variables.into_iter().copied().collect();
            Box::new(series::SeriesFile::create(rows, variables)?)
        }
        FileKind::Profiles => {
            let all: Vec<_> = catalogue::profiles(plan.cells.is_some()).collect();
            let variables = catalogue::named(&all, names, |profile| profile.variable().name)?;
            let variables = variables.into_iter().copied().collect();
            let edges = plan.profile_edges.clone();
            Box::new(profiles::ProfilesFile::create(rows, variables, edges)?)
        }
        FileKind::Grains => Box::new(grains::GrainsFile::create(rows, fields(GRAINS)?, bed)?),
        FileKind::Contacts => Box::new(contacts::ContactsFile::create(rows, fields(CONTACTS)?)?),
        FileKind::Fluid => {
            let cells = plan.cells.context("there is no water between the grains")?;
            let all: Vec<_> = pores::FIELDS.iter().collect();
            let fields = catalogue::named(&all, names, |field| field.variable.name)?;
            let fields = fields.into_iter().copied().collect();
            Box::new(pores::CellsFile::create(rows, fields, cells)?)
        }
    })
}
