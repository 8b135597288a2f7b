//! Numbers that vary in time: one quantity, a sine, or a table.

use crate::scene::reader::{Range, Table};
use crate::scene::units::{ANGLE, FREQUENCY, Kind, TIME};
use anyhow::{Context, Result, ensure};
use lbm::Signal;
use std::path::Path;

/// The signal of `key`, a quantity of `kind`.
pub fn read(table: &Table, key: &'static str, kind: &Kind) -> Option<Signal> {
    if !table.is_table(key) {
        return table.quantity(key, kind, Range::Any).map(Signal::Steady);
    }
    let example = format!(
        "{key} = {{ mean = {0:?}, amplitude = {0:?}, frequency = \"1 Hz\" }}",
        kind.example
    );
    let signal = table.table(key, &example)?;
    match signal.present(&["amplitude", "times", "file"])[..] {
        ["amplitude"] => sine(&signal, kind),
        ["times"] => points(&signal, kind),
        ["file"] => file(&signal, key, kind),
        [] => {
            signal.present(&["mean", "frequency", "period", "phase", "values"]);
            signal.wrong_here(format!("says not how it varies; write e.g. {example}"));
            None
        }
        ref several => {
            signal.present(&["mean", "frequency", "period", "phase", "values"]);
            let several = several.join(" and ");
            signal.wrong_here(format!("has {several}; keep one of them"));
            None
        }
    }
}

fn sine(signal: &Table, kind: &Kind) -> Option<Signal> {
    let mean = signal.quantity_or("mean", kind, Range::Any, 0.0);
    let amplitude = signal.quantity("amplitude", kind, Range::Any);
    let phase = signal.quantity_or("phase", &ANGLE, Range::Any, 0.0);
    let frequency = match signal.present(&["frequency", "period"])[..] {
        ["frequency"] => signal.quantity("frequency", &FREQUENCY, Range::Positive),
        ["period"] => {
            let period = signal.quantity("period", &TIME, Range::Positive);
            period.map(|period| 1.0 / period)
        }
        [] => {
            signal.missing("frequency", "frequency = \"1 Hz\", or period = \"1 s\"");
            None
        }
        _ => {
            signal.wrong("period", "contradicts frequency; remove one of them".into());
            None
        }
    };
    Some(Signal::Sinusoidal {
        mean,
        amplitude: amplitude?,
        frequency: frequency?,
        phase,
    })
}

fn points(signal: &Table, kind: &Kind) -> Option<Signal> {
    let example = format!("values = [{0:?}, {0:?}]", kind.example);
    signal.missing("values", &example);
    let times = signal.quantities("times", &TIME, Range::Any);
    let values = signal.quantities("values", kind, Range::Any);
    let (times, values) = (times?, values?);
    if times.len() != values.len() {
        let (n, m) = (values.len(), times.len());
        signal.wrong(
            "values",
            format!("has {n} entries for {m} times; write {m}"),
        );
        return None;
    }
    if times.is_empty() {
        signal.wrong("times", "is empty; write e.g. [\"0 s\", \"1 s\"]".into());
        return None;
    }
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        signal.wrong("times", "do not increase; put them in order".into());
        return None;
    }
    let points = times.iter().zip(&values).map(|(&t, &x)| [t, x]);
    Some(Signal::Table(points.collect()))
}

fn file(signal: &Table, key: &str, kind: &Kind) -> Option<Signal> {
    let path = signal.path("file")?;
    let points = table_of(&path, key);
    points
        .map(Signal::Table)
        .map_err(|error| {
            let columns = format!("a header time,{key}, then seconds and {} a line", kind.unit);
            signal.wrong(
                "file",
                format!("cannot be read: {error:#}; it must have {columns}"),
            );
        })
        .ok()
}

/// A CSV file of two columns in SI units, `time` and `key`, in whatever order.
fn table_of(path: &Path, key: &str) -> Result<Vec<[f64; 2]>> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)?;
    let header = reader.headers()?.clone();
    let column = |name: &str| {
        let found = header.iter().position(|cell| cell == name);
        found.with_context(|| format!("no column is called {name}"))
    };
    let columns = [column("time")?, column(key)?];
    let mut points: Vec<[f64; 2]> = Vec::new();
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut point = [0.0f64; 2];
        for (to, &column) in point.iter_mut().zip(&columns) {
            let cell = record.get(column).unwrap_or_default();
            *to = cell
                .parse()
                .with_context(|| format!("line {line}: {cell:?} is not a number"))?;
            ensure!(to.is_finite(), "line {line}: {cell} is not a finite number");
        }
        let later = points.last().is_none_or(|last| last[0] < point[0]);
        ensure!(later, "line {line}: times must increase");
        points.push(point);
    }
    ensure!(!points.is_empty(), "it has no line of numbers");
    Ok(points)
}
