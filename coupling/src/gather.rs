//! From polynomials of cells to grains: the hot loop of the gather.

use crate::exchange::{Exchange, Group, Slot};
use crate::kernel::Kernel;
use crate::lattice::Lattice;
use crate::scatter::{Basis, columns};
use crate::terms::{Moments, Sheets, Sum, TERMS, sheet, term};
use dem::Row;
use dem::lanes::Lanes;
use std::ops::Range;

/// What all threads read: sums over nodes along y and z (`nodes.rs`), one entry a group.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    pub lattice: &'a Lattice,
    pub exchange: &'a Exchange,
    pub sheets: &'a [Sheets],
}

impl Given<'_> {
    /// The polynomials of a group: sums over its planes along x.
    #[inline(always)]
    fn fill<V: Lanes, const N: usize>(&self, group: usize, terms: &mut Moments) {
        let groups = self.lattice.groups();
        let (plane, within) = (group / groups, group % groups);
        let mut near = [&self.sheets[group]; N];
        for (k, near) in near.iter_mut().enumerate() {
            *near = &self.sheets[self.lattice.plane_near::<N>(plane, k) * groups + within];
        }
        for b in 0..3 {
            for c in 0..3 {
                let place = sheet(0, [b, c]);
                for a in 0..2 {
                    let sum = sum::<V, N>(&near, place, &Kernel::<N>::FACES[a]);
                    sum.store(&mut terms[term(0, [a, b, c])]);
                }
            }
        }
        for a in 0..3 {
            for i in 0..2 {
                for j in 0..3 {
                    let of_y = sum::<V, N>(&near, sheet(1, [i, j]), &Kernel::<N>::CELLS[a]);
                    of_y.store(&mut terms[term(1, [a, i, j])]);
                    let of_z = sum::<V, N>(&near, sheet(2, [j, i]), &Kernel::<N>::CELLS[a]);
                    of_z.store(&mut terms[term(2, [a, j, i])]);
                }
            }
        }
        // To be read from memory, where rows are aligned: the compiler would keep these many vectors
        // in places of the stack that are not.
        std::hint::black_box(terms);
    }
}

#[inline(always)]
fn sum<V: Lanes, const N: usize>(near: &[&Sheets; N], place: usize, weights: &[f64; N]) -> V {
    let mut sum = Sum::<V>::new();
    for k in 0..N {
        sum = sum.add(weights[k], &near[k][place]);
    }
    sum.total()
}

/// The polynomials of a group at the places of four grains.
#[inline(always)]
fn evaluate<V: Lanes>(terms: &Moments, slot: &Slot) -> [V; 3] {
    let [x, y, z] = &slot.within;
    let [x, y, z] = [Basis::<V>::of(x), Basis::of(y), Basis::of(z)];
    [
        normal::<V, 0>(terms, x.first, y.second, z.second),
        normal::<V, 1>(terms, y.first, x.second, z.second),
        normal::<V, 2>(terms, z.first, x.second, y.second),
    ]
}

/// That of the faces of one normal: along it, and along the other axes.
#[inline(always)]
fn normal<V: Lanes, const NORMAL: usize>(
    terms: &Moments,
    [s, t]: [V; 2],
    first: [V; 2],
    second: [V; 2],
) -> V {
    let at = |power: usize, i: usize, j: usize| {
        let [p, q] = [[1, 2], [0, 2], [0, 1]][NORMAL];
        let mut powers = [0; 3];
        (powers[NORMAL], powers[p], powers[q]) = (power, i, j);
        &terms[term(NORMAL, powers)]
    };
    let mut parts = [[V::splat(0.0); 3]; 2];
    for power in 0..2 {
        for i in 0..3 {
            let (a, b, c) = (at(power, i, 0), at(power, i, 1), at(power, i, 2));
            parts[power][i] = sum_of(V::load(a), V::load(b), V::load(c), second);
        }
    }
    let [[a, b, c], [d, e, f]] = parts;
    sum_of(a, b, c, first).mul_add(s, sum_of(d, e, f, first) * t)
}

/// a + s² b + t² c
#[inline(always)]
fn sum_of<V: Lanes>(a: V, b: V, c: V, [ss, tt]: [V; 2]) -> V {
    c.mul_add(tt, b.mul_add(ss, a))
}

/// Does the group hold grains of these?
fn reaches(group: &Group, own: &Range<usize>) -> bool {
    group.span.start < own.end && own.start < group.span.end
}

