//! The ready-made experiments, part of the program itself.

use anyhow::{Context, Result, ensure};
use include_dir::{Dir, File, include_dir};
use std::path::Path;

/// An experiment that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Ready {
    /// Its name on the command line.
    pub name: &'static str,
    folder: &'static Dir<'static>,
}

static POSTER_SHEAR: Dir = include_dir!("$CARGO_MANIFEST_DIR/poster-shear");
static SMALL_SHEAR: Dir = include_dir!("$CARGO_MANIFEST_DIR/small-shear");

/// Draws the figures; each experiment's `analyse.py` calls it, one folder up or beside it.
static FIGURES: &str = include_str!("../shear_figures.py");

/// All of them.
pub const ALL: [Ready; 2] = [
    Ready {
        name: "small-shear",
        folder: &SMALL_SHEAR,
    },
    Ready {
        name: "poster-shear",
        folder: &POSTER_SHEAR,
    },
];

/// The experiment `name`.
pub fn find(name: &str) -> Option<Ready> {
    ALL.into_iter().find(|ready| ready.name == name)
}

impl Ready {
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
            .and_then(|()| std::fs::write(target.join("shear_figures.py"), FIGURES))
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
            for file in ["scene.toml", "analyse.py", "shear_figures.py"] {
                assert!(copy.join(ready.name).join(file).is_file(), "{file}");
            }
            assert!(ready.copy(&copy.join(ready.name)).is_err());
        }
    }
}
