//! The scene that a command names: a file, a folder, or a ready-made experiment.

use crate::ready;
use crate::scene::{AnyScene, Document};
use crate::sweep::Source;
use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use std::path::{Path, PathBuf};

/// Which scene, and what to change in it.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// Scene file, folder with a scene.toml, or name of a ready-made experiment
    pub scene: String,
    /// Change the scene before it is checked, e.g. --set time.step="1 us" or
    /// --set phase.shear.top.normal_stress="50 kPa" (phases go by name)
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

impl SceneArgs {
    /// Read and check the scene. Returns it with a short name for its results.
    ///
    /// # Errors
    /// A scene that is not there, or everything that is wrong with it.
    pub fn read(&self) -> Result<(AnyScene, String)> {
        let (document, name) = self.document()?;
        let scene = AnyScene::read(&document).map_err(counted)?;
        Ok((scene, name))
    }

    fn document(&self) -> Result<(Document, String)> {
        let (source, name) = self.source()?;
        let document = Document::new(&source.name, &source.folder, &source.text, &source.sets);
        Ok((document.map_err(counted)?, name))
    }

    /// The text of the scene, before it is read, with a short name for its results.
    ///
    /// # Errors
    /// A scene that is not there.
    pub fn source(&self) -> Result<(Source, String)> {
        let path = Path::new(&self.scene);
        let file = if path.is_dir() {
            path.join("scene.toml")
        } else {
            path.to_path_buf()
        };
        if file.is_file() {
            let text = std::fs::read_to_string(&file)
                .with_context(|| format!("cannot read {}", file.display()))?;
            let source = Source {
                name: file.display().to_string(),
                folder: file.parent().unwrap_or(Path::new(".")).into(),
                text,
                sets: self.set.clone(),
            };
            return Ok((source, short_name(&file)));
        }
        if path.is_dir() {
            bail!("{} holds no scene.toml", path.display());
        }
        let ready = ready::find(&self.scene).ok_or_else(|| anyhow!(no_such(&self.scene)))?;
        let source = Source {
            name: format!("{}/scene.toml", ready.name),
            folder: ready.folder(),
            text: ready.scene().into(),
            sets: self.set.clone(),
        };
        Ok((source, ready.name.into()))
    }
}

/// The problems of a scene, each on its own line, and their number.
fn counted(problems: crate::scene::Problems) -> anyhow::Error {
    let n = problems.0.len();
    let things = if n == 1 { "thing is" } else { "things are" };
    anyhow!("{n} {things} wrong with the scene\n{problems}")
}

/// `dir/scene.toml` is called `dir`, other files by their own name.
fn short_name(file: &Path) -> String {
    let full = std::path::absolute(file).unwrap_or_else(|_| PathBuf::from(file));
    let stem = full.file_stem();
    let of = if stem.is_some_and(|stem| stem == "scene") {
        full.parent().and_then(Path::file_name)
    } else {
        stem
    };
    of.map_or_else(
        || "scene".into(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// What to say of a name that is no scene.
pub fn no_such(name: &str) -> String {
    let names: Vec<&str> = ready::ALL.iter().map(|ready| ready.name).collect();
    let near = names
        .iter()
        .find(|known| strsim::jaro_winkler(known, name) > 0.8);
    let hint = near.map_or_else(
        || format!("ready-made are: {}", names.join(", ")),
        |known| format!("did you mean {known}?"),
    );
    format!("{name} is neither a file nor a ready-made experiment; {hint}")
}
