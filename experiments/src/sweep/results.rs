//! What a point has come to in single numbers: the value at its end, and the mean over the last
//! fifth of its last phase.

use super::series::{Column, Series};

/// The coordinates of rows, which have no means.
pub const PLACES: [&str; 3] = ["time", "phase", "strain"];

/// The part of the last phase over which means are taken.
const LATE: f64 = 0.2;

/// The numbers of a point; means of variables that are written as means since the row before, such
/// as `shear_stress_top_mean`, are exact, and stand for those of the instants.
pub fn summary(series: &Series) -> Vec<Column> {
    let single = |column: &Column, kind: &str, what: &str, value: f64| Column {
        name: format!("{}_{kind}", column.name),
        units: column.units.clone(),
        long_name: format!("{}, {what}", column.long_name),
        values: vec![value],
    };
    let mut numbers = Vec::new();
    for column in &series.columns {
        let instant = column.name.strip_suffix("_mean");
        let instant = instant.and_then(|name| series.column(name));
        let has_means = series.column(&format!("{}_mean", column.name)).is_some();
        if instant.is_none() && column.name != "phase" {
            let last = column.values.last().copied().unwrap_or(f64::NAN);
            numbers.push(single(column, "final", "at the end", last));
        }
        if !has_means && !PLACES.contains(&column.name.as_str()) {
            let of = instant.unwrap_or(column);
            let what = "mean over the last fifth of the last phase";
            numbers.push(single(of, "late", what, late_mean(series, column)));
        }
    }
    numbers
}

/// Mean weighted by the time since the row before; NaN where a value is missing.
fn late_mean(series: &Series, column: &Column) -> f64 {
    let time = series.time();
    let (Some(&begin), Some(&end)) = (time.get(series.last), time.last()) else {
        return f64::NAN;
    };
    let from = end - LATE * (end - begin);
    let (mut sum, mut whole) = (0.0, 0.0);
    for k in (series.last + 1..time.len()).filter(|&k| time[k] > from) {
        let part = time[k] - time[k - 1];
        (sum, whole) = (sum + part * column.values[k], whole + part);
    }
    sum / whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_of_the_last_fifth_of_the_last_phase() {
        let column = |name: &str, values: Vec<f64>| Column {
            name: name.into(),
            units: "Pa".into(),
            long_name: name.into(),
            values,
        };
        let time: Vec<f64> = (0..=20).map(f64::from).collect();
        let x = time.iter().map(|t| t * t).collect();
        let mut x_mean = vec![0.0; 21];
        x_mean[19..].copy_from_slice(&[4.0, 6.0]);
        let columns = vec![
            column("time", time),
            column("x", x),
            column("x_mean", x_mean),
            column("y", vec![2.0; 21]),
        ];
        let found = summary(&Series { columns, last: 10 });
        let found: Vec<_> = found.iter().map(|c| (&*c.name, c.values[0])).collect();
        let expected = [
            ("time_final", 20.0),
            ("x_final", 400.0),
            ("x_late", 5.0),
            ("y_final", 2.0),
            ("y_late", 2.0),
        ];
        assert_eq!(found, expected);
    }
}
