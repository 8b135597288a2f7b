//! The first rows of grains and contacts, in the order of identities.

use super::fixed::{Grid, Place};
use super::scene::{DRIVEN, HELD, Motion, Own, SLIDING, STILL, TOUCHES, TOUCHING};
use crate::{Body, Contact, Error, Horizontal, Model, State};
use glam::{DVec3, Vec3};

/// Rows of grains.
pub(super) struct Rows {
    pub places: Vec<Place>,
    pub motions: Vec<Motion>,
    pub owns: Vec<Own>,
}

/// Lists that hold the contacts of a state, from both sides.
pub(super) struct Lists {
    pub lists: Vec<[u32; 2]>,
    pub words: Vec<u32>,
    /// Tangential spring, twisting spring.
    pub springs: Vec<[f32; 4]>,
    /// Rolling spring.
    pub rollings: Vec<[f32; 4]>,
    /// The same for each grain and wall.
    pub wall_springs: Vec<[f32; 4]>,
    pub wall_rollings: Vec<[f32; 4]>,
}

/// Rows of the grains of `state`.
pub(super) fn rows(model: &Model, state: &State, grid: &Grid) -> Result<Rows, Error> {
    let grains = &state.grains;
    let mut rows = Rows {
        places: Vec::with_capacity(grains.len()),
        motions: Vec::with_capacity(grains.len()),
        owns: Vec::with_capacity(grains.len()),
    };
    for k in 0..grains.len() {
        rows.places
            .push(grid.place(grains.position[k], grains.radius[k])?);
        rows.motions.push(Motion {
            velocity: grains.velocity[k].as_vec3().to_array(),
            radius: grains.radius[k] as f32,
            spin: grains.angular_velocity[k].as_vec3().to_array(),
            id: k as u32,
        });
        let constraint = grains.constraint[k];
        let horizontal = match constraint.horizontal {
            Horizontal::Free => 0,
            Horizontal::Held => HELD,
            Horizontal::Driven => DRIVEN,
        };
        rows.owns.push(Own {
            kick: (model.step / grains.mass[k]) as f32,
            twist: (model.step / grains.moment_of_inertia[k]) as f32,
            flags: horizontal | if constraint.rotation_held { STILL } else { 0 },
            image: 0,
        });
    }
    Ok(rows)
}

/// Lists of the contacts of `state`; flags of walls go into `rows`.
pub(super) fn lists(model: &Model, state: &State, rows: &mut Rows) -> Result<Lists, Error> {
    let n = state.grains.len();
    let walls = model.walls.len();
    let mut each: Vec<Vec<(u32, &Contact)>> = vec![Vec::new(); n];
    let mut lists = Lists {
        lists: Vec::with_capacity(n),
        words: Vec::new(),
        springs: Vec::new(),
        rollings: Vec::new(),
        wall_springs: vec![[0.0; 4]; n * walls],
        wall_rollings: vec![[0.0; 4]; n * walls],
    };
    for contact in &state.contacts {
        let i = contact.i;
        let unknown = || {
            let j = contact.j;
            Error::Invalid(format!(
                "contact of grain {i} with {j:?}: there is no such body"
            ))
        };
        if i as usize >= n {
            return Err(unknown());
        }
        match contact.j {
            Body::Grain(j) if j as usize >= n || j == i => return Err(unknown()),
            Body::Grain(j) => {
                each[i as usize].push((j, contact));
                each[j as usize].push((i, contact));
            }
            Body::Wall(k) if k as usize >= walls => return Err(unknown()),
            Body::Wall(k) => {
                let e = i as usize * walls + k as usize;
                let history = &contact.history;
                lists.wall_springs[e] = four(history.spring, history.twisting_spring);
                lists.wall_rollings[e] = four(history.rolling_spring, 0.0);
                let flags = &mut rows.owns[i as usize].flags;
                *flags |= TOUCHES << k;
                *flags |= u32::from(history.sliding) * (TOUCHES << (walls as u32 + k));
            }
        }
    }
    for contacts in each {
        lists
            .lists
            .push([lists.words.len() as u32, contacts.len() as u32]);
        for (j, contact) in contacts {
            let history = &contact.history;
            // Histories are those of the grain with the smaller identity.
            let sign = match contact.j {
                Body::Grain(j) if j < contact.i => -1.0,
                _ => 1.0,
            };
            lists
                .words
                .push(j | TOUCHING | if history.sliding { SLIDING } else { 0 });
            lists
                .springs
                .push(four(sign * history.spring, history.twisting_spring));
            lists
                .rollings
                .push(four(sign * history.rolling_spring, 0.0));
        }
    }
    Ok(lists)
}

fn four(v: DVec3, w: f64) -> [f32; 4] {
    let Vec3 { x, y, z } = v.as_vec3();
    [x, y, z, w as f32]
}
