//! Data files of `atom_style sphere`, as `write_data` makes them.

use super::{Corners, Lines, Row, bed, check_tilt, check_units, number, uncommented, vector};
use crate::bed::Bed;
use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;

/// Does this line of a data file count the atoms, as in `1000 atoms`?
pub fn counts_atoms(line: &str) -> bool {
    let mut words = uncommented(line).split_whitespace();
    let count = words.next().is_some_and(|word| word.parse::<u64>().is_ok());
    count && words.eq(["atoms"])
}

/// Read the data file at `path`.
pub fn read_data(path: &Path) -> Result<Bed> {
    let mut lines = Lines::open(path)?;
    let title = lines.next()?.unwrap_or_default();
    if let Some((_, units)) = title.split_once("units = ") {
        check_units(units.split([',', ' ']).next().unwrap_or_default())?;
    }
    let mut corners = Corners::unknown();
    let mut told = None;
    let mut rows = Vec::new();
    let mut last_row = String::new();
    let mut motion = None;
    let mut section = String::new();
    while let Some(line) = lines.next()? {
        let words: Vec<_> = uncommented(&line).split_whitespace().collect();
        let Some(first) = words.first() else { continue };
        if first.starts_with(char::is_alphabetic) {
            section = words.join(" ");
            let style = line
                .split_once('#')
                .map_or("sphere", |(_, style)| style.trim());
            ensure!(
                section != "Atoms" || style == "sphere",
                "{}: atoms of the style {style}; only those of the style sphere have a radius",
                lines.place()
            );
            if section == "Velocities" {
                motion = Some(HashMap::new());
            }
            continue;
        }
        match section.as_str() {
            "" if counts_atoms(&line) => told = Some((number::<usize>(first)?, lines.place())),
            "" => read_header(&words, &mut corners).with_context(|| lines.place())?,
            "Atoms" => {
                rows.push(read_atom(&words).with_context(|| lines.place())?);
                last_row = format!(", the last on {}", lines.place());
            }
            "Velocities" => {
                let (id, velocities) = read_motion(&words).with_context(|| lines.place())?;
                motion.get_or_insert_default().insert(id, velocities);
            }
            _ => {}
        }
    }
    let (count, place) = told.context("no line counts the atoms, as in 1000 atoms")?;
    ensure!(
        rows.len() == count,
        "{} of {count} atoms found{last_row}, where {place} promises {count}; \
         the file is not whole",
        rows.len()
    );
    if let Some(motion) = motion {
        for row in &mut rows {
            let velocities = motion.get(&row.id);
            let [velocity, angular_velocity] = *velocities.with_context(|| {
                let id = row.id;
                format!("grain {id} has no velocity where others have; the file is not whole")
            })?;
            row.velocity = Some(velocity);
            row.angular_velocity = Some(angular_velocity);
        }
    }
    bed(rows, corners)
}

/// A line before the first section: only the box matters.
fn read_header(words: &[&str], corners: &mut Corners) -> Result<()> {
    let axis = match words {
        [_, _, "xlo", "xhi"] => 0,
        [_, _, "ylo", "yhi"] => 1,
        [_, _, "zlo", "zhi"] => 2,
        [tilt @ .., "xy", "xz", "yz"] => return check_tilt(tilt),
        _ => return Ok(()),
    };
    corners.low[axis] = number(words[0])?;
    corners.high[axis] = number(words[1])?;
    Ok(())
}

/// `id type diameter density x y z`, and image flags, which do not matter inside the box.
fn read_atom(words: &[&str]) -> Result<Row> {
    let [id, _type, diameter, _density, x, y, z, images @ ..] = words else {
        bail!("an atom of the style sphere has id, type, diameter, density, x, y and z");
    };
    let known = images.is_empty() || images.len() == 3;
    ensure!(
        known,
        "{} numbers; the style sphere has 7, or 10 with images",
        words.len()
    );
    Ok(Row {
        id: number(id)?,
        position: vector([x, y, z])?,
        radius: 0.5 * number::<f64>(diameter)?,
        velocity: None,
        angular_velocity: None,
    })
}

/// `id vx vy vz wx wy wz`.
fn read_motion(words: &[&str]) -> Result<(u64, [DVec3; 2])> {
    let [id, vx, vy, vz, wx, wy, wz] = words else {
        bail!("the style sphere has an id, a velocity and an angular velocity");
    };
    Ok((number(id)?, [vector([vx, vy, vz])?, vector([wx, wy, wz])?]))
}
