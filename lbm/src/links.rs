//! Links that end at a side of the box or at a solid: what comes back of what was emitted.
//!
//! The wall lies half-way along the link, and the answer belongs to the middle of the step:
//!
//! - a wall with velocity u or flux j: f̄ = f - 6 w c·j (bounce back; none at rest),
//! - a pressure P: f̄ = -f + 6 w P (anti-bounce-back),
//! - free slip: what the mirrored link has emitted.
//!
//! Where a link passes an edge of the box, a flux rules over no slip, this over pressure, and
//! pressure over free slip. At the edge of a no-slip side and another tight one, or a solid,
//! nothing moves: it would push water through the other (a spurious u/6 for a wall of speed u,
//! which put a driven cavity of 64 cells off by 3 %).
//!
//! Sources: Ladd (1994), J. Fluid Mech. 271, 285; Ginzburg, Verhaeghe and d'Humières (2008),
//! Commun. Comput. Phys. 3, 427. At a pressure side the squares of the velocity are left out:
//! what is prescribed there is right to ρu²/2.

use crate::grid::Grid;
use crate::lanes::Real;
use crate::lattice::{Direction, weight};
use crate::populations::Populations;
use crate::{Ends, Model, Side};
use std::ops::Range;

/// What answers a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Answer {
    /// A solid at rest.
    Solid,
    /// The lower or upper side of an axis.
    Side { axis: usize, upper: bool },
    /// Free slip; the direction in which the mirrored link was emitted.
    Mirror(Direction),
}

/// Links of one direction with one answer.
struct Group {
    direction: Direction,
    answer: Answer,
    /// Places of the links that get the answer.
    places: Vec<u32>,
    /// Places of their mirrored links; empty for other answers.
    mirrored: Vec<u32>,
}

/// All links that end at something.
pub(crate) struct Links(Vec<Group>);

/// What the sides of the box give in one step, lattice units: flux or velocity, or pressure.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Given {
    Flux([f64; 3]),
    Pressure(f64),
}

impl Links {
    /// Find them. `fluid`: is there fluid in a cell of the domain?
    pub fn new(model: &Model, grid: &Grid, fluid: &[bool]) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        for direction in Direction::all() {
            for (cell, at) in grid.all().enumerate() {
                let inner = (0..3).all(|axis| at[axis] > 0 && at[axis] + 1 < grid.cells[axis]);
                if !fluid[cell] || (inner && model.solid.is_empty()) {
                    continue;
                }
                let Some(answer) = answer(model, grid, fluid, at, direction) else {
                    continue;
                };
                let same = |g: &&mut Group| g.direction == direction && g.answer == answer;
                let group = match groups.iter_mut().rev().find(same) {
                    Some(group) => group,
                    None => {
                        groups.push(Group {
                            direction,
                            answer,
                            places: Vec::new(),
                            mirrored: Vec::new(),
                        });
                        groups.last_mut().expect("one was pushed")
                    }
                };
                group.places.push(place(grid, at, direction));
                if let Answer::Mirror(emitted) = answer {
                    // The mirrored link starts where this one would have ended beside the wall.
                    let (c, d) = (direction.c(), emitted.c());
                    let along = [0, 1, 2].map(|axis| if c[axis] == d[axis] { 0 } else { c[axis] });
                    let partner = grid.neighbour(at, along);
                    group.mirrored.push(place(grid, partner, emitted));
                }
            }
        }
        Self(groups)
    }

    /// Let the sides answer what was emitted, before step `odd`. Of each group the part
    /// `share` of `shares` is done.
    ///
    /// # Safety
    /// All cells have emitted, nobody works on them, and each share is done by one thread.
    pub unsafe fn answer<T: Real>(
        &self,
        populations: &Populations<T>,
        odd: bool,
        given: &impl Fn(usize, bool) -> Given,
        share: usize,
        shares: usize,
    ) {
        for group in &self.0 {
            let (emitted, arriving) = populations.link(group.direction, odd);
            let own = part(group.places.len(), share, shares);
            let places = &group.places[own.clone()];
            let w = weight(group.direction.pair);
            let (keep, add) = match group.answer {
                Answer::Mirror(mirror) => {
                    let (emitted, _) = populations.link(mirror, odd);
                    for (&to, &from) in places.iter().zip(&group.mirrored[own]) {
                        // SAFETY: places of the lattice; each slot is of one link.
                        unsafe { *arriving.add(to as usize) = *emitted.add(from as usize) }
                    }
                    continue;
                }
                Answer::Solid => (T::of(1.0), None),
                Answer::Side { axis, upper } => match given(axis, upper) {
                    Given::Flux(j) => {
                        let add = -6.0 * w * group.direction.dot(j);
                        (T::of(1.0), (add != 0.0).then_some(T::of(add)))
                    }
                    Given::Pressure(p) => (T::of(-1.0), Some(T::of(6.0 * w * p))),
                },
            };
            for &place in places {
                // SAFETY: as above.
                unsafe {
                    let f = *emitted.add(place as usize);
                    *arriving.add(place as usize) = match add {
                        None => f,
                        Some(add) => keep * f + add,
                    };
                }
            }
        }
    }
}

