//! Which pairs share a group: those that touch, and those that do not.
//!
//! The law works on four pairs at a time and costs as much for one contact as for four. So
//! contacts are kept together: every so often, within each stretch of grains, the pairs that
//! touch move before the others. Both keep their order, so that the pairs of one grain stand
//! in the same order in every slab, and its sums have the same bits.

use crate::slab::Slab;

/// Grains whose pairs are ordered together: so few that they stay in the caches.
pub(crate) const STRETCH: usize = 512;

/// Steps between two orderings. One costs about half a step.
pub(crate) const REGROUP_EVERY: u64 = 64;

impl Slab {
    /// Move the pairs that touched in the last evaluation before the others of their stretch.
    pub fn regroup(&mut self) {
        let mut first = 0;
        let mut apart = std::mem::take(&mut self.apart);
        for &end in &self.stretches {
            apart.reserve(end - first);
            let mut free = first;
            for slot in first..end {
                let (group, lane) = (slot / 4, slot % 4);
                let pair = (self.pairs[group][lane], self.targets[group][lane]);
                if self.touching[group] >> lane & 1 == 0 {
                    apart.push(pair);
                    continue;
                }
                if slot > free {
                    (
                        self.pairs[free / 4][free % 4],
                        self.targets[free / 4][free % 4],
                    ) = pair;
                    self.slots.copy(slot, free);
                }
                free += 1;
            }
            for slot in first..end {
                let bit = 1 << (slot % 4);
                match slot < free {
                    true => self.touching[slot / 4] |= bit,
                    false => self.touching[slot / 4] &= !bit,
                }
            }
            for (slot, pair) in (free..end).zip(apart.drain(..)) {
                (
                    self.pairs[slot / 4][slot % 4],
                    self.targets[slot / 4][slot % 4],
                ) = pair;
                self.slots.set(slot, Default::default());
            }
            first = end;
        }
        self.apart = apart;
    }
}
