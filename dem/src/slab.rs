//! A slab: the grains that one thread moves, and the contacts that push them.
//!
//! Grains are sorted along x, so a slab is a range of them. A pair across a border is
//! computed on both sides, each with its own copy of the history: no thread ever waits for
//! or adds to another's sums. Every grain sums its contacts in the order of the global
//! pair list, so the bits do not depend on where the borders are.

use crate::contact::{ContactLaw, Turning};
use crate::lanes::{Place, Row};
use std::ops::Range;

/// Grains whose losses are summed together, and unit of the borders: sums over grains are
/// sums over blocks, whatever the number of slabs.
pub(crate) const BLOCK: usize = 64;

/// One thread's share.
#[derive(Default)]
pub(crate) struct Slab {
    /// The grains it moves.
    pub own: Range<usize>,
    /// Pairs with at least one own grain, in global order, padded with the dummy pair to
    /// whole groups of four, and one more group of dummies.
    pub pairs: Vec<[Place; 2]>,
    /// Rows of the sums below to which the two grains of each pair belong: their places
    /// among the own grains, or the spare row.
    pub targets: Vec<[Place; 2]>,
    /// Pairs without the padding.
    pub pair_count: usize,
    /// Bit k of entry g: does pair 4 g + k touch?
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
    /// What springs of contacts that part in a sweep still hold: row of the sums, energy of
    /// sliding and of rolling [J].
    pub parted: Vec<(Place, [f64; 2])>,
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
}

/// History of contacts, one row a slot; arrays that the law does not use stay empty.
#[derive(Clone, Default)]
pub(crate) struct Slots {
    /// Tangential spring, and 1 if sliding.
    pub spring: Vec<Row>,
    /// Force on i in the last step.
    pub force: Vec<Row>,
    /// Rolling spring and twisting spring.
    pub rolling: Vec<Row>,
    /// Rolling and twisting torque on i in the last step.
    pub couple: Vec<Row>,
}

/// Springs and flags of [`Slots`].
pub(crate) struct Springs {
    spring: Vec<Row>,
    rolling: Vec<Row>,
}

/// History of one contact.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Kept {
    pub spring: Row,
    pub force: Row,
    pub rolling: Row,
    pub couple: Row,
}

impl Kept {
    /// Energy in the tangential spring, and in the rolling and twisting ones [J].
    pub fn energies(&self, law: &ContactLaw) -> [f64; 2] {
        let sliding = 0.5 * law.tangential_stiffness() * self.spring.xyz().length_squared();
        let ContactLaw::Linear(linear) = law else {
            return [sliding, 0.0];
        };
        let stiffness = |turning: Option<Turning>| turning.map_or(0.0, |t| t.stiffness);
        let rolling = stiffness(linear.rolling) * self.rolling.xyz().length_squared();
        let twisting = stiffness(linear.twisting) * self.rolling.w() * self.rolling.w();
        [sliding, 0.5 * (rolling + twisting)]
    }

    /// The same contact seen from the other body: vectors of i against j turn round.
    pub fn reversed(self) -> Self {
        let turn = |row: Row| Row([-row.0[0], -row.0[1], -row.0[2], row.0[3]]);
        Self {
            spring: turn(self.spring),
            force: turn(self.force),
            rolling: turn(self.rolling),
            couple: turn(self.couple),
        }
    }
}

impl Slots {
    /// `count` empty slots for a law that keeps these rows.
    pub fn new(count: usize, slides: bool, turns: bool) -> Self {
        let rows = |kept: bool| vec![Row::ZERO; if kept { count } else { 0 }];
        Self {
            spring: rows(slides),
            force: rows(true),
            rolling: rows(turns),
            couple: rows(turns),
        }
    }

    pub fn get(&self, slot: usize) -> Kept {
        let row = |rows: &[Row]| rows.get(slot).copied().unwrap_or_default();
        Kept {
            spring: row(&self.spring),
            force: row(&self.force),
            rolling: row(&self.rolling),
            couple: row(&self.couple),
        }
    }

    pub fn set(&mut self, slot: usize, kept: Kept) {
        let put = |rows: &mut [Row], row| {
            if let Some(place) = rows.get_mut(slot) {
                *place = row;
            }
        };
        put(&mut self.spring, kept.spring);
        put(&mut self.force, kept.force);
        put(&mut self.rolling, kept.rolling);
        put(&mut self.couple, kept.couple);
    }

    /// Take springs and flags of the `touching` contacts from `given`.
    pub fn take_springs(&mut self, given: &Springs, touching: impl Iterator<Item = usize>) {
        for slot in touching {
            for (own, given) in [
                (&mut self.spring, &given.spring),
                (&mut self.rolling, &given.rolling),
            ] {
                if let Some(own) = own.get_mut(slot) {
                    *own = given[slot];
                }
            }
        }
    }

    /// Copy of springs and flags.
    pub fn springs(&self) -> Springs {
        Springs {
            spring: self.spring.clone(),
            rolling: self.rolling.clone(),
        }
    }

    /// Memory in use [bytes].
    pub fn bytes(&self) -> usize {
        let rows = self.spring.len() + self.force.len() + self.rolling.len() + self.couple.len();
        rows * size_of::<Row>()
    }
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
    /// Pairs and wall contacts that touch, as (slot, bit set).
    pub fn touches(touching: &[u8], count: usize) -> impl Iterator<Item = usize> {
        (0..count).filter(|slot| touching[slot / 4] >> (slot % 4) & 1 == 1)
    }

    pub fn bytes(&self) -> usize {
        let walls = self.walls.iter();
        2 * self.pairs.len() * size_of::<[Place; 2]>()
            + self.touching.len()
            + self.slots.bytes()
            + walls
                .map(|w| size_of_val(&w.grains[..]) + w.slots.bytes())
                .sum::<usize>()
            + (self.force.len() + self.torque.len()) * size_of::<Row>()
            + self.rolling_loss.len() * 8
            + self.losses.len() * size_of::<Loss>()
    }
}
