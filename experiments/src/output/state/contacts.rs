//! `contacts/` of a state: one row a contact, sorted by its two bodies.

use crate::output::hdf::{get, get_rows, put, put_rows};
use anyhow::{Result, ensure};
use dem::{Body, Contact, History};
use glam::DVec3;
use hdf5::Group;

pub(super) fn write(group: &Group, contacts: &[Contact]) -> Result<()> {
    let each = contacts.iter();
    put(
        group,
        "i",
        "1",
        &each.clone().map(|c| c.i).collect::<Vec<_>>(),
    )?;
    put(
        group,
        "j",
        "1",
        &each.clone().map(|c| body_code(c.j)).collect::<Vec<_>>(),
    )?;
    put_rows(group, "spring", "m", contacts, |c| {
        c.history.spring.to_array()
    })?;
    put_rows(group, "rolling_spring", "m", contacts, |c| {
        c.history.rolling_spring.to_array()
    })?;
    let twist: Vec<_> = each.clone().map(|c| c.history.twisting_spring).collect();
    put(group, "twisting_spring", "m", &twist)?;
    let sliding: Vec<_> = each.clone().map(|c| u8::from(c.history.sliding)).collect();
    put(group, "sliding", "1", &sliding)?;
    put_rows(group, "force", "N", contacts, |c| c.force.to_array())?;
    put(
        group,
        "overlap",
        "m",
        &each.map(|c| c.overlap).collect::<Vec<_>>(),
    )?;
    put_rows(group, "branch", "m", contacts, |c| c.branch.to_array())?;
    Ok(())
}

/// Contacts among so many `grains` and `walls`.
pub(super) fn read(group: &Group, grains: usize, walls: usize) -> Result<Vec<Contact>> {
    let n = group.dataset("i")?.size();
    let i: Vec<u32> = get(group, "i", n)?;
    let j: Vec<i64> = get(group, "j", n)?;
    let spring = get_rows(group, "spring", n, DVec3::from_array)?;
    let rolling_spring = get_rows(group, "rolling_spring", n, DVec3::from_array)?;
    let twisting_spring: Vec<f64> = get(group, "twisting_spring", n)?;
    let sliding: Vec<u8> = get(group, "sliding", n)?;
    let force = get_rows(group, "force", n, DVec3::from_array)?;
    let overlap: Vec<f64> = get(group, "overlap", n)?;
    let branch = get_rows(group, "branch", n, DVec3::from_array)?;
    let contact = |c: usize| {
        let known = (i[c] as usize) < grains && j[c] < grains as i64 && j[c] >= -(walls as i64);
        ensure!(
            known,
            "contact {c} joins {} and {}, which are not there",
            i[c],
            j[c]
        );
        Ok(Contact {
            i: i[c],
            j: body_from(j[c]),
            history: History {
                spring: spring[c],
                rolling_spring: rolling_spring[c],
                twisting_spring: twisting_spring[c],
                sliding: sliding[c] != 0,
            },
            force: force[c],
            overlap: overlap[c],
            branch: branch[c],
        })
    };
    (0..n).map(contact).collect()
}

fn body_code(body: Body) -> i64 {
    match body {
        Body::Grain(grain) => i64::from(grain),
        Body::Wall(wall) => -1 - i64::from(wall),
    }
}

fn body_from(code: i64) -> Body {
    match code {
        0.. => Body::Grain(code as u32),
        _ => Body::Wall((-1 - code) as u32),
    }
}
