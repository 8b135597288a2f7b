//! The ready-made experiments, part of the program itself.

use anyhow::{Context, Result, ensure};
use include_dir::{Dir, File, include_dir};
use std::path::{Path, PathBuf};

/// An experiment that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Ready {
    /// Its name on the command line.
    pub name: &'static str,
    folder: &'static Dir<'static>,
    /// What draws its figures, if several experiments share it.
    shared: Option<(&'static str, &'static str)>,
}

static POSTER_SHEAR: Dir = include_dir!("$CARGO_MANIFEST_DIR/poster-shear");
static SMALL_SHEAR: Dir = include_dir!("$CARGO_MANIFEST_DIR/small-shear");
static POISEUILLE: Dir = include_dir!("$CARGO_MANIFEST_DIR/poiseuille");
static COUETTE: Dir = include_dir!("$CARGO_MANIFEST_DIR/couette");
static TAYLOR_GREEN: Dir = include_dir!("$CARGO_MANIFEST_DIR/taylor-green");
static CAVITY: Dir = include_dir!("$CARGO_MANIFEST_DIR/cavity");
static TERZAGHI_COLUMN: Dir = include_dir!("$CARGO_MANIFEST_DIR/terzaghi-column");
static SKIN_DEPTH: Dir = include_dir!("$CARGO_MANIFEST_DIR/skin-depth");
static WET_CONSOLIDATION: Dir = include_dir!("$CARGO_MANIFEST_DIR/wet-consolidation");
static COULOMB: Dir = include_dir!("$CARGO_MANIFEST_DIR/coulomb");
static WET_SHEAR: Dir = include_dir!("$CARGO_MANIFEST_DIR/wet-shear");
static PRESSURE_CYCLES: Dir = include_dir!("$CARGO_MANIFEST_DIR/pressure-cycles");
static SEEPAGE: Dir = include_dir!("$CARGO_MANIFEST_DIR/seepage");
static SETTLING: Dir = include_dir!("$CARGO_MANIFEST_DIR/settling");
static PACKING: Dir = include_dir!("$CARGO_MANIFEST_DIR/packing-permeability");

/// Draws the figures of sheared beds; their `analyse.py` calls it, one folder up or beside it.
const SHEAR_FIGURES: (&str, &str) = ("shear_figures.py", include_str!("../shear_figures.py"));

/// All of them.
pub const ALL: [Ready; 15] = [
    sheared("small-shear", &SMALL_SHEAR),
    sheared("poster-shear", &POSTER_SHEAR),
    water("poiseuille", &POISEUILLE),
    water("couette", &COUETTE),
    water("taylor-green", &TAYLOR_GREEN),
    water("cavity", &CAVITY),
    water("terzaghi-column", &TERZAGHI_COLUMN),
    water("skin-depth", &SKIN_DEPTH),
    water("packing-permeability", &PACKING),
    water("wet-consolidation", &WET_CONSOLIDATION),
    Ready {
        name: "coulomb",
        folder: &COULOMB,
        shared: None,
    },
    water("wet-shear", &WET_SHEAR),
    water("pressure-cycles", &PRESSURE_CYCLES),
    water("seepage", &SEEPAGE),
    water("settling", &SETTLING),
];

const fn sheared(name: &'static str, folder: &'static Dir<'static>) -> Ready {
    let shared = Some(SHEAR_FIGURES);
    Ready {
        name,
        folder,
        shared,
    }
}

const fn water(name: &'static str, folder: &'static Dir<'static>) -> Ready {
    Ready {
        name,
        folder,
        shared: None,
    }
}

/// The experiment `name`.
pub fn find(name: &str) -> Option<Ready> {
    ALL.into_iter().find(|ready| ready.name == name)
}

/// How scenes call files that are part of the program: `ready-made:NAME/FILE`.
pub const PREFIX: &str = "ready-made:";

/// The file `NAME/FILE` of a ready-made experiment.
///
/// # Errors
/// One that is not there.
pub fn file(path: &str) -> Result<&'static [u8]> {
    let found = path.split_once('/').and_then(|(name, file)| {
        let folder = find(name)?.folder;
        folder.get_file(file).map(File::contents)
    });
    found.with_context(|| format!("no ready-made experiment has the file {path}"))
}

impl Ready {
    /// From where its scene finds its other files.
    pub fn folder(&self) -> PathBuf {
        format!("{PREFIX}{}", self.name).into()
    }

    /// Text of its scene.
    pub fn scene(&self) -> &'static str {
        let file = self.folder.get_file("scene.toml");
        let text = file.and_then(File::contents_utf8);
        text.expect("a test reads the scene of every experiment")
    }

    /// Copy its folder to `target`, which must be new or empty, with what draws its figures.
    ///
    /// # Errors
    /// A folder that holds something, or cannot be written.
    pub fn copy(&self, target: &Path) -> Result<()> {
        let taken = target.exists() && std::fs::read_dir(target)?.next().is_some();
        ensure!(
            !taken,
            "{} exists and is not empty; choose a new folder",
            target.display()
        );
        std::fs::create_dir_all(target)
            .and_then(|()| self.folder.extract(target))
            .and_then(|()| match self.shared {
                Some((name, text)) => std::fs::write(target.join(name), text),
                None => Ok(()),
            })
            .with_context(|| format!("cannot write to {}", target.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_holds_all_that_runs_and_draws_and_is_never_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let copy = folder.path().join("mine");
        for ready in ALL {
            ready.copy(&copy.join(ready.name)).unwrap();
            let shared = ready.shared.map(|(name, _)| name);
            for file in ["scene.toml", "analyse.py", "README.md"]
                .into_iter()
                .chain(shared)
            {
                assert!(copy.join(ready.name).join(file).is_file(), "{file}");
            }
            assert!(ready.copy(&copy.join(ready.name)).is_err());
        }
    }
}
