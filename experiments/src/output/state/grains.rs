//! `grains/` of a state: one row a grain in the order of identities.

use crate::output::hdf::{get, get_rows, put, put_rows};
use anyhow::{Result, bail};
use dem::{Constraint, Grains, Horizontal};
use glam::{DQuat, DVec3};
use hdf5::Group;

pub(super) fn write(group: &Group, grains: &Grains) -> Result<()> {
    put(group, "id", "1", &grains.id)?;
    put(group, "radius", "m", &grains.radius)?;
    put(group, "mass", "kg", &grains.mass)?;
    put(
        group,
        "moment_of_inertia",
        "kg m2",
        &grains.moment_of_inertia,
    )?;
    put_rows(group, "position", "m", &grains.position, DVec3::to_array)?;
    put_rows(
        group,
        "displacement",
        "m",
        &grains.displacement,
        DVec3::to_array,
    )?;
    put_rows(
        group,
        "velocity",
        "m s-1",
        &grains.velocity,
        DVec3::to_array,
    )?;
    let spin = &grains.angular_velocity;
    put_rows(group, "angular_velocity", "rad s-1", spin, DVec3::to_array)?;
    put_rows(
        group,
        "orientation",
        "1",
        &grains.orientation,
        DQuat::to_array,
    )?;
    let constraint = grains.constraint.iter();
    let horizontal: Vec<_> = constraint
        .clone()
        .map(|c| horizontal_code(c.horizontal))
        .collect();
    put(group, "horizontal", "1", &horizontal)?;
    let held: Vec<_> = constraint.map(|c| u8::from(c.rotation_held)).collect();
    put(group, "rotation_held", "1", &held)?;
    Ok(())
}

pub(super) fn read(group: &Group) -> Result<Grains> {
    let n = group.dataset("id")?.size();
    Ok(Grains {
        id: get(group, "id", n)?,
        radius: get(group, "radius", n)?,
        mass: get(group, "mass", n)?,
        moment_of_inertia: get(group, "moment_of_inertia", n)?,
        position: get_rows(group, "position", n, DVec3::from_array)?,
        displacement: get_rows(group, "displacement", n, DVec3::from_array)?,
        velocity: get_rows(group, "velocity", n, DVec3::from_array)?,
        angular_velocity: get_rows(group, "angular_velocity", n, DVec3::from_array)?,
        orientation: get_rows(group, "orientation", n, DQuat::from_array)?,
        constraint: read_constraints(group, n)?,
    })
}

fn read_constraints(group: &Group, n: usize) -> Result<Vec<Constraint>> {
    let horizontal: Vec<u8> = get(group, "horizontal", n)?;
    let held: Vec<u8> = get(group, "rotation_held", n)?;
    let constraint = |(code, held): (u8, u8)| {
        Ok(Constraint {
            horizontal: horizontal_from(code)?,
            rotation_held: held != 0,
        })
    };
    horizontal.into_iter().zip(held).map(constraint).collect()
}

fn horizontal_code(horizontal: Horizontal) -> u8 {
    match horizontal {
        Horizontal::Free => 0,
        Horizontal::Held => 1,
        Horizontal::Driven => 2,
    }
}

fn horizontal_from(code: u8) -> Result<Horizontal> {
    Ok(match code {
        0 => Horizontal::Free,
        1 => Horizontal::Held,
        2 => Horizontal::Driven,
        _ => bail!("grains/horizontal holds {code}; 0 is free, 1 held, 2 driven"),
    })
}
