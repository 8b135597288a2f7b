//! From grains to moments of cells: the hot loop of the scatter.
//!
//! A moment is Σ u B(t) over the grains of a cell, one for each term B of the weights, with u what a
//! grain brings along the normal of the faces.

use crate::exchange::{Exchange, Slot};
use crate::terms::{Moments, term};
use dem::Row;
use dem::lanes::Lanes;
use std::ops::Range;

/// The components of four rows.
///
/// # Safety
/// They are among `rows`.
#[inline(always)]
pub(crate) unsafe fn columns<V: Lanes>(rows: &[Row], [a, b, c, d]: [u32; 4]) -> [V; 3] {
    // SAFETY: the caller's promise.
    let four = unsafe {
        [
            V::load(rows.get_unchecked(a as usize)),
            V::load(rows.get_unchecked(b as usize)),
            V::load(rows.get_unchecked(c as usize)),
            V::load(rows.get_unchecked(d as usize)),
        ]
    };
    let [x, y, z, _] = V::transpose(four);
    [x, y, z]
}

/// s, t, and s², t² along one axis.
#[derive(Clone, Copy)]
pub(crate) struct Basis<V> {
    pub first: [V; 2],
    pub second: [V; 2],
}

impl<V: Lanes> Basis<V> {
    #[inline(always)]
    pub fn of(t: &Row) -> Self {
        let t = V::load(t);
        let s = V::splat(1.0) - t;
        Self {
            first: [s, t],
            second: [s * s, t * t],
        }
    }
}

/// Slots at a time: what is kept of them stays in the fastest memory.
const BLOCK: usize = 16;

/// What is kept of a slot.
#[derive(Clone, Copy)]
struct Kept<V> {
    basis: [Basis<V>; 3],
    brings: [V; 3],
}

/// The moments of some groups, of what grains count times their ways; of
/// what they count alone where none is `MOVING`.
///
/// # Safety
/// There are ways of all grains, or none is moving.
#[inline(always)]
pub(crate) unsafe fn scatter<V: Lanes, const MOVING: bool>(
    exchange: &Exchange,
    range: Range<usize>,
    counts: &[Row],
    way: &[Row],
    moments: &mut [Moments],
) {
    let zero = V::splat(0.0);
    let nothing = Kept {
        basis: [Basis {
            first: [zero; 2],
            second: [zero; 2],
        }; 3],
        brings: [zero; 3],
    };
    let mut kept = [nothing; BLOCK];
    for (group, moments) in exchange.groups[range].iter().zip(moments) {
        let mut from = group.slots.start;
        loop {
            let block = from..group.slots.end.min(from + BLOCK);
            let slots = exchange.slots[block.clone()].iter();
            for ((kept, slot), counts) in kept.iter_mut().zip(slots).zip(&counts[block.clone()]) {
                // SAFETY: slots hold grains of the bed.
                *kept = unsafe { keep::<V, MOVING>(slot, counts, way) };
            }
            let (kept, first) = (&kept[..block.len()], from == group.slots.start);
            for power in 0..2 {
                add_up::<V, 0>(kept, power, first, moments);
                add_up::<V, 1>(kept, power, first, moments);
                add_up::<V, 2>(kept, power, first, moments);
            }
            from = block.end;
            if from == group.slots.end {
                break;
            }
        }
    }
}

/// # Safety
/// As `scatter`.
#[inline(always)]
unsafe fn keep<V: Lanes, const MOVING: bool>(slot: &Slot, counts: &Row, way: &[Row]) -> Kept<V> {
    let counts = V::load(counts);
    let [a, b, c] = &slot.within;
    let brings = match MOVING {
        true => {
            // SAFETY: the caller's promise.
            let [x, y, z] = unsafe { columns::<V>(way, slot.grains) };
            [x * counts, y * counts, z * counts]
        }
        false => [counts; 3],
    };
    Kept {
        basis: [Basis::of(a), Basis::of(b), Basis::of(c)],
        brings,
    }
}

/// Add the nine moments of the faces of one normal with this power of t along it to those of the
/// blocks before, if this is not the first.
#[inline(always)]
fn add_up<V: Lanes, const NORMAL: usize>(
    kept: &[Kept<V>],
    power: usize,
    first: bool,
    moments: &mut Moments,
) {
    let [p, q] = [[1, 2], [0, 2], [0, 1]][NORMAL];
    let place = |i: usize, j: usize| {
        let mut powers = [0; 3];
        (powers[NORMAL], powers[p], powers[q]) = (power, i, j);
        term(NORMAL, powers)
    };
    let mut sums = [[V::splat(0.0); 3]; 3];
    if !first {
        for i in 0..3 {
            for j in 0..3 {
                sums[i][j] = V::load(&moments[place(i, j)]);
            }
        }
    }
    for kept in kept {
        let brings = kept.brings[NORMAL] * kept.basis[NORMAL].first[power];
        let [ss, tt] = kept.basis[p].second;
        let parts = [brings, brings * ss, brings * tt];
        let [ss, tt] = kept.basis[q].second;
        for i in 0..3 {
            sums[i][0] = sums[i][0] + parts[i];
            sums[i][1] = parts[i].mul_add(ss, sums[i][1]);
            sums[i][2] = parts[i].mul_add(tt, sums[i][2]);
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            sums[i][j].store(&mut moments[place(i, j)]);
        }
    }
}
