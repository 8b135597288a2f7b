//! Numbers with their units in HDF5 files of states.

use super::{Header, provenance};
use anyhow::{Context, Result, ensure};
use hdf5::types::VarLenUnicode;
use hdf5::{File, Group, H5Type, Location};
use ndarray::{ArrayView, ArrayView1, ArrayView2, Dimension};
use std::fs;
use std::path::Path;

/// Number of the layout of states; a change of it is a new number.
const LAYOUT: u32 = 2;

/// Let the file `partial`, if it was `written`, take the place of `path`.
pub fn finish(path: &Path, partial: &Path, written: Result<()>) -> Result<()> {
    written
        .and_then(|()| {
            fs::File::open(partial)?.sync_all()?;
            Ok(fs::rename(partial, path)?)
        })
        .inspect_err(|_| drop(fs::remove_file(partial)))
        .with_context(|| format!("cannot write the state {}", path.display()))
}

/// A new state with its attributes.
pub fn start(path: &Path, header: &Header) -> Result<File> {
    let file = File::create(path)?;
    let layout = file.new_attr::<u32>().create("esker_state_layout")?;
    layout.write_scalar(&LAYOUT)?;
    for (name, text) in provenance::texts(header) {
        put_text(&file, name, &text)?;
    }
    if let Some(seed) = header.seed {
        let attribute = file.new_attr::<u64>().create("seed")?;
        attribute.write_scalar(&seed)?;
    }
    Ok(file)
}

/// See that `file` is a state as this version writes it.
pub fn check_layout(file: &File) -> Result<()> {
    let layout = file
        .attr("esker_state_layout")
        .and_then(|a| a.read_scalar::<u32>());
    let layout = layout.context("not a state: it has no esker_state_layout")?;
    ensure!(
        layout == LAYOUT,
        "the state has layout {layout}, this version of esker reads {LAYOUT}"
    );
    Ok(())
}

/// Write numbers.
pub fn put<T: H5Type>(group: &Group, name: &str, units: &str, values: &[T]) -> Result<()> {
    put_array(group, name, units, ArrayView1::from(values))
}

/// Write one row of N numbers for each item.
pub fn put_rows<T, const N: usize>(
    group: &Group,
    name: &str,
    units: &str,
    items: &[T],
    row: impl Fn(&T) -> [f64; N],
) -> Result<()> {
    let rows: Vec<_> = items.iter().map(row).collect();
    put_array(group, name, units, ArrayView2::from(&rows[..]))
}

fn put_array<T: H5Type, D: Dimension>(
    group: &Group,
    name: &str,
    units: &str,
    values: ArrayView<T, D>,
) -> Result<()> {
    let dataset = group.new_dataset_builder().with_data(values).create(name)?;
    put_text(&dataset, "units", units)
}

/// Attach a text to a file, a group or a dataset.
pub fn put_text(to: &Location, name: &str, text: &str) -> Result<()> {
    let attribute = to.new_attr::<VarLenUnicode>().create(name)?;
    attribute.write_scalar(&text.parse::<VarLenUnicode>()?)?;
    Ok(())
}

/// Read `n` numbers.
pub fn get<T: H5Type>(group: &Group, name: &str, n: usize) -> Result<Vec<T>> {
    let place = || format!("{}/{name}", group.name());
    let values = group.dataset(name).and_then(|d| d.read_raw());
    let values: Vec<T> = values.with_context(place)?;
    ensure!(
        values.len() == n,
        "{} has {} numbers, not {n}",
        place(),
        values.len()
    );
    Ok(values)
}

/// Read `n` rows of N numbers.
pub fn get_rows<T, const N: usize>(
    group: &Group,
    name: &str,
    n: usize,
    item: impl Fn([f64; N]) -> T,
) -> Result<Vec<T>> {
    let values: Vec<f64> = get(group, name, N * n)?;
    let (rows, _) = values.as_chunks();
    Ok(rows.iter().map(|&row| item(row)).collect())
}
