//! What has been measured, kept in a file as soon as it is known.

use anyhow::{Context, Result};
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Rows of the results, one object a case.
#[derive(Debug)]
pub struct Kept {
    /// None: nowhere.
    file: Option<PathBuf>,
    rows: Vec<serde_json::Value>,
}

impl Kept {
    /// Rows to come go to `file`.
    pub fn new(file: Option<PathBuf>) -> Self {
        Self {
            file,
            rows: Vec::new(),
        }
    }

    /// Write all rows so far and `rows` in the place of what the file held: whatever becomes of the
    /// cases to come, these are kept, and it is never half a file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&mut self, rows: &[impl Serialize]) -> Result<()> {
        let new = rows.iter().map(serde_json::to_value);
        self.rows.extend(new.collect::<Result<Vec<_>, _>>()?);
        let Some(file) = &self.file else {
            return Ok(());
        };
        let text = serde_json::to_string_pretty(&self.rows)? + "\n";
        replace(file, &text).with_context(|| format!("cannot write {}", file.display()))
    }
}

fn replace(file: &Path, text: &str) -> std::io::Result<()> {
    let folder = file
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let mut whole = NamedTempFile::new_in(folder.unwrap_or(Path::new(".")))?;
    whole.write_all(text.as_bytes())?;
    // As of any file that a program makes, and not for its owner alone.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let all = std::fs::Permissions::from_mode(0o644);
        whole.as_file().set_permissions(all)?;
    }
    whole.persist(file)?;
    Ok(())
}
