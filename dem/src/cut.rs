//! Cutting the sorted grains into slabs, each with the histories of its contacts.

use crate::lanes::{Place, Row};
use crate::regroup::STRETCH;
use crate::slab::{BLOCK, Gauged, Slab, WallSlab};
use crate::slots::{Kept, Slots};
use crate::sorted::{Grain, Lasting, Layers};
use crate::{Body, Error, Model};
use std::ops::Range;

/// Where the histories of lasting contacts go.
pub(crate) struct Memory {
    /// (index of the pair, history), sorted.
    pairs: Vec<(u32, Kept)>,
    /// The same for each wall, by sorted grain.
    walls: Vec<Vec<(u32, Kept)>>,
    /// Contacts that have ended.
    pub parted: Vec<Kept>,
}

impl Memory {
    pub fn new(
        lasting: &[Lasting],
        place: &[u32],
        pairs: &[[u32; 2]],
        near_walls: &[Vec<u32>],
    ) -> Result<Self, Error> {
        let unknown = |contact: &Lasting| {
            let (a, b) = (contact.a, contact.b);
            Error::Invalid(format!(
                "contact of grain {a} with {b:?}: there is no such body"
            ))
        };
        let mut memory = Self {
            pairs: Vec::new(),
            walls: vec![Vec::new(); near_walls.len()],
            parted: Vec::new(),
        };
        for contact in lasting {
            if contact.b == Body::Grain(contact.a) {
                let a = contact.a;
                return Err(Error::Invalid(format!("contact of grain {a} with itself")));
            }
            let a = *place
                .get(contact.a as usize)
                .ok_or_else(|| unknown(contact))?;
            let near = match contact.b {
                Body::Grain(b) => {
                    let b = *place.get(b as usize).ok_or_else(|| unknown(contact))?;
                    let (pair, kept) = match a < b {
                        true => ([a, b], contact.kept),
                        false => ([b, a], contact.kept.reversed()),
                    };
                    let found = pairs.binary_search(&pair);
                    found.map(|index| memory.pairs.push((index as u32, kept)))
                }
                Body::Wall(k) => {
                    let k = k as usize;
                    let near = near_walls.get(k).ok_or_else(|| unknown(contact))?;
                    let found = near.binary_search(&a);
                    found.map(|_| memory.walls[k].push((a, contact.kept)))
                }
            };
            if near.is_err() {
                memory.parted.push(contact.kept);
            }
        }
        memory.pairs.sort_unstable_by_key(|&(index, _)| index);
        for wall in &mut memory.walls {
            wall.sort_unstable_by_key(|&(grain, _)| grain);
        }
        let lists = memory.walls.iter().chain([&memory.pairs]);
        if let Some(twice) = lists
            .flat_map(|list| list.windows(2))
            .find(|w| w[0].0 == w[1].0)
        {
            let force = twice[0].1.spring.xyz();
            let what =
                format!("two contacts of the same two bodies, one with the spring {force} m");
            return Err(Error::Invalid(what));
        }
        Ok(memory)
    }
}

/// What slabs are cut from.
pub(crate) struct Cut<'a> {
    pub model: &'a Model,
    pub grains: &'a [Grain],
    pub pairs: &'a [[u32; 2]],
    pub near_walls: &'a [Vec<u32>],
    pub memory: &'a Memory,
    pub layers: &'a Layers,
}

