//! What became of a run, `outcome.json` in its folder. A run without one was not finished.

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// What became of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// It came to its end.
    Done {
        /// Wall-clock time since it began or went on [s].
        seconds: f64,
        /// What may be wrong with its numbers.
        warnings: Vec<String>,
    },
    /// It did not.
    Failed {
        /// Why.
        reason: String,
    },
}

const OUTCOME: &str = "outcome.json";

impl Outcome {
    /// That of the run in `folder`; none: it was not finished.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn load(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(OUTCOME);
        let cannot = || format!("cannot read {}", path.display());
        match fs::read_to_string(&path) {
            Ok(text) => serde_json::from_str(&text).map(Some).with_context(cannot),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error).with_context(cannot),
        }
    }

    /// Put it into `folder`.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn store(&self, folder: &Path) -> Result<()> {
        let path = folder.join(OUTCOME);
        let partial = folder.join("outcome.json.partial");
        fs::write(&partial, serde_json::to_string_pretty(self)?)
            .and_then(|()| fs::rename(&partial, &path))
            .with_context(|| format!("cannot write {}", path.display()))
    }

    /// Take it away from `folder`: the run begins or goes on.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn clear(folder: &Path) -> Result<()> {
        match fs::remove_file(folder.join(OUTCOME)) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(error).with_context(|| format!("cannot write to {}", folder.display()))
            }
            _ => Ok(()),
        }
    }
}