/// The rows of four grains.
#[inline(always)]
fn rows<V: Lanes>([x, y, z]: [V; 3]) -> [V; 4] {
    V::transpose([x, y, z, V::splat(0.0)])
}

/// Add `out` to the rows of four grains, as far as they are among `own`.
#[inline(always)]
fn add<V: Lanes>(out: [V; 3], slot: &Slot, own: &Range<usize>, force: &mut [Row]) {
    let rows = rows(out);
    for (grain, row) in slot.grains.into_iter().zip(rows) {
        if let Some(force) = force.get_mut((grain as usize).wrapping_sub(own.start)) {
            (V::load(force) + row).store(force);
        }
    }
}

/// Add the push of the faces, and the lift, to the forces of the grains `own`.
#[inline(always)]
pub(crate) fn push<V: Lanes, const N: usize>(given: Given, own: Range<usize>, force: &mut [Row]) {
    let exchange = given.exchange;
    let mut terms = [Row::ZERO; TERMS];
    for (k, group) in exchange.groups.iter().enumerate() {
        if !reaches(group, &own) {
            continue;
        }
        given.fill::<V, N>(k, &mut terms);
        for slot in group.slots.clone() {
            let counts = V::load(&exchange.counts[slot]);
            let lift = V::load(&exchange.lift[slot]);
            let slot = &exchange.slots[slot];
            let [x, y, z] = evaluate::<V>(&terms, slot);
            let push = [x * counts, y * counts, z.mul_add(counts, lift)];
            add(push, slot, &own, force);
        }
    }
}

/// Ways of grains, and what makes velocities of them, and of their drag that which is held.
#[derive(Clone, Copy)]
pub(crate) struct Drawn<'a> {
    /// Ways [m], a row for each grain.
    pub way: &'a [Row],
    /// One over the time that they took [1/s].
    pub rate: f64,
    /// One over the exchanges' steps.
    pub share: f64,
}

/// Add the drag of loose grains towards the mean to the forces of the grains `own`, and write it to
/// `dragged` unless that is empty.
///
/// # Safety
/// There is a way for each grain.
#[inline(always)]
pub(crate) unsafe fn drag<V: Lanes, const N: usize>(
    given: Given,
    drawn: Drawn,
    own: Range<usize>,
    force: &mut [Row],
    dragged: &mut [Row],
) {
    let (rate, share) = (V::splat(drawn.rate), V::splat(drawn.share));
    let exchange = given.exchange;
    let mut terms = [Row::ZERO; TERMS];
    for (k, group) in exchange.groups.iter().enumerate() {
        if !reaches(group, &own) {
            continue;
        }
        given.fill::<V, N>(k, &mut terms);
        for slot in group.slots.clone() {
            let drag = V::load(&exchange.drag[slot]) * share;
            let [a, b, c] = &exchange.grip[slot];
            let slot = &exchange.slots[slot];
            let [x, y, z] = evaluate::<V>(&terms, slot);
            // SAFETY: the caller's promise.
            let [u, v, w] = unsafe { columns::<V>(drawn.way, slot.grains) };
            let drags = rows([
                V::load(a).neg_mul_add(u * rate, x) * drag,
                V::load(b).neg_mul_add(v * rate, y) * drag,
                V::load(c).neg_mul_add(w * rate, z) * drag,
            ]);
            for (grain, drag) in slot.grains.into_iter().zip(drags) {
                let at = (grain as usize).wrapping_sub(own.start);
                if let Some(force) = force.get_mut(at) {
                    (V::load(force) + drag).store(force);
                }
                if let Some(dragged) = dragged.get_mut(at) {
                    // A lane without a grain repeats one, and drags it by nothing.
                    (V::load(dragged) + drag).store(dragged);
                }
            }
        }
    }
}

/// What grains find at their places: a row for each axis and slot.
#[inline(always)]
pub(crate) fn read<V: Lanes, const N: usize>(given: Given, to: &mut [[Row; 3]]) {
    let mut terms = [Row::ZERO; TERMS];
    for (k, group) in given.exchange.groups.iter().enumerate() {
        given.fill::<V, N>(k, &mut terms);
        for slot in group.slots.clone() {
            let found = evaluate::<V>(&terms, &given.exchange.slots[slot]);
            for (row, found) in to[slot].iter_mut().zip(found) {
                found.store(row);
            }
        }
    }
}
