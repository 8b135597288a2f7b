//! The water between grains in a state.
//!
//! Layout, SI units: `pore_water/`, with `cells`, one row a cell, x fastest: `pressure`, `flux`,
//! `vapour`, one row a grain in the order of identities: `load`, and the `stiffness` of the
//! skeleton, if it is known.

use super::hdf::{get, get_rows, put, put_rows};
use crate::protocol::PastWater;
use anyhow::{Result, ensure};
use coupling::State;
use hdf5::File;

const GROUP: &str = "pore_water";

pub(super) fn write(file: &File, water: &PastWater) -> Result<()> {
    let group = file.create_group(GROUP)?;
    let state = &water.state;
    put(&group, "cells", "1", &water.cells.map(|n| n as u64))?;
    put(&group, "pressure", "Pa", &state.pressure)?;
    put_rows(&group, "flux", "m s-1", &state.flux, |q| *q)?;
    put(&group, "vapour", "m3", &state.vapour)?;
    put(&group, "load", "N", &state.loads)?;
    match water.stiffness {
        Some(stiffness) => put(&group, "stiffness", "Pa", &[stiffness]),
        None => Ok(()),
    }
}

/// The water of a state of so many `grains`; none: they are dry.
pub(super) fn read(file: &File, grains: usize) -> Result<Option<PastWater>> {
    if !file.link_exists(GROUP) {
        return Ok(None);
    }
    let group = file.group(GROUP)?;
    let cells: Vec<u64> = get(&group, "cells", 3)?;
    let cells = [0, 1, 2].map(|axis| cells[axis] as usize);
    let n = group.dataset("pressure")?.size();
    ensure!(
        cells.iter().product::<usize>() == n,
        "it has {n} pressures for {cells:?} cells"
    );
    let state = State {
        pressure: get(&group, "pressure", n)?,
        flux: get_rows(&group, "flux", n, |q| q)?,
        vapour: get(&group, "vapour", n)?,
        loads: get(&group, "load", grains)?,
    };
    let stiffness = match group.link_exists("stiffness") {
        true => Some(get::<f64>(&group, "stiffness", 1)?[0]),
        false => None,
    };
    Ok(Some(PastWater {
        cells,
        state,
        stiffness,
    }))
}
