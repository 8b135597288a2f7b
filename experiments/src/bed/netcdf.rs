//! Beds as NetCDF: `position`, `radius` and if present `velocity` and `angular_velocity`
//! over `grain`, the lengths of the box in the attribute `box_size`.

use super::Bed;
use crate::output::netcdf::{create, define, label, open, put};
use crate::output::provenance;
use anyhow::{Context, Result, ensure};
use dem::output::{Storage, Variable};
use glam::DVec3;
use ndarray::{Array1, Array2, ArrayD};
use netcdf::{Attribute, AttributeValue, File, FileMut};
use std::path::Path;

const RADIUS: Variable = variable("radius", &["grain"], "m", "radius of the grain");
const POSITION: Variable = vector("position", "m", "position of the grain");
const VELOCITY: Variable = vector("velocity", "m s-1", "velocity of the grain");
const ANGULAR_VELOCITY: Variable = vector(
    "angular_velocity",
    "rad s-1",
    "angular velocity of the grain",
);

const fn vector(name: &'static str, units: &'static str, long_name: &'static str) -> Variable {
    variable(name, &["grain", "component"], units, long_name)
}

const fn variable(
    name: &'static str,
    dims: &'static [&'static str],
    units: &'static str,
    long_name: &'static str,
) -> Variable {
    Variable {
        name,
        dims,
        units,
        long_name,
        storage: Storage::Double,
    }
}

/// Write `bed` to `path`; `from` is the file it came from.
pub fn write(path: &Path, bed: &Bed, from: &Path) -> Result<()> {
    let writing = || -> Result<()> {
        let mut file = create(path)?;
        file.add_attribute("Conventions", "CF-1.11")?;
        let name = from.file_name().unwrap_or_default().to_string_lossy();
        file.add_attribute("title", format!("bed from {name}"))?;
        file.add_attribute("version", provenance::VERSION)?;
        file.add_attribute("commit", provenance::COMMIT)?;
        if let Some(size) = bed.size {
            file.add_attribute("box_size", size.to_vec())?;
            file.add_attribute("box_size_units", "m")?;
        }
        file.add_dimension("grain", bed.len())?;
        label(
            &mut file,
            "component",
            "component of a vector",
            &["x", "y", "z"],
        )?;
        let radius = Array1::from_vec(bed.radius.clone()).into_dyn();
        add(&mut file, &RADIUS, &radius)?;
        add(&mut file, &POSITION, &rows(&bed.position))?;
        if let Some(velocity) = &bed.velocity {
            add(&mut file, &VELOCITY, &rows(velocity))?;
        }
        if let Some(spin) = &bed.angular_velocity {
            add(&mut file, &ANGULAR_VELOCITY, &rows(spin))?;
        }
        file.close()?;
        Ok(())
    };
    writing().with_context(|| format!("cannot write the bed {}", path.display()))
}

/// Read the bed at `path`.
pub fn read(path: &Path) -> Result<Bed> {
    let file = open(path)?;
    let radius = numbers(&file, &RADIUS)?.context("it has no variable \"radius\"")?;
    let n = radius.len();
    let size = file.attribute("box_size").map(lengths).transpose()?;
    Ok(Bed {
        position: vectors(&file, &POSITION, n)?.context("it has no variable \"position\"")?,
        velocity: vectors(&file, &VELOCITY, n)?,
        angular_velocity: vectors(&file, &ANGULAR_VELOCITY, n)?,
        radius,
        size,
    })
}

fn add(file: &mut FileMut, variable: &Variable, values: &ArrayD<f64>) -> Result<()> {
    define(file, variable, variable.dims, values.shape())?;
    put(file, variable, &vec![0; values.ndim()], values)
}

fn rows(values: &[DVec3]) -> ArrayD<f64> {
    Array2::from_shape_fn((values.len(), 3), |(k, c)| values[k][c]).into_dyn()
}

fn lengths(attribute: Attribute) -> Result<[f64; 3]> {
    let lengths = match attribute.value()? {
        AttributeValue::Doubles(lengths) => lengths.try_into().ok(),
        _ => None,
    };
    lengths.context("its box_size is not three lengths in double precision")
}

/// All values of a variable, if it is there with the dimensions that a bed has.
fn numbers(file: &File, expected: &Variable) -> Result<Option<Vec<f64>>> {
    let Some(found) = file.variable(expected.name) else {
        return Ok(None);
    };
    let dims: Vec<_> = found.dimensions().iter().map(|d| d.name()).collect();
    ensure!(
        dims == expected.dims,
        "its variable \"{}\" has the dimensions {dims:?}; a bed has {:?}",
        expected.name,
        expected.dims
    );
    Ok(Some(found.get_values(..)?))
}

fn vectors(file: &File, expected: &Variable, n: usize) -> Result<Option<Vec<DVec3>>> {
    let Some(values) = numbers(file, expected)? else {
        return Ok(None);
    };
    let name = expected.name;
    ensure!(
        values.len() == 3 * n,
        "its variable \"{name}\" has not three components"
    );
    let (rows, _) = values.as_chunks();
    Ok(Some(
        rows.iter().map(|&row| DVec3::from_array(row)).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::super::read as read_any;
    use super::*;

    #[test]
    fn a_bed_comes_back_bit_for_bit() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("bed.nc");
        let v = |x: f64| DVec3::new(x, 2.0 / x, -1.0 / 3.0);
        let mut bed = Bed {
            position: vec![v(0.1), v(0.7)],
            radius: vec![1.0 / 3.0, 1e-2],
            velocity: Some(vec![v(3.0), v(7.0)]),
            angular_velocity: Some(vec![v(11.0), v(13.0)]),
            size: Some([0.1, 0.2, 0.3]),
        };
        write(&path, &bed, Path::new("old/grains.csv")).unwrap();
        assert_eq!(read_any(&path).unwrap(), bed);

        bed = Bed {
            velocity: None,
            angular_velocity: None,
            size: None,
            ..bed
        };
        write(&path, &bed, Path::new("old/grains.csv")).unwrap();
        assert_eq!(read_any(&path).unwrap(), bed);
    }

    #[test]
    fn other_netcdf_files_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("other.nc");
        let mut file = create(&path).unwrap();
        file.add_dimension("time", 1).unwrap();
        let error = || format!("{:#}", read_any(&path).unwrap_err());
        file.close().unwrap();
        assert!(error().contains("no variable \"radius\""), "{}", error());

        let mut file = create(&path).unwrap();
        file.add_dimension("time", 1).unwrap();
        let radius = Variable {
            dims: &["time"],
            ..RADIUS
        };
        add(&mut file, &radius, &ArrayD::zeros(vec![1])).unwrap();
        file.close().unwrap();
        let expected = "\"radius\" has the dimensions [\"time\"]; a bed has [\"grain\"]";
        assert!(error().contains(expected), "{}", error());
    }
}
