//! All points in one file, `sweep.nc`, and a table of them, `points.csv`.

use super::coordinates::{dimensions, names};
use super::outcome::Outcome;
use super::results::{PLACES, summary};
use super::runs::Folder;
use super::series::{Column, Part, Series};
use crate::output::netcdf::{create, open};
use anyhow::{Context, Result};
use netcdf::{Extents, FileMut};
use std::path::Path;

/// Name of the file with all points.
pub const FILE: &str = "sweep.nc";
/// Name of the table of all points.
pub const POINTS: &str = "points.csv";

/// Where a point stands, with its number in the file.
const STATUS: [&str; 3] = ["done", "failed", "not_done"];

/// Level of zlib.
const DEFLATE: i32 = 2;

/// Write `sweep.nc` and `points.csv` into the folder of the sweep. Returns where each point stands:
/// nothing for one that is done, or why it is not.
///
/// A grid has a dimension for each varied quantity, in the order in which they were named; other
/// designs have the dimension `point`, along which the varied quantities are coordinates. Numbers of
/// a point are its last values, `NAME_final`, and means over the last fifth of its last phase,
/// `NAME_late`. Time series have the dimension `row` besides; where a point has fewer rows than the
/// longest, NaN follows (-1 in `phase`). Points that are not done are NaN all over.
///
/// # Errors
/// Files that cannot be read or written.
pub fn collect(folder: Folder) -> Result<Vec<Option<String>>> {
    let plan = folder.plan;
    let count = plan.ends.len();
    let (mut status, mut longest, mut first) = (Vec::new(), 0, None);
    let mut variables: Vec<Column> = Vec::new();
    let mut numbers: Vec<Column> = Vec::new();
    // Twice through all points, so that one at a time is in memory.
    for point in 0..count {
        let why = standing(folder, point)?;
        if why.is_none() {
            let series = Series::of(&parts(folder, point))?;
            longest = longest.max(series.time().len());
            first.get_or_insert(point);
            merge(&mut numbers, summary(&series));
            merge(&mut variables, series.columns);
        }
        status.push(why);
    }
    table(folder, &status)?;
    let mut file = create(&folder.path.join("sweep.nc.partial"))?;
    attributes(folder, &mut file, first)?;
    let names = names(&plan.design.axes, &variables, &numbers);
    let dims = dimensions(&plan.design, &mut file, &names)?;
    let dims: Vec<&str> = dims.iter().map(String::as_str).collect();
    file.add_dimension("row", longest.max(1))?;
    let along_rows = [&dims[..], &["row"]].concat();
    let places: Vec<&str> = PLACES
        .into_iter()
        .filter(|place| variables.iter().any(|own| own.name == *place))
        .collect();
    let own = if plan.design.grid { Vec::new() } else { names };
    let coordinates = |more: &[&str]| {
        let own = own.iter().map(String::as_str);
        own.chain(more.iter().copied())
            .collect::<Vec<_>>()
            .join(" ")
    };
    standings(folder, &mut file, &dims, &status, &coordinates(&[]))?;
    for column in &numbers {
        define(&mut file, column, &dims, &coordinates(&[]))?;
    }
    for column in &variables {
        let of_place = PLACES.contains(&column.name.as_str());
        let with = coordinates(if of_place { &[] } else { &places });
        define(&mut file, column, &along_rows, &with)?;
    }
    for (point, why) in status.iter().enumerate() {
        let index = plan.design.index(point);
        let series = match why.is_none() {
            true => Series::of(&parts(folder, point))?,
            false => Series::default(),
        };
        let own = summary(&series);
        for column in &numbers {
            let value = own.iter().find(|c| c.name == column.name);
            let value = value.map_or(f64::NAN, |c| c.values[0]);
            put(&mut file, &column.name, &index, &[], &[value])?;
        }
        for column in &variables {
            let values = series.column(&column.name);
            let mut values = values.map_or_else(Vec::new, |c| c.values.clone());
            let pad = if column.name == "phase" {
                -1.0
            } else {
                f64::NAN
            };
            values.resize(longest, pad);
            put(&mut file, &column.name, &index, &[longest], &values)?;
        }
    }
    drop(file);
    let whole = folder.path.join(FILE);
    std::fs::rename(folder.path.join("sweep.nc.partial"), &whole)
        .with_context(|| format!("cannot write {}", whole.display()))?;
    Ok(status)
}

/// Why a point is not done; none: it is.
fn standing(folder: Folder, point: usize) -> Result<Option<String>> {
    for run in folder.plan.chain(point) {
        let name = &folder.plan.runs[run].name;
        match folder.outcome(run)? {
            Some(Outcome::Done { .. }) => {}
            Some(Outcome::Failed { reason }) => return Ok(Some(format!("{name}: {reason}"))),
            None => return Ok(Some(format!("{name} is not done yet"))),
        }
    }
    Ok(None)
}

/// The files of a point, in the order of time.
fn parts(folder: Folder, point: usize) -> Vec<Part> {
    let mut parts = Vec::new();
    for run in folder.plan.chain(point) {
        let (own, phase) = (folder.of(run), folder.plan.runs[run].phase);
        let before = (1..).map(|n| own.join(format!("before-{n}")));
        let before = before.take_while(|path| path.exists());
        let all = before.chain([own.clone()]);
        parts.extend(all.map(|folder| Part { folder, phase }));
    }
    parts
}

/// Those of `more` that are new.
fn merge(columns: &mut Vec<Column>, more: Vec<Column>) {
    for mut column in more {
        if !columns.iter().any(|own| own.name == column.name) {
            column.values.clear();
            columns.push(column);
        }
    }
}

