//! When which file gets a row.

use crate::output::FileKind;
use crate::scene::output::File;
use enum_map::EnumMap;

/// Which files get a row now.
pub type Due = EnumMap<FileKind, bool>;

/// The first row of a run: all but the series, whose means need an interval. The writer leaves
/// out the files that there are not.
pub const START: Due = EnumMap::from_array([false, true, true, true, true]);

/// Is there any?
pub fn any(due: Due) -> bool {
    due.values().any(|&due| due)
}

/// Intervals of the files in steps, counted from the start of each phase; none: the file
/// is not written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intervals(EnumMap<FileKind, Option<u64>>);

impl Intervals {
    /// The intervals nearest to those of `files`, in whole steps of `step` [s].
    pub fn new(files: &EnumMap<FileKind, Option<File>>, step: f64) -> Self {
        let steps = |every: f64| ((every / step).round() as u64).max(1);
        Self(EnumMap::from_fn(|kind| {
            files[kind].as_ref().map(|file: &File| steps(file.every))
        }))
    }

    /// The first step after `done` at which a file gets a row.
    pub fn next(&self, done: u64) -> u64 {
        let each = self.0.values().flatten().map(|n| (done / n + 1) * n);
        each.min().unwrap_or(u64::MAX)
    }

    /// What is due after `done` steps.
    pub fn due(&self, done: u64) -> Due {
        self.0
            .map(|_, every| every.is_some_and(|n| done.is_multiple_of(n)))
    }

    /// At the end of a phase every file gets a row.
    pub fn last(&self) -> Due {
        self.0.map(|_, every| every.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_due_at_multiples_of_their_intervals() {
        let intervals = Intervals(EnumMap::from_array([Some(10), None, Some(25), None, None]));
        let mut at = 0;
        let mut rows = Vec::new();
        while at < 60 {
            at = intervals.next(at);
            let due = intervals.due(at);
            rows.push((at, due[FileKind::Series], due[FileKind::Grains]));
        }
        let expected = [
            (10, true, false),
            (20, true, false),
            (25, false, true),
            (30, true, false),
            (40, true, false),
            (50, true, true),
            (60, true, false),
        ];
        assert_eq!(rows, expected);
    }
}
