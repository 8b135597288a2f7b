//! When which file gets a row.

use crate::scene::Output;

/// Intervals of the files in steps, counted from the start of each phase; none: the file
/// is not written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intervals {
    series: Option<u64>,
    profiles: Option<u64>,
    grains: Option<u64>,
    contacts: Option<u64>,
}

/// Which files get a row now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Due {
    pub series: bool,
    pub profiles: bool,
    pub grains: bool,
    pub contacts: bool,
}

impl Due {
    /// The first row of a run: all but the series, whose means need an interval. The
    /// writer leaves out the files that there are not.
    pub const START: Self = Self {
        series: false,
        profiles: true,
        grains: true,
        contacts: true,
    };

    /// Is there any?
    pub fn any(self) -> bool {
        self.series || self.profiles || self.grains || self.contacts
    }
}

impl Intervals {
    /// The intervals nearest to those of `output`, in whole steps of `step` [s].
    pub fn new(output: &Output, step: f64) -> Self {
        let steps = |every: f64| ((every / step).round() as u64).max(1);
        let of = |file: &Option<crate::scene::output::File>| file.as_ref().map(|f| steps(f.every));
        Self {
            series: of(&output.series),
            profiles: of(&output.profiles),
            grains: of(&output.grains),
            contacts: of(&output.contacts),
        }
    }

    /// The first step after `done` at which a file gets a row.
    pub fn next(&self, done: u64) -> u64 {
        let all = [self.series, self.profiles, self.grains, self.contacts];
        let each = all.into_iter().flatten().map(|n| (done / n + 1) * n);
        each.min().unwrap_or(u64::MAX)
    }

    /// What is due after `done` steps.
    pub fn due(&self, done: u64) -> Due {
        let is = |every: Option<u64>| every.is_some_and(|n| done.is_multiple_of(n));
        Due {
            series: is(self.series),
            profiles: is(self.profiles),
            grains: is(self.grains),
            contacts: is(self.contacts),
        }
    }

    /// At the end of a phase every file gets a row.
    pub fn last(&self) -> Due {
        Due {
            series: self.series.is_some(),
            profiles: self.profiles.is_some(),
            grains: self.grains.is_some(),
            contacts: self.contacts.is_some(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_due_at_multiples_of_their_intervals() {
        let intervals = Intervals {
            series: Some(10),
            profiles: None,
            grains: Some(25),
            contacts: None,
        };
        let mut at = 0;
        let mut rows = Vec::new();
        while at < 60 {
            at = intervals.next(at);
            rows.push((at, intervals.due(at).series, intervals.due(at).grains));
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
