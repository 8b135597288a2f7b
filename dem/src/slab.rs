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

/// History of contacts in groups of four, as columns that a vector loads at once; arrays
/// that the law does not use stay empty. Slot 4 g + k is lane k of group g.
#[derive(Clone, Default)]
pub(crate) struct Slots {
    /// Tangential spring, and 1 if sliding.
    pub spring: Vec<[Row; 4]>,
    /// Force on i in the last step.
    pub force: Vec<[Row; 3]>,
    /// Rolling spring and twisting spring.
    pub rolling: Vec<[Row; 4]>,
    /// Rolling and twisting torque on i in the last step.
    pub couple: Vec<[Row; 3]>,
}

/// Springs and flags of [`Slots`].
pub(crate) struct Springs {
    spring: Vec<[Row; 4]>,
    rolling: Vec<[Row; 4]>,
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

/// One slot of columns as a row; zero where there are none.
fn get<const N: usize>(columns: &[[Row; N]], slot: usize) -> Row {
    let mut row = Row::ZERO;
    if let Some(columns) = columns.get(slot / 4) {
        for (component, column) in row.0.iter_mut().zip(columns) {
            *component = column.0[slot % 4];
        }
    }
    row
}

/// Write a row to one slot of columns, if there are any.
fn set<const N: usize>(columns: &mut [[Row; N]], slot: usize, row: Row) {
    if let Some(columns) = columns.get_mut(slot / 4) {
        for (component, column) in row.0.iter().zip(columns) {
            column.0[slot % 4] = *component;
        }
    }
}

fn copy<const N: usize>(columns: &mut [[Row; N]], from: usize, to: usize) {
    if !columns.is_empty() {
        for column in 0..N {
            columns[to / 4][column].0[to % 4] = columns[from / 4][column].0[from % 4];
        }
    }
}

impl Slots {
    /// Empty slots in `groups` groups for a law that keeps these columns.
    pub fn new(groups: usize, slides: bool, turns: bool) -> Self {
        let count = |kept: bool| if kept { groups } else { 0 };
        Self {
            spring: vec![[Row::ZERO; 4]; count(slides)],
            force: vec![[Row::ZERO; 3]; groups],
            rolling: vec![[Row::ZERO; 4]; count(turns)],
            couple: vec![[Row::ZERO; 3]; count(turns)],
        }
    }

    pub fn get(&self, slot: usize) -> Kept {
        Kept {
            spring: get(&self.spring, slot),
            force: get(&self.force, slot),
            rolling: get(&self.rolling, slot),
            couple: get(&self.couple, slot),
        }
    }

    pub fn set(&mut self, slot: usize, kept: Kept) {
        set(&mut self.spring, slot, kept.spring);
        set(&mut self.force, slot, kept.force);
        set(&mut self.rolling, slot, kept.rolling);
        set(&mut self.couple, slot, kept.couple);
    }

    /// Copy one slot to another.
    pub fn copy(&mut self, from: usize, to: usize) {
        copy(&mut self.spring, from, to);
        copy(&mut self.force, from, to);
        copy(&mut self.rolling, from, to);
        copy(&mut self.couple, from, to);
    }

    /// Take springs and flags of the `touching` contacts from `given`.
    pub fn take_springs(&mut self, given: &Springs, touching: impl Iterator<Item = usize>) {
        for slot in touching {
            set(&mut self.spring, slot, get(&given.spring, slot));
            set(&mut self.rolling, slot, get(&given.rolling, slot));
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
        size_of_val(&self.spring[..])
            + size_of_val(&self.force[..])
            + size_of_val(&self.rolling[..])
            + size_of_val(&self.couple[..])
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
    /// Slots whose bits are set, of `count`.
    pub fn touches(touching: &[u8], count: usize) -> impl Iterator<Item = usize> {
        (0..count).filter(|slot| touching[slot / 4] >> (slot % 4) & 1 == 1)
    }

    pub fn bytes(&self) -> usize {
        let walls = self.walls.iter();
        2 * size_of_val(&self.pairs[..])
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
