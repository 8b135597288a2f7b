//! A slab: the grains that one thread moves, and the contacts that push them.
//!
//! Grains are sorted along x, so a slab is a range of them. A pair across a border is
//! computed on both sides, each with its own copy of the history: no thread ever waits for
//! or adds to another's sums. Every grain sums its contacts in the order of the global
//! pair list, so the bits do not depend on where the borders are.

use crate::lanes::{Place, Row};
use crate::slots::Slots;
use std::ops::Range;

/// Grains whose losses are summed together, and unit of the borders: sums over grains are
/// sums over blocks, whatever the number of slabs.
pub(crate) const BLOCK: usize = 64;

/// One thread's share.
#[derive(Default)]
pub(crate) struct Slab {
    /// The grains it moves.
    pub own: Range<usize>,
    /// Pairs with at least one own grain, in an order that all slabs share, padded with the
    /// dummy pair to whole groups of four. Slot 4 g + k is pair k of group g.
    pub pairs: Vec<[[Place; 2]; 4]>,
    /// Rows of the sums below to which the two grains of each pair belong: their places
    /// among the own grains, or the spare row.
    pub targets: Vec<[[Place; 2]; 4]>,
    /// Pairs without the padding.
    pub pair_count: usize,
    /// Ends of the stretches of pairs within which [`regroup`](Self::regroup) orders them.
    pub stretches: Vec<usize>,
    /// Bit k of entry g: did pair k of group g touch in the last evaluation?
    pub touching: Vec<u8>,
    /// What the pairs remember.
    pub slots: Slots,
    /// Near grains of each wall.
    pub walls: Vec<WallSlab>,
    /// Sum of forces on own grains [N], and of friction losses [J]; one more row takes what
    /// belongs to other slabs.
    pub force: Vec<Row>,
    /// Sum of torques on own grains [N m], and of dashpot losses [J].
    pub torque: Vec<Row>,
    /// Sum of rolling losses of own grains [J].
    pub rolling_loss: Vec<f64>,
    /// Forces of a companion on own grains since the last exchange [N]; empty without one.
    pub pushed: Vec<Row>,
    /// Pairs on their way behind those that touch (`regroup.rs`): empty, but for its memory.
    pub apart: Vec<([Place; 2], [Place; 2])>,
    /// Losses since the solver began, one entry a block of own grains.
    pub losses: Vec<Loss>,
    /// Own grains whose horizontal motion is held, and driven, with their place in the gauge.
    pub held: Vec<Gauged>,
    pub driven: Vec<Gauged>,
    /// Own grains whose rotation is held.
    pub still: Vec<u32>,
}

/// A grain of a held or driven layer.
#[derive(Clone, Copy)]
pub(crate) struct Gauged {
    /// Index among the own grains.
    pub own: u32,
    /// Index in the gauge that sums the layer.
    pub gauge: u32,
}

/// Energy lost since the solver began [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Loss {
    pub friction: f64,
    pub viscosity: f64,
    pub rolling: f64,
    /// Work of outside forces.
    pub outside: f64,
    /// Work of a companion's forces.
    pub companion: f64,
}

/// The near grains of one wall in one slab.
#[derive(Default)]
pub(crate) struct WallSlab {
    /// Their indices, padded with the dummy grain to whole groups of four.
    pub grains: Vec<Place>,
    /// Grains without the padding.
    pub count: usize,
    /// Place of the first one in the wall's gauge.
    pub gauge: usize,
    pub touching: Vec<u8>,
    pub slots: Slots,
}

impl Slab {
    /// Slots whose bits are set, of `count`.
    pub fn touches(touching: &[u8], count: usize) -> impl Iterator<Item = usize> {
        (0..count).filter(|slot| touching[slot / 4] >> (slot % 4) & 1 == 1)
    }

    /// Add the forces of a companion to the sums.
    pub fn add_pushed(&mut self) {
        for (force, pushed) in self.force.iter_mut().zip(&self.pushed) {
            for lane in 0..4 {
                force.0[lane] += pushed.0[lane];
            }
        }
    }

    /// Book the work of a companion's forces on sums of two rows of own grains: ways, once
    /// multiplied by `factors` [m].
    pub fn book_companion(&mut self, rows: [&[Row]; 2], factors: [f64; 2]) {
        let rows = rows[0].chunks(BLOCK).zip(rows[1].chunks(BLOCK));
        let blocks = self.pushed.chunks(BLOCK).zip(rows);
        for (loss, (pushed, (a, b))) in self.losses.iter_mut().zip(blocks) {
            // Lane by lane: the compiler takes several at once.
            let mut work = [0.0; 4];
            for ((pushed, a), b) in pushed.iter().zip(a).zip(b) {
                for (lane, work) in work.iter_mut().enumerate() {
                    let way = factors[0] * a.0[lane] + factors[1] * b.0[lane];
                    *work += pushed.0[lane] * way;
                }
            }
            loss.companion += work[0] + work[1] + work[2];
        }
    }

    pub fn bytes(&self) -> usize {
        let walls = self.walls.iter();
        2 * size_of_val(&self.pairs[..])
            + self.touching.len()
            + self.slots.bytes()
            + walls
                .map(|w| size_of_val(&w.grains[..]) + w.slots.bytes())
                .sum::<usize>()
            + (self.force.len() + self.torque.len() + self.pushed.len()) * size_of::<Row>()
            + self.rolling_loss.len() * 8
            + self.losses.len() * size_of::<Loss>()
    }
}
