//! What water leaves behind: `fluid.nc`, every cell at some instants, and `series.nc`.

mod cells;
mod fields;
mod scalars;
mod series;

pub(super) use cells::define_axis;
pub use fields::{FIELDS, Field};
pub use scalars::{SCALARS, Scalar};

use super::rows::Rows;
use super::{FileKind, Files, Header, Moment, OutputFile, Writer, catalogue, partial};
use crate::scene::WaterScene;
use crate::scene::water::Water;
use anyhow::{Context, Result};
use enum_map::EnumMap;
use std::path::Path;
use std::sync::Arc;

/// One instant of water on its way to the files.
#[derive(Clone, Debug)]
pub struct WaterFrame {
    /// The description of the run.
    pub water: Arc<Water>,
    /// What was read from the solver.
    pub now: Arc<lbm::Snapshot>,
    /// To which files it goes.
    pub due: EnumMap<FileKind, bool>,
}

impl Moment for WaterFrame {
    fn goes_to(&self, kind: FileKind) -> bool {
        self.due[kind]
    }

    fn time(&self) -> f64 {
        self.now.time
    }
}

/// Make the files of `scene` in the folder `dir` and begin to write them.
///
/// # Errors
/// Files that cannot be made.
pub fn create(dir: &Path, header: &Header, scene: &WaterScene) -> Result<Writer<WaterFrame>> {
    Writer::start(dir, files(dir, header, scene))
}

fn files(dir: &Path, header: &Header, scene: &WaterScene) -> Result<Files<WaterFrame>> {
    let mut files = Files::new();
    for (kind, file) in &scene.output {
        let Some(file) = file else { continue };
        let path = dir.join(kind.file_name());
        let rows = |chunk| Rows::create(&partial(&path), header, None, chunk);
        let made = file_of(kind, &file.variables, rows, &scene.water);
        let cannot = || format!("cannot make {}", path.display());
        files.push((kind, made.with_context(cannot)?));
    }
    Ok(files)
}

fn file_of(
    kind: FileKind,
    names: &[String],
    rows: impl FnOnce(usize) -> Result<Rows>,
    water: &Water,
) -> Result<Box<dyn OutputFile<WaterFrame>>> {
    Ok(match kind {
        FileKind::Series => {
            let all: Vec<_> = SCALARS.iter().collect();
            let scalars = catalogue::named(&all, names, |s| s.variable.name)?;
            let scalars = scalars.into_iter().copied().collect();
            Box::new(series::SeriesFile::create(rows, scalars)?)
        }
        _ => {
            let all: Vec<_> = FIELDS.iter().collect();
            let fields = catalogue::named(&all, names, |f| f.variable.name)?;
            let fields = fields.into_iter().copied().collect();
            Box::new(cells::CellsFile::create(rows, fields, water)?)
        }
    })
}