/// Where each point stands, and the folder of its last run.
fn standings(
    folder: Folder,
    file: &mut FileMut,
    dims: &[&str],
    status: &[Option<String>],
    coordinates: &str,
) -> Result<()> {
    let plan = folder.plan;
    let mut variable = file.add_variable::<i64>("status", dims)?;
    variable.put_attribute("long_name", "what became of the point")?;
    variable.put_attribute("flag_values", vec![0_i64, 1, 2])?;
    variable.put_attribute("flag_meanings", STATUS.join(" "))?;
    if !coordinates.is_empty() {
        variable.put_attribute("coordinates", coordinates)?;
    }
    let number = |point: usize| -> Result<i64> {
        let failed = plan.chain(point).into_iter().map(|run| folder.outcome(run));
        let failed = failed.collect::<Result<Vec<_>>>()?;
        let failed = failed
            .iter()
            .any(|o| matches!(o, Some(Outcome::Failed { .. })));
        Ok(match (&status[point], failed) {
            (None, _) => 0,
            (Some(_), true) => 1,
            (Some(_), false) => 2,
        })
    };
    let numbers = (0..status.len()).map(number).collect::<Result<Vec<_>>>()?;
    variable.put_values(&numbers, ..)?;
    let mut variable = file.add_string_variable("folder", dims)?;
    variable.put_attribute("long_name", "folder of the point's last run")?;
    if !coordinates.is_empty() {
        variable.put_attribute("coordinates", coordinates)?;
    }
    for (point, &run) in plan.ends.iter().enumerate() {
        let index: Extents = plan.design.index(point).as_slice().into();
        variable.put_string(&plan.runs[run].name, index)?;
    }
    Ok(())
}

fn define(file: &mut FileMut, column: &Column, dims: &[&str], coordinates: &str) -> Result<()> {
    let name = &column.name;
    let phase = name == "phase";
    let mut variable = match phase {
        true => file.add_variable::<i64>(name, dims)?,
        false => file.add_variable::<f64>(name, dims)?,
    };
    if dims.last() == Some(&"row") {
        let mut chunk: Vec<usize> = vec![1; dims.len()];
        let rows = variable.dimensions().last().map_or(1, |dim| dim.len());
        chunk[dims.len() - 1] = rows;
        variable.set_chunking(&chunk)?;
        variable.set_compression(DEFLATE, true)?;
    }
    if !phase {
        variable.set_fill_value(f64::NAN)?;
        variable.put_attribute("units", column.units.as_str())?;
    }
    variable.put_attribute("long_name", column.long_name.as_str())?;
    if !coordinates.is_empty() {
        variable.put_attribute("coordinates", coordinates)?;
    }
    Ok(())
}

/// Put `values` with the shape `inner` at the `index` of a point.
fn put(
    file: &mut FileMut,
    name: &str,
    index: &[usize],
    inner: &[usize],
    values: &[f64],
) -> Result<()> {
    let start = [index.to_vec(), vec![0; inner.len()]].concat();
    let count = [vec![1; index.len()], inner.to_vec()].concat();
    let mut variable = file.variable_mut(name).context("no such variable")?;
    if name == "phase" {
        let values: Vec<i64> = values.iter().map(|&v| v as i64).collect();
        variable.put_values(&values, (start, count))?;
    } else {
        variable.put_values(values, (start, count))?;
    }
    Ok(())
}

/// What is said about the whole, and by the files of the `first` point that is done.
fn attributes(folder: Folder, file: &mut FileMut, first: Option<usize>) -> Result<()> {
    let plan = folder.plan;
    file.add_attribute("Conventions", "CF-1.11")?;
    file.add_attribute("title", plan.title.as_str())?;
    file.add_attribute("scene", plan.scene.as_str())?;
    file.add_attribute("phases", plan.phases.join(" "))?;
    let axes = plan.design.axes.iter().map(|axis| axis.paths.join(", "));
    file.add_attribute("varied", axes.collect::<Vec<_>>().join("; "))?;
    file.add_attribute(
        "comment",
        "NAME_final: last value; NAME_late: mean over the last fifth of the last phase; along row: \
         time series, padded with NaN (phase: -1) to the length of the longest; phase counts \
         from 0 in the attribute phases; points that are not done are NaN",
    )?;
    let Some(first) = first else { return Ok(()) };
    let own = open(&folder.of(plan.ends[first]).join("series.nc"))?;
    for name in [
        "source", "version", "commit", "machine", "backend", "device",
    ] {
        if let Some(attribute) = own.attribute(name) {
            file.add_attribute(name, attribute.value()?)?;
        }
    }
    Ok(())
}

/// The table of all points: their values, where they stand, and why.
fn table(folder: Folder, status: &[Option<String>]) -> Result<()> {
    let (plan, path) = (folder.plan, folder.path.join(POINTS));
    let write = |path: &Path| -> Result<()> {
        let mut rows = csv::Writer::from_path(path)?;
        let axes = plan.design.axes.iter().map(|axis| axis.paths[0].as_str());
        let head = ["point"].into_iter().chain(axes);
        rows.write_record(head.chain(["status", "folder", "reason"]))?;
        for (point, why) in status.iter().enumerate() {
            let number = point.to_string();
            let values = plan.design.values(point);
            let word = if why.is_none() { "done" } else { "not done" };
            let end = [
                word,
                &plan.runs[plan.ends[point]].name,
                why.as_deref().unwrap_or_default(),
            ];
            let row = [number.as_str()].into_iter().chain(values).chain(end);
            rows.write_record(row)?;
        }
        Ok(rows.flush()?)
    };
    write(&path).with_context(|| format!("cannot write {}", path.display()))
}
