//! NetCDF-4 as all our files use it: every variable with units and a long name, chunked
//! and compressed, so that xarray labels axes by itself.

use anyhow::{Context, Result, ensure};
use dem::output::{Storage, Variable};
use ndarray::ArrayD;
use netcdf::{AttributeValue, File, FileMut};
use std::path::Path;

/// Level of zlib: higher ones are slower and hardly smaller on shuffled floats.
const DEFLATE: i32 = 2;

/// Make the file at `path`; one that is there is replaced.
pub fn create(path: &Path) -> Result<FileMut> {
    keep_quiet();
    netcdf::create(path).with_context(|| format!("cannot make {}", path.display()))
}

/// Open the file at `path` to read it.
pub fn open(path: &Path) -> Result<File> {
    keep_quiet();
    netcdf::open(path).with_context(|| format!("cannot open {}", path.display()))
}

/// Stop HDF5 from printing its inner errors, such as the absence of an optional attribute,
/// from this thread. Those that matter come back as errors.
pub fn keep_quiet() {
    hdf5::silence_errors(true);
}

/// Define `variable` over the dimensions `dims`, kept in chunks of the size `chunk`.
///
/// Floats of a row that was never written read as NaN. Whole numbers have no fill value,
/// which would make xarray turn them into floats, nor have coordinates, which CF forbids.
pub fn define(
    file: &mut FileMut,
    variable: &Variable,
    dims: &[&str],
    chunk: &[usize],
) -> Result<()> {
    let name = variable.name;
    let mut made = match variable.storage {
        Storage::Double => file.add_variable::<f64>(name, dims)?,
        Storage::Single => file.add_variable::<f32>(name, dims)?,
        Storage::Integer => file.add_variable::<i64>(name, dims)?,
    };
    if !dims.is_empty() {
        made.set_chunking(chunk)?;
        made.set_compression(DEFLATE, true)?;
    }
    let in_rows = made
        .dimensions()
        .first()
        .is_some_and(|dim| dim.is_unlimited());
    let coordinate = dims.first() == Some(&name);
    match variable.storage {
        Storage::Double if in_rows && !coordinate => made.set_fill_value(f64::NAN)?,
        Storage::Single if in_rows && !coordinate => made.set_fill_value(f32::NAN)?,
        _ => {}
    }
    made.put_attribute("units", variable.units)?;
    made.put_attribute("long_name", variable.long_name)?;
    Ok(())
}

/// Name the entries of a dimension, such as the components of a vector.
pub fn label(file: &mut FileMut, dimension: &str, long_name: &str, labels: &[&str]) -> Result<()> {
    file.add_dimension(dimension, labels.len())?;
    let mut made = file.add_string_variable(dimension, &[dimension])?;
    made.put_attribute("long_name", long_name)?;
    for (k, label) in labels.iter().enumerate() {
        made.put_string(label, k)?;
    }
    Ok(())
}

/// Add an attribute to the variable `name`.
pub fn describe(
    file: &mut FileMut,
    name: &str,
    key: &str,
    value: impl Into<AttributeValue>,
) -> Result<()> {
    let mut variable = file.variable_mut(name).context("no such variable")?;
    variable.put_attribute(key, value)?;
    Ok(())
}

/// Write `values` into `variable`, the first one at the index `start`.
///
/// `start` may have more entries than `values` has dimensions: the leading ones are those
/// of a row.
pub fn put(
    file: &mut FileMut,
    variable: &Variable,
    start: &[usize],
    values: &ArrayD<f64>,
) -> Result<()> {
    let mut made = file
        .variable_mut(variable.name)
        .context("no such variable")?;
    let rows = start.len() - values.ndim();
    let count = [vec![1; rows], values.shape().to_vec()].concat();
    for (dim, (s, c)) in made.dimensions().iter().zip(start.iter().zip(&count)) {
        // NetCDF would say only that an index exceeds a bound.
        let room = dim.is_unlimited() || s + c <= dim.len();
        ensure!(
            room,
            "{} has {c} entries along {}, which holds {}",
            variable.name,
            dim.name(),
            dim.len()
        );
    }
    let extents = (start.to_vec(), count);
    let values = values.iter();
    match variable.storage {
        Storage::Double => made.put_values(&values.copied().collect::<Vec<_>>(), extents)?,
        Storage::Single => {
            let values: Vec<_> = values.map(|&v| v as f32).collect();
            made.put_values(&values, extents)?;
        }
        Storage::Integer => {
            let values: Vec<_> = values.map(|&v| v as i64).collect();
            made.put_values(&values, extents)?;
        }
    }
    Ok(())
}