impl Cut<'_> {
    /// The slab of the grains `own`.
    pub fn slab(&self, own: Range<usize>) -> Slab {
        let (slides, turns) = (self.model.law.slides(), self.model.law.turns());
        let n = self.grains.len();

        let ours = |k: u32| own.contains(&(k as usize));
        let mut chosen = Vec::new();
        let mut remembered = Vec::new();
        let mut stretches = Vec::new();
        let mut stretch = 0;
        let mut memory = self.memory.pairs.iter().peekable();
        for (index, pair) in self.pairs.iter().enumerate() {
            let kept = memory.next_if(|(at, _)| *at == index as u32);
            if ours(pair[0]) || ours(pair[1]) {
                if pair[0] as usize / STRETCH != stretch {
                    stretch = pair[0] as usize / STRETCH;
                    stretches.push(chosen.len());
                }
                if let Some((_, kept)) = kept {
                    remembered.push((chosen.len(), *kept));
                }
                chosen.push(pair.map(|k| Place::of(k as usize)));
            }
        }
        let pair_count = chosen.len();
        stretches.push(pair_count);
        let groups = pair_count.div_ceil(4);
        chosen.resize(4 * groups, [Place::of(n), Place::of(n + 1)]);
        let (pairs, _) = chosen.as_chunks();
        let pairs = pairs.to_vec();
        let mut slots = Slots::new(groups, slides, turns);
        let mut touching = vec![0u8; groups];
        for (slot, kept) in remembered {
            slots.set(slot, kept);
            touching[slot / 4] |= 1 << (slot % 4);
        }

        let target = |k: Place| {
            let row = k.index().wrapping_sub(own.start);
            Place::of(row.min(own.len()))
        };
        let targets = |group: &[[Place; 2]; 4]| group.map(|pair| pair.map(target));
        let targets = pairs.iter().map(targets).collect();

        let gauged = |layer: &[u32]| -> Vec<Gauged> {
            let all = layer.iter().enumerate().filter(|&(_, &k)| ours(k));
            all.map(|(gauge, &k)| Gauged {
                own: k - own.start as u32,
                gauge: gauge as u32,
            })
            .collect()
        };
        let count = own.len();
        let still = own
            .clone()
            .filter(|&k| slides && self.grains[k].constraint.rotation_held);
        let weight = |k: usize| Row::new(self.grains[k].mass * self.model.gravity, 0.0);
        let mut force: Vec<Row> = own.clone().map(weight).collect();
        force.push(Row::ZERO);
        let mut slab = Slab {
            walls: (0..self.near_walls.len())
                .map(|k| self.wall(k, &own))
                .collect(),
            force,
            torque: vec![Row::ZERO; if slides { count + 1 } else { 0 }],
            rolling_loss: vec![0.0; if turns { count + 1 } else { 0 }],
            pushed: Vec::new(),
            apart: Vec::new(),
            losses: vec![Default::default(); count.div_ceil(BLOCK)],
            held: gauged(&self.layers[0]),
            driven: gauged(&self.layers[1]),
            still: still.map(|k| (k - own.start) as u32).collect(),
            own,
            pairs,
            targets,
            pair_count,
            stretches,
            touching,
            slots,
        };
        slab.regroup();
        slab
    }

    fn wall(&self, k: usize, own: &Range<usize>) -> WallSlab {
        let near = &self.near_walls[k];
        let gauge = near.partition_point(|&g| (g as usize) < own.start);
        let end = near.partition_point(|&g| (g as usize) < own.end);
        let near = &near[gauge..end];
        let count = near.len();
        let mut grains: Vec<Place> = near.iter().map(|&k| Place::of(k as usize)).collect();
        let dummy = Place::of(self.grains.len() + 2);
        grains.resize(count.next_multiple_of(4), dummy);
        let full = self.model.walls[k].surface == crate::Surface::Full;
        let slides = full && self.model.law.slides();
        let turns = full && self.model.law.turns();
        let mut slots = Slots::new(grains.len() / 4, slides, turns);
        let mut touching = vec![0u8; grains.len() / 4];
        for (grain, kept) in &self.memory.walls[k] {
            if let Ok(slot) = near.binary_search(grain) {
                slots.set(slot, *kept);
                touching[slot / 4] |= 1 << (slot % 4);
            }
        }
        WallSlab {
            grains,
            count,
            gauge,
            touching,
            slots,
        }
    }
}
