//! Grains laid on the cells: who is where, what each counts, until the next renewal.
//!
//! A face's velocity is v_f = Σ a_if v_i with a_if = w_i V_i K_if / Σ w V K, and the force of the
//! pressure on a grain F_i = -Σ a_if A_f (p_right - p_left), with the same a_if. Inside one cell
//! every weight K is a polynomial of the grain's place there: of the first degree along the normal
//! of the face and of the second along the others, 18 terms (`kernel.rs`). So the grains of a
//! cell are first summed to moments, one for each term, and the faces around take these
//! (`scatter.rs`, `nodes.rs`); and the faces give the cell a polynomial that its grains evaluate
//! (`gather.rs`). No weight is stored or made.
//!
//! Four cells side by side are a group, a lane each: a slot holds one grain of each of them, and
//! cells with fewer grains than their neighbours fill up with grains that count nothing. Sums over
//! grains are those of a cell, in the order of the solver: their bits do not depend on threads.

use crate::lattice::Lattice;
use dem::{Row, Threads};
use std::ops::Range;

/// Where a grain is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Along x and y inside the box, along z between the walls.
    pub cell: [usize; 3],
    /// How far into the cell, from 0 to 1.
    pub within: [f64; 3],
}

impl Place {
    /// Of a grain at `at` cells from the origin along x and y, and from the bottom along z.
    pub fn of(lattice: &Lattice, at: [f64; 3]) -> Self {
        let mut cell = at.map(f64::floor);
        cell[2] = cell[2].clamp(0.0, lattice.cells[2] as f64 - 1.0);
        let within = [0, 1, 2].map(|axis| (at[axis] - cell[axis]).clamp(0.0, 1.0));
        let [i, j] = [0, 1].map(|axis| lattice.wrapped(axis, cell[axis] as i64));
        Self {
            cell: [i, j, cell[2] as usize],
            within,
        }
    }
}

/// Four grains, one for each cell of a group.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slot {
    /// Places in the solver's order.
    pub grains: [u32; 4],
    /// Places in their cells along x, y, z, from 0 to 1.
    pub within: [Row; 3],
}

/// The slots of four cells, and the solver's places that their grains lie between.
#[derive(Clone, Debug, Default)]
pub(crate) struct Group {
    pub slots: Range<usize>,
    pub span: Range<usize>,
}

/// All grains. What belongs to one of them stands in the rows of its slot, in its lane.
#[derive(Default)]
pub(crate) struct Exchange {
    /// Number of grains.
    pub count: usize,
    /// Plane by plane.
    pub groups: Vec<Group>,
    pub slots: Vec<Slot>,
    /// Slot and lane of each grain.
    pub at: Vec<(u32, u8)>,
    /// What it counts: w V [m³].
    pub counts: Vec<Row>,
    /// Weight of the water that it displaces, along -z [N].
    pub lift: Vec<Row>,
    /// Drag to the mean of what of it is loose [N s/m], and the part of it that faces along each
    /// axis take.
    pub drag: Vec<Row>,
    pub grip: Vec<[Row; 3]>,
    /// Work before each group, in slots.
    work: Vec<usize>,
}

/// What a group costs without any grain, in slots.
const EMPTY: usize = 3;

impl Exchange {
    /// Lay the grains on the lattice anew.
    pub fn lay(&mut self, lattice: &Lattice, places: &[Place]) {
        self.count = places.len();
        let groups = lattice.cells[0] * lattice.groups();
        self.groups.clear();
        self.groups.resize(groups, Group::default());
        self.at.clear();
        // How many grains each cell has got so far.
        let mut filled = vec![[0; 4]; groups];
        let mut homes = Vec::with_capacity(places.len());
        for place in places {
            let [i, j, k] = place.cell;
            let (group, lane) = lattice.lane(i, j * lattice.cells[2] + k);
            homes.push((group, lane, filled[group][lane]));
            filled[group][lane] += 1;
        }
        let mut slots = 0;
        self.work.clear();
        self.work.push(0);
        for (k, (group, filled)) in self.groups.iter_mut().zip(&filled).enumerate() {
            let most = filled.iter().copied().fold(0, usize::max);
            group.slots = slots..slots + most;
            slots += most;
            self.work.push(self.work[k] + most + EMPTY);
        }
        let none = Slot {
            grains: [u32::MAX; 4],
            ..Slot::default()
        };
        self.slots.clear();
        self.slots.resize(slots, none);
        for (grain, (place, home)) in places.iter().zip(&homes).enumerate() {
            let &(group, lane, before) = home;
            let group = &mut self.groups[group];
            let slot = group.slots.start + before;
            if group.span.is_empty() {
                group.span.start = grain;
            }
            group.span.end = grain + 1;
            self.at.push((slot as u32, lane as u8));
            self.slots[slot].grains[lane] = grain as u32;
            for axis in 0..3 {
                self.slots[slot].within[axis].0[lane] = place.within[axis];
            }
        }
        for slot in &mut self.slots {
            // Lanes without a grain repeat one that there is, and it counts nothing in them.
            let some = slot.grains.into_iter().fold(u32::MAX, u32::min);
            slot.grains = slot.grains.map(|grain| match grain {
                u32::MAX => some,
                grain => grain,
            });
        }
        for rows in [&mut self.counts, &mut self.lift, &mut self.drag] {
            rows.clear();
            rows.resize(slots, Row::ZERO);
        }
        self.grip.clear();
        self.grip.resize(slots, [Row::ZERO; 3]);
    }

    /// The groups of a thread, so that all have as much to do.
    pub fn share(&self, threads: &Threads) -> Range<usize> {
        let before = |work: usize| self.work[1..].partition_point(|&end| end <= work);
        let share = threads.share(self.work[self.groups.len()]);
        before(share.start)..before(share.end)
    }
}