/// An even share of `count` things.
pub(crate) fn part(count: usize, share: usize, shares: usize) -> Range<usize> {
    count * share / shares..count * (share + 1) / shares
}

/// Where the link of a cell along `direction` is stored.
fn place(grid: &Grid, at: [usize; 3], direction: Direction) -> u32 {
    let end = if direction.forward {
        grid.neighbour(at, direction.c())
    } else {
        at
    };
    u32::try_from(grid.place(end)).expect("the solver refuses lattices with more places")
}

/// Does the link end at something? At what?
pub(crate) fn answer(
    model: &Model,
    grid: &Grid,
    fluid: &[bool],
    at: [usize; 3],
    direction: Direction,
) -> Option<Answer> {
    let c = direction.c();
    let leaves = |axis: usize| {
        let end = at[axis] as i64 + i64::from(c[axis]);
        let walled = matches!(model.ends[axis], Ends::Walls(..));
        walled && (end < 0 || end >= grid.cells[axis] as i64)
    };
    let has_fluid = |at: [usize; 3]| {
        let [nx, ny, _] = grid.cells;
        fluid[(at[2] * ny + at[1]) * nx + at[0]]
    };
    let left: Vec<usize> = (0..3).filter(|&axis| leaves(axis)).collect();
    if left.is_empty() {
        let end = grid.neighbour(at, c);
        return (!has_fluid(end)).then_some(Answer::Solid);
    }
    let side = |axis: usize| match &model.ends[axis] {
        Ends::Walls(lower, upper) => Some(if c[axis] > 0 { upper } else { lower }),
        Ends::Periodic => None,
    };
    let rank = |axis: &usize| match side(*axis) {
        Some(Side::Flux(_)) => 3,
        Some(Side::NoSlip(_)) => 2,
        Some(Side::Pressure(_)) => 1,
        Some(Side::FreeSlip) | None => 0,
    };
    // The last of equals: z before y before x.
    let axis = *left.iter().max_by_key(|axis| rank(axis))?;
    // The cell beside, against which the link would run after the side.
    let along = [0, 1, 2].map(|axis| if left.contains(&axis) { 0 } else { c[axis] });
    let blocked = !has_fluid(grid.neighbour(at, along));
    let tight = left.iter().filter(|axis| [0, 2].contains(&rank(axis)));
    if rank(&axis) == 2 && (tight.count() == 2 || blocked) {
        return Some(Answer::Solid);
    }
    if rank(&axis) > 0 {
        let upper = c[axis] > 0;
        return Some(Answer::Side { axis, upper });
    }
    if blocked {
        return Some(Answer::Solid);
    }
    // The mirrored link leaves the cell beside through the same side.
    let mirror = [0, 1, 2].map(|axis| {
        if left.contains(&axis) {
            c[axis]
        } else {
            -c[axis]
        }
    });
    Some(Answer::Mirror(Direction::along(mirror)))
}
