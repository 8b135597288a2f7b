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
    /// Forces of a companion on own grains in the last evaluation [N], while its work is booked.
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

    /// Book the half of the last drift's work that the companion's forces before it did, and set
    /// the sums of forces aside: what is added from now on is the companion's. `velocity` of own
    /// grains [m/s], `half` a step [s].
    pub fn set_aside(&mut self, velocity: &[Row], half: f64) {
        self.pushed.resize(velocity.len(), Row::ZERO);
        self.book(velocity, half, |pushed, force| (*pushed, *force));
    }

    /// Take what has been added as the companion's forces, and book the other half of the work.
    pub fn take_pushed(&mut self, velocity: &[Row], half: f64) {
        self.book(velocity, half, |aside, force| {
            let mut pushed = Row::ZERO;
            for lane in 0..4 {
                pushed.0[lane] = force.0[lane] - aside.0[lane];
            }
            (pushed, pushed)
        });
    }

    /// Book the work of the companion's forces over half of a drift with these velocities.
    pub fn book_companion(&mut self, velocity: &[Row], half: f64) {
        self.book(velocity, half, |pushed, _| (*pushed, *pushed));
    }

    /// Book the work of what `take` makes of what is kept of a companion and of the sums of forces,
    /// and keep what else it gives.
    #[inline(always)]
    fn book(&mut self, velocity: &[Row], half: f64, take: impl Fn(&Row, &Row) -> (Row, Row)) {
        let forces = self.force.chunks(BLOCK).zip(velocity.chunks(BLOCK));
        let blocks = self.pushed.chunks_mut(BLOCK).zip(forces);
        for (loss, (pushed, (force, velocity))) in self.losses.iter_mut().zip(blocks) {
            // Lane by lane: the compiler takes several at once.
            let mut power = [0.0; 4];
            for ((pushed, force), velocity) in pushed.iter_mut().zip(force).zip(velocity) {
                let (works, kept) = take(pushed, force);
                for (lane, power) in power.iter_mut().enumerate() {
                    *power += works.0[lane] * velocity.0[lane];
                }
                *pushed = kept;
            }
            loss.companion += half * (power[0] + power[1] + power[2]);
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
