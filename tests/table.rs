//! Tables of reference data, read by the names of their columns.

use glam::DVec3;
use std::path::Path;

/// A table of numbers from a CSV file with a header.
pub struct Table {
    columns: Vec<String>,
    /// One entry for each line after the header.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// Read `tests/reference/<name>`.
    ///
    /// # Panics
    /// If it is missing or not a table of numbers.
    pub fn read(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("reference")
            .join(name);
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines();
        let header = lines.next().expect("a header");
        let number = |word: &str| word.parse().expect("a number");
        Self {
            columns: header.split(',').map(str::to_owned).collect(),
            rows: lines
                .map(|line| line.split(',').map(number).collect())
                .collect(),
        }
    }

    /// Where the column `name` stands.
    pub fn column(&self, name: &str) -> usize {
        let found = self.columns.iter().position(|column| column == name);
        found.unwrap_or_else(|| panic!("no column {name} among {:?}", self.columns))
    }

    /// The value of `row` in column `name`.
    pub fn get(&self, row: &[f64], name: &str) -> f64 {
        row[self.column(name)]
    }

    /// Three columns `x`, `y`, `z` with `before` and `after` around these letters.
    pub fn vector(&self, row: &[f64], before: &str, after: &str) -> DVec3 {
        let part = |axis: &str| self.get(row, &format!("{before}{axis}{after}"));
        DVec3::new(part("x"), part("y"), part("z"))
    }
}
