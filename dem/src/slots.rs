//! What contacts remember from step to step.

use crate::contact::{ContactLaw, Law, Memory, Response, Springs, Turning};
use crate::lanes::{Lanes, Row, V3};

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
    let row = get(columns, from);
    set(columns, to, row);
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
    pub fn take_springs(&mut self, given: &Self, touching: impl Iterator<Item = usize>) {
        for slot in touching {
            set(&mut self.spring, slot, get(&given.spring, slot));
            set(&mut self.rolling, slot, get(&given.rolling, slot));
        }
    }

    /// The springs of one group.
    #[inline(always)]
    pub fn springs<V: Lanes, L: Law>(&self, group: usize) -> Springs<V> {
        let mut springs = Springs::none();
        if L::SLIDES {
            let [x, y, z, sliding] = &self.spring[group];
            springs.tangential = V3::load([x, y, z]);
            springs.sliding = V::load(sliding);
        }
        if L::TURNS {
            let [x, y, z, twisting] = &self.rolling[group];
            springs.rolling = V3::load([x, y, z]);
            springs.twisting = V::load(twisting);
        }
        springs
    }

    /// All that one group remembers.
    #[inline(always)]
    pub fn memory<V: Lanes, L: Law>(&self, group: usize) -> Memory<V> {
        let [x, y, z] = &self.force[group];
        let mut memory = Memory {
            springs: self.springs::<V, L>(group),
            force: V3::load([x, y, z]),
            couple: V3::zero(),
        };
        if L::TURNS {
            let [x, y, z] = &self.couple[group];
            memory.couple = V3::load([x, y, z]);
        }
        memory
    }

    /// Keep the springs and torques of `response` and the `force` on i for the next step.
    #[inline(always)]
    pub fn remember<V: Lanes, L: Law>(
        &mut self,
        group: usize,
        force: V3<V>,
        response: &Response<V>,
    ) {
        let [x, y, z] = &mut self.force[group];
        force.store([x, y, z]);
        if L::SLIDES {
            let [x, y, z, sliding] = &mut self.spring[group];
            response.springs.tangential.store([x, y, z]);
            response.springs.sliding.store(sliding);
        }
        if L::TURNS {
            let [x, y, z, twisting] = &mut self.rolling[group];
            response.springs.rolling.store([x, y, z]);
            response.springs.twisting.store(twisting);
            let [x, y, z] = &mut self.couple[group];
            response.couple.store([x, y, z]);
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
