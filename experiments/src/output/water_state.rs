//! The complete state of water in one HDF5 file, bit for bit.
//!
//! Layout, SI units: `water/`, with `time`, `cells`, the `thickness` of the cells, the `step` and
//! the `lattice_density` by which populations are measured, and one row a cell, x fastest: `pressure`, `flux`, and the 19 `populations` in lattice units. Attributes as
//! in the state of grains.

use super::hdf::{check_layout, finish, get, get_rows, put, put_rows, start};
use super::{Header, partial};
use anyhow::{Context, Result, ensure};
use hdf5::File;
use lbm::State;
use std::path::Path;

/// A state with the lattice that it is of.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedWater {
    /// Number of cells along x, y, z.
    pub cells: [usize; 3],
    /// Time step of the lattice [s].
    pub step: f64,
    /// Its density [kg/m³]; populations mean something only with these two.
    pub density: f64,
    /// The water.
    pub state: State,
}

/// Write `saved` to `path`; an existing file is replaced only once the new one is whole.
///
/// # Errors
/// A file that cannot be written.
pub fn save(path: &Path, saved: &SavedWater, header: &Header) -> Result<()> {
    let partial = partial(path);
    finish(path, &partial, write(&partial, saved, header))
}

/// Read what [`save`] wrote.
///
/// # Errors
/// A file that cannot be read, is no state of water, or contradicts itself.
pub fn load(path: &Path) -> Result<SavedWater> {
    read(path).with_context(|| format!("cannot read the state {}", path.display()))
}

fn write(path: &Path, saved: &SavedWater, header: &Header) -> Result<()> {
    let file = start(path, header)?;
    let group = file.create_group("water")?;
    let state = &saved.state;
    put(&group, "time", "s", &[state.time])?;
    put(&group, "thickness", "m", &[state.thickness])?;
    put(&group, "cells", "1", &saved.cells.map(|n| n as u64))?;
    put(&group, "step", "s", &[saved.step])?;
    put(&group, "lattice_density", "kg m-3", &[saved.density])?;
    put(&group, "pressure", "Pa", &state.pressure)?;
    put_rows(&group, "flux", "m s-1", &state.flux, |q| *q)?;
    put_rows(&group, "populations", "1", &state.populations, |f| *f)?;
    file.close()?;
    Ok(())
}

fn read(path: &Path) -> Result<SavedWater> {
    let file = File::open(path)?;
    check_layout(&file)?;
    let group = file
        .group("water")
        .context("it is a state of grains, without water")?;
    let cells: Vec<u64> = get(&group, "cells", 3)?;
    let cells = [0, 1, 2].map(|axis| cells[axis] as usize);
    let n = group.dataset("pressure")?.size();
    ensure!(
        cells.iter().product::<usize>() == n,
        "it has {n} pressures for {cells:?} cells"
    );
    let state = State {
        time: get(&group, "time", 1)?[0],
        thickness: get(&group, "thickness", 1)?[0],
        pressure: get(&group, "pressure", n)?,
        flux: get_rows(&group, "flux", n, |q| q)?,
        populations: get_rows(&group, "populations", n, |f| f)?,
    };
    Ok(SavedWater {
        cells,
        step: get(&group, "step", 1)?[0],
        density: get(&group, "lattice_density", 1)?[0],
        state,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_the_water_comes_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("state.h5");
        let saved = SavedWater {
            cells: [2, 1, 1],
            step: 1.0 / 7.0,
            density: 999.8,
            state: State {
                time: 0.1 + 0.2,
                thickness: 1.0 / 3.0,
                pressure: vec![-0.1, 1e-310],
                flux: vec![[1.0 / 3.0, -2.0, 0.5], [1e300, 0.1, -0.0]],
                populations: vec![[1.0 / 7.0; 19], std::array::from_fn(|k| 0.1 * k as f64)],
            },
        };
        let header = Header {
            title: "two cells".into(),
            scene: String::new(),
            seed: None,
            backend: "cpu",
            device: "a processor".into(),
        };
        save(&path, &saved, &header).unwrap();
        assert_eq!(load(&path).unwrap(), saved);
        let names: Vec<_> = std::fs::read_dir(&dir).unwrap().collect();
        assert_eq!(names.len(), 1, "nothing is left beside the state");
        let error = format!("{:#}", super::super::state::load(&path).unwrap_err());
        assert!(error.contains("grains"), "{error}");
    }
}
