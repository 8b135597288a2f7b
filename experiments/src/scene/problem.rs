//! What is wrong with a scene, where, and what to write instead.

use std::fmt;

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// File and line, or the `--set` that it came from.
    pub place: String,
    /// Line in the file, for sorting; 0 without one.
    pub line: usize,
    /// Path of the key: `grains.density`; empty for the file as a whole.
    pub path: String,
    /// What is wrong, and what to write.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self.place.as_str(), self.path.as_str()) {
            (place, "") => write!(f, "{place}: {}", self.message),
            (place, path) => write!(f, "{place}: {path}: {}", self.message),
        }
    }
}

/// Everything that is wrong with a scene, in the order of its lines.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct Problems(pub Vec<Problem>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let lines: Vec<String> = self.0.iter().map(Problem::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}
