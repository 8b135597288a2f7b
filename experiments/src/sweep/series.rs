//! The time series of a point: those of its runs, joined as if it had been one.

use crate::output::netcdf::open;
use anyhow::{Context, Result};
use netcdf::AttributeValue;
use std::path::{Path, PathBuf};

/// A variable of `series.nc`.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its units.
    pub units: String,
    /// What it is.
    pub long_name: String,
    /// One value for each row.
    pub values: Vec<f64>,
}

/// Rows of all that is written over time; the first column is `time`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// The variables.
    pub columns: Vec<Column>,
    /// The first row of the last run.
    pub last: usize,
}

/// Where the files of a run are, and the number of its phase.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its folder.
    pub folder: PathBuf,
    /// Its phase.
    pub phase: usize,
}

impl Series {
    /// The rows of a run and of all that came before it: the runs that it starts from, and what it
    /// had done before it was stopped.
    ///
    /// # Errors
    /// Files that cannot be read.
    pub fn of(parts: &[Part]) -> Result<Self> {
        let mut joined = Self::default();
        for (k, part) in parts.iter().enumerate() {
            let mut own = Self::read(&part.folder.join("series.nc"))?;
            // In its own file each phase is the first.
            if let Some(phase) = own.columns.iter_mut().find(|c| c.name == "phase") {
                phase.values.fill(part.phase as f64);
            }
            let goes_on = k > 0 && parts[k - 1].phase == part.phase;
            let last = joined.last;
            joined.append(own);
            if goes_on {
                joined.last = last;
            }
        }
        Ok(joined)
    }

    /// The column called `name`.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The time of each row [s].
    pub fn time(&self) -> &[f64] {
        self.column("time").map_or(&[], |time| &time.values)
    }

    fn read(path: &Path) -> Result<Self> {
        let file = open(path)?;
        let mut columns = Vec::new();
        for variable in file.variables() {
            let dims: Vec<_> = variable.dimensions().iter().map(|d| d.name()).collect();
            if dims != ["time"] {
                continue;
            }
            let text = |key| match variable.attribute_value(key) {
                Some(Ok(AttributeValue::Str(text))) => text,
                _ => String::new(),
            };
            let values = variable.get_values::<f64, _>(..);
            columns.push(Column {
                name: variable.name(),
                units: text("units"),
                long_name: text("long_name"),
                values: values.with_context(|| format!("cannot read {}", path.display()))?,
            });
        }
        Ok(Self { columns, last: 0 })
    }

    /// Let `next` follow. Where it starts earlier than this ends, what is later here was lost when
    /// the run was killed; its first row is the last one here, unless there is none.
    fn append(&mut self, mut next: Self) {
        if self.columns.is_empty() {
            *self = next;
            return;
        }
        let Some(&begin) = next.time().first() else {
            return;
        };
        let kept = self.time().partition_point(|&t| t <= begin);
        let again = kept > 0 && self.time()[kept - 1] == begin;
        self.last = if again { kept - 1 } else { kept };
        for column in &mut self.columns {
            column.values.truncate(kept);
            let rows = next.time().len();
            let own = next.columns.iter_mut().find(|c| c.name == column.name);
            let values = own.map_or(vec![f64::NAN; rows], |own| own.values.clone());
            column.values.extend(&values[usize::from(again)..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(time: &[f64], value: f64) -> Series {
        let column = |name: &str, values| Column {
            name: name.into(),
            units: "1".into(),
            long_name: String::new(),
            values,
        };
        let columns = vec![
            column("time", time.to_vec()),
            column("x", vec![value; time.len()]),
        ];
        Series { columns, last: 0 }
    }

    #[test]
    fn a_row_at_the_same_time_is_there_once_and_what_was_lost_is_gone() {
        let mut joined = series(&[0.0, 1.0, 2.0], 1.0);
        joined.append(series(&[2.0, 3.0, 4.0], 2.0));
        assert_eq!(joined.time(), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(joined.columns[1].values, [1.0, 1.0, 1.0, 2.0, 2.0]);
        assert_eq!(joined.last, 2);
        joined.append(series(&[2.5, 3.5], 3.0));
        assert_eq!(joined.time(), [0.0, 1.0, 2.0, 2.5, 3.5]);
        assert_eq!(joined.columns[1].values, [1.0, 1.0, 1.0, 3.0, 3.0]);
        assert_eq!(joined.last, 3);
    }
}
