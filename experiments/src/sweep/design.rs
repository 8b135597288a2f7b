//! Which points a sweep has: a grid, a list from a CSV file, or a Latin hypercube.

use super::axis::{Axis, Span};
use super::hypercube::hypercube;
use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The points of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// What is varied.
    pub axes: Vec<Axis>,
    /// Is every value of an axis combined with every one of the others? Else they go together, the
    /// first with the first.
    pub grid: bool,
}

/// More are a slip of the pen.
const MOST: usize = 1_000_000;

impl Design {
    /// Every combination of the values, each argument of the form `PATH=V1,V2,...`.
    ///
    /// # Errors
    /// The first argument that is wrong.
    pub fn grid(arguments: &[String]) -> Result<Self> {
        let axes = arguments.iter().map(|argument| Axis::read(argument));
        let axes = axes.collect::<Result<_>>()?;
        Self { axes, grid: true }.checked()
    }

    /// The points of a CSV file whose header names the paths.
    ///
    /// # Errors
    /// A file that cannot be read, or holds no point.
    pub fn list(path: &Path) -> Result<Self> {
        let read = || -> Result<Self> {
            let mut rows = csv::ReaderBuilder::new()
                .trim(csv::Trim::All)
                .comment(Some(b'#'))
                .from_path(path)?;
            let axis = |path: &str| Axis {
                paths: vec![path.into()],
                values: Vec::new(),
            };
            let mut axes: Vec<Axis> = rows.headers()?.iter().map(axis).collect();
            ensure!(
                axes.iter().all(|axis| !axis.paths[0].is_empty()),
                "a column has no path above it; write e.g. phase.shear.top.normal_stress"
            );
            for row in rows.records() {
                let row = row?;
                for (axis, value) in axes.iter_mut().zip(&row) {
                    let line = row.position().map_or(0, csv::Position::line);
                    let path = &axis.paths[0];
                    ensure!(!value.is_empty(), "line {line}: {path} has no value");
                    axis.values.push(value.into());
                }
            }
            ensure!(!axes[0].values.is_empty(), "it holds no point");
            Self { axes, grid: false }.checked()
        };
        read().with_context(|| format!("cannot take the points from {}", path.display()))
    }

    /// So many points of a Latin hypercube, each argument of the form `PATH=LOW..HIGH UNIT`.
    ///
    /// # Errors
    /// The first argument that is wrong.
    pub fn hypercube(arguments: &[String], points: usize, seed: u64) -> Result<Self> {
        let spans = arguments.iter().map(|argument| Span::read(argument));
        let axes = hypercube(&spans.collect::<Result<Vec<_>>>()?, points, seed);
        Self { axes, grid: false }.checked()
    }

    fn checked(self) -> Result<Self> {
        ensure!(
            !self.axes.is_empty(),
            "nothing is varied; write e.g. --vary seed=1,2,3"
        );
        let paths: Vec<&String> = self.axes.iter().flat_map(|axis| &axis.paths).collect();
        for (k, path) in paths.iter().enumerate() {
            ensure!(
                !paths[..k].contains(path),
                "{path} is varied twice; write all its values behind one --vary"
            );
        }
        let each = self.axes.iter().map(|axis| axis.values.len());
        let points = each.fold(1, usize::saturating_mul);
        ensure!(
            !self.grid || points <= MOST,
            "the grid has {points} points, more than {MOST}; leave values out, or write --hypercube"
        );
        Ok(self)
    }

    /// Lengths of the dimensions of its points.
    pub fn shape(&self) -> Vec<usize> {
        match self.grid {
            true => self.axes.iter().map(|axis| axis.values.len()).collect(),
            false => vec![self.axes[0].values.len()],
        }
    }

    /// Number of points.
    pub fn count(&self) -> usize {
        self.shape().iter().product()
    }

    /// Index of a point along each dimension; the last one runs fastest.
    pub fn index(&self, point: usize) -> Vec<usize> {
        let (shape, mut rest) = (self.shape(), point);
        let mut index = vec![0; shape.len()];
        for (k, length) in shape.iter().enumerate().rev() {
            (index[k], rest) = (rest % length, rest / length);
        }
        index
    }

    /// The value of each axis at a point.
    pub fn values(&self, point: usize) -> Vec<&str> {
        let index = self.index(point);
        let each = self.axes.iter().enumerate();
        each.map(|(k, axis)| axis.values[index[if self.grid { k } else { 0 }]].as_str())
            .collect()
    }

    /// What a point sets in the scene: `PATH=VALUE`.
    pub fn sets(&self, point: usize) -> Vec<String> {
        let each = self.axes.iter().zip(self.values(point));
        let sets = each.flat_map(|(axis, value)| {
            let set = move |path| format!("{path}={value}");
            axis.paths.iter().map(set)
        });
        sets.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_axis_of_a_grid_runs_fastest() {
        let grid = Design::grid(&["a,c=1,2".into(), "b=5,6,7 m".into()]).unwrap();
        assert_eq!((grid.shape(), grid.count()), (vec![2, 3], 6));
        assert_eq!(grid.index(4), [1, 1]);
        assert_eq!(grid.sets(4), ["a=2", "c=2", "b=6 m"]);
        assert_eq!(grid.sets(2), ["a=1", "c=1", "b=7 m"]);
    }

    #[test]
    fn a_list_comes_from_a_table_whose_header_names_the_paths() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        let of = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Design::list(&path)
        };
        let list = of("# two beds\nseed, phase.shear.friction\n1, 0.5\n2, none\n").unwrap();
        assert_eq!((list.shape(), list.grid), (vec![2], false));
        assert_eq!(list.sets(1), ["seed=2", "phase.shear.friction=none"]);
        for (text, what) in [
            ("seed\n", "no point"),
            ("seed,a\n1,\n", "line 2: a has no value"),
            ("seed,\n1,2\n", "no path above it"),
            ("seed,a\n1\n", "2 fields"),
            ("a,a\n1,2\n", "a is varied twice"),
        ] {
            let error = format!("{:#}", of(text).unwrap_err());
            assert!(
                error.contains(what) && error.contains("points.csv"),
                "{error}"
            );
        }
    }
}
