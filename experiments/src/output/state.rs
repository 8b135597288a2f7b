//! The complete state in one HDF5 file, bit for bit.
//!
//! Layout, SI units, vectors as rows of three: `time`; `grains/`, one row a grain in the
//! order of identities; `contacts/`, one row a contact, sorted by its two bodies, `j` being
//! -1 - w for wall w; `walls/`, one row a wall; `box/`, the sides; `past/`, what came before; and
//! `pore_water/`, where there is water between the grains.
//! Attributes tell the scene, version, commit, seed and machine. Only what is needed to go on
//! is needed to read the file; no compression, since the low bits of a state are noise.

mod contacts;
mod grains;
#[cfg(test)]
mod tests;

use super::hdf::{check_layout, finish, get, put, put_text, start};
use super::{Header, partial, pore_state};
use crate::protocol::{Past, Reference, Unfinished};
use anyhow::{Context, Result};
use dem::{Domain, State, WallState};
use hdf5::types::VarLenUnicode;
use hdf5::{File, Group};
use std::path::Path;

/// A state with what a scene needs besides to go on from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// Grains, contacts, walls.
    pub state: State,
    /// The box that they are in.
    pub domain: Domain,
    /// The protocol so far.
    pub past: Past,
}

/// Write `saved` to `path`; an existing file is replaced only once the new one is whole.
///
/// # Errors
/// A file that cannot be written.
pub fn save(path: &Path, saved: &Saved, header: &Header) -> Result<()> {
    let partial = partial(path);
    finish(path, &partial, write(&partial, saved, header))
}

/// Read what [`save`] wrote.
///
/// # Errors
/// A file that cannot be read, is no state, or contradicts itself.
pub fn load(path: &Path) -> Result<Saved> {
    read(path).with_context(|| format!("cannot read the state {}", path.display()))
}

fn write(path: &Path, saved: &Saved, header: &Header) -> Result<()> {
    let file = start(path, header)?;
    let state = &saved.state;
    put(&file, "time", "s", &[state.time])?;
    let group = file.create_group("box")?;
    put(&group, "size", "m", &saved.domain.size)?;
    put(
        &group,
        "periodic",
        "1",
        &saved.domain.periodic.map(u8::from),
    )?;
    write_past(&file.create_group("past")?, &saved.past)?;
    if let Some(water) = &saved.past.water {
        pore_state::write(&file, water)?;
    }

    grains::write(&file.create_group("grains")?, &state.grains)?;
    contacts::write(&file.create_group("contacts")?, &state.contacts)?;

    let walls = state.walls.iter();
    let group = file.create_group("walls")?;
    put(
        &group,
        "offset",
        "m",
        &walls.clone().map(|w| w.offset).collect::<Vec<_>>(),
    )?;
    put(
        &group,
        "velocity",
        "m s-1",
        &walls.map(|w| w.velocity).collect::<Vec<_>>(),
    )?;
    file.close()?;
    Ok(())
}

/// What an unfinished phase measures from is there only if there is such a phase.
fn write_past(group: &Group, past: &Past) -> Result<()> {
    put(group, "strain", "1", &[past.strain])?;
    if let Some(Unfinished { phase, reference }) = &past.unfinished {
        put_text(group, "unfinished", phase)?;
        put(group, "reference_time", "s", &[reference.time])?;
        put(group, "reference_height", "m", &[reference.height])?;
        put(group, "reference_way", "m", &[reference.way])?;
        put(group, "reference_strain", "1", &[reference.strain])?;
    }
    Ok(())
}

fn read_past(group: &Group) -> Result<Past> {
    let number = |name| get::<f64>(group, name, 1).map(|values| values[0]);
    let unfinished = if group.attr_names()?.iter().any(|name| name == "unfinished") {
        let phase = group.attr("unfinished")?.read_scalar::<VarLenUnicode>()?;
        let reference = Reference {
            time: number("reference_time")?,
            height: number("reference_height")?,
            way: number("reference_way")?,
            strain: number("reference_strain")?,
        };
        let phase = phase.to_string();
        Some(Unfinished { phase, reference })
    } else {
        None
    };
    let strain = number("strain")?;
    Ok(Past {
        strain,
        unfinished,
        water: None, // until it is read
    })
}

fn read_domain(group: &Group) -> Result<Domain> {
    let size: Vec<f64> = get(group, "size", 2)?;
    let periodic: Vec<u8> = get(group, "periodic", 2)?;
    Ok(Domain {
        size: [size[0], size[1]],
        periodic: [periodic[0] != 0, periodic[1] != 0],
    })
}

fn read(path: &Path) -> Result<Saved> {
    let file = File::open(path)?;
    check_layout(&file)?;
    let grains = grains::read(&file.group("grains").context("it has no grains")?)?;
    let n = grains.len();
    let group = file.group("walls")?;
    let n_walls = group.dataset("offset")?.size();
    let offset: Vec<f64> = get(&group, "offset", n_walls)?;
    let velocity: Vec<f64> = get(&group, "velocity", n_walls)?;
    let walls = offset.iter().zip(velocity);
    let walls = walls.map(|(&offset, velocity)| WallState { offset, velocity });

    let state = State {
        time: get::<f64>(&file, "time", 1)?[0],
        contacts: contacts::read(&file.group("contacts")?, n, n_walls)?,
        grains,
        walls: walls.collect(),
    };
    Ok(Saved {
        state,
        domain: read_domain(&file.group("box")?)?,
        past: Past {
            water: pore_state::read(&file, n)?,
            ..read_past(&file.group("past")?)?
        },
    })
}
