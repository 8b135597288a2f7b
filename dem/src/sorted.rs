//! The grains as the solver keeps them: sorted along the cells, cut into slabs.

use crate::cut::{Cut, Memory};
use crate::grains::{Constraint, Horizontal};
use crate::lanes::{Place, Row};
use crate::search::Grid;
use crate::shared::Shared;
use crate::slab::{BLOCK, Slab};
use crate::slots::Kept;
use crate::step::{Gauges, Rows};
use crate::view::DUMMIES;
use crate::{Body, Contact, Error, Model, State};
use glam::{DQuat, DVec3};
use std::ops::Range;

/// One grain between two orders.
#[derive(Clone, Copy)]
pub(crate) struct Grain {
    pub id: u32,
    pub radius: f64,
    pub mass: f64,
    pub moment_of_inertia: f64,
    pub constraint: Constraint,
    pub position: DVec3,
    /// Position minus displacement, unwrapped: where the grain would have started.
    pub origin: DVec3,
    pub velocity: DVec3,
    pub spin: DVec3,
    pub turned: DVec3,
    pub orientation: DQuat,
}

/// A contact that lasts, by the identities of its bodies; vectors of `a` against `b`.
#[derive(Clone, Copy)]
pub(crate) struct Lasting {
    pub a: u32,
    pub b: Body,
    pub kept: Kept,
}

impl Lasting {
    pub fn of(contact: &Contact) -> Self {
        let history = contact.history;
        Self {
            a: contact.i,
            b: contact.j,
            kept: Kept {
                spring: Row::new(history.spring, history.sliding as u8 as f64),
                force: Row::ZERO,
                rolling: Row::new(history.rolling_spring, history.twisting_spring),
                couple: Row::ZERO,
            },
        }
    }
}

/// Everything that is laid out anew by a neighbour search.
pub(crate) struct Sorted {
    pub id: Vec<u32>,
    pub mass: Vec<f64>,
    pub moment_of_inertia: Vec<f64>,
    pub constraint: Vec<Constraint>,
    pub origin: Vec<DVec3>,
    /// dt/m and dt/I.
    pub kick: Vec<f64>,
    pub twist: Vec<f64>,
    pub rows: Rows,
    pub slabs: Vec<Slab>,
    pub gauges: Gauges,
    /// Near pairs, each counted once.
    pub pair_count: usize,
    /// What contacts remembered whose bodies are no longer near each other.
    pub parted: Vec<Kept>,
}

/// Grains of `state` in the order of their identities.
pub(crate) fn grains_of(state: &State) -> Vec<Grain> {
    let g = &state.grains;
    (0..g.len())
        .map(|k| Grain {
            id: g.id[k],
            radius: g.radius[k],
            mass: g.mass[k],
            moment_of_inertia: g.moment_of_inertia[k],
            constraint: g.constraint[k],
            position: g.position[k],
            origin: g.position[k] - g.displacement[k],
            velocity: g.velocity[k],
            spin: g.angular_velocity[k],
            turned: DVec3::ZERO,
            orientation: g.orientation[k],
        })
        .collect()
}

impl Sorted {
    /// Sort `grains`, find near pairs within `skin`, and cut into `threads` slabs.
    /// `offsets`: the walls' places.
    pub fn new(
        model: &Model,
        mut grains: Vec<Grain>,
        lasting: &[Lasting],
        offsets: &[f64],
        skin: f64,
        threads: usize,
    ) -> Result<Self, Error> {
        for grain in &mut grains {
            wrap(model, grain);
        }
        let n = grains.len();
        let position: Vec<DVec3> = grains.iter().map(|g| g.position).collect();
        let id: Vec<u32> = grains.iter().map(|g| g.id).collect();
        let mean_radius = grains.iter().map(|g| g.radius).sum::<f64>() / n.max(1) as f64;
        let width = 2.0 * mean_radius + skin;
        let (grid, order) = Grid::new(model.domain, &position, &id, width);
        let grains: Vec<Grain> = order.iter().map(|&k| grains[k as usize]).collect();
        let position: Vec<DVec3> = grains.iter().map(|g| g.position).collect();
        let radius: Vec<f64> = grains.iter().map(|g| g.radius).collect();
        let pairs = grid.near_pairs(&position, &radius, skin);

        let spins = model.law.slides();
        let spinning = |row: fn(&Grain) -> Row, dummies: &[Row]| {
            let rows = grains.iter().filter(|_| spins).map(row);
            let dummies = dummies.iter().filter(|_| spins);
            Shared::new(rows.chain(dummies.copied()).collect())
        };
        let resting = [Row::ZERO; DUMMIES.len()];
        let rows = Rows {
            position: with_dummies(&grains, |g| Row::new(g.position, g.radius), &DUMMIES),
            velocity: with_dummies(&grains, |g| Row::new(g.velocity, 0.0), &resting),
            spin: spinning(|g| Row::new(g.spin, g.radius), &resting),
            turned: spinning(|g| Row::new(g.turned, 0.0), &[]),
            orientation: Shared::new(grains.iter().map(|g| g.orientation).collect()),
            left: Shared::new(Vec::new()),
            way: Shared::new(Vec::new()),
        };

        let mut place = vec![0u32; n];
        for (k, grain) in grains.iter().enumerate() {
            place[grain.id as usize] = k as u32;
        }
        let near_walls = near_walls(model, &grains, offsets, skin);
        let memory = Memory::new(lasting, &place, &pairs, &near_walls)?;
        let (gauges, layers) = lay_gauges(&grains, &near_walls);
        let cut = Cut {
            model,
            grains: &grains,
            pairs: &pairs,
            near_walls: &near_walls,
            memory: &memory,
            layers: &layers,
        };
        let slabs = borders(n, &pairs, threads).into_iter();
        let slabs = slabs.map(|own| cut.slab(own)).collect();

        let step = model.step;
        Ok(Self {
            id: grains.iter().map(|g| g.id).collect(),
            mass: grains.iter().map(|g| g.mass).collect(),
            moment_of_inertia: grains.iter().map(|g| g.moment_of_inertia).collect(),
            constraint: grains.iter().map(|g| g.constraint).collect(),
            origin: grains.iter().map(|g| g.origin).collect(),
            kick: grains.iter().map(|g| step / g.mass).collect(),
            twist: grains
                .iter()
                .filter(|_| spins)
                .map(|g| step / g.moment_of_inertia)
                .collect(),
            rows,
            slabs,
            gauges,
            pair_count: pairs.len(),
            parted: memory.parted,
        })
    }

    /// The grains as they are now, velocities half a step behind.
    pub fn grains(&mut self) -> Vec<Grain> {
        let spins = !self.twist.is_empty();
        let position = self.rows.position.get_mut();
        let velocity = self.rows.velocity.get_mut();
        let spin = self.rows.spin.get_mut();
        let turned = self.rows.turned.get_mut();
        let orientation = self.rows.orientation.get_mut();
        let spinning = |rows: &[Row], k: usize| if spins { rows[k].xyz() } else { DVec3::ZERO };
        (0..self.id.len())
            .map(|k| Grain {
                id: self.id[k],
                radius: position[k].w(),
                mass: self.mass[k],
                moment_of_inertia: self.moment_of_inertia[k],
                constraint: self.constraint[k],
                position: position[k].xyz(),
                origin: self.origin[k],
                velocity: velocity[k].xyz(),
                spin: spinning(spin, k),
                turned: spinning(turned, k),
                orientation: orientation[k],
            })
            .collect()
    }

    /// The contacts that touched in the last evaluation.
    pub fn lasting(&self) -> Vec<Lasting> {
        let mut lasting = Vec::new();
        for slab in &self.slabs {
            for slot in Slab::touches(&slab.touching, slab.pair_count) {
                let [i, j] = slab.pairs[slot / 4][slot % 4].map(Place::index);
                if slab.own.contains(&i) {
                    lasting.push(Lasting {
                        a: self.id[i],
                        b: Body::Grain(self.id[j]),
                        kept: slab.slots.get(slot),
                    });
                }
            }
            for (k, wall) in slab.walls.iter().enumerate() {
                for slot in Slab::touches(&wall.touching, wall.count) {
                    lasting.push(Lasting {
                        a: self.id[wall.grains[slot].index()],
                        b: Body::Wall(k as u32),
                        kept: wall.slots.get(slot),
                    });
                }
            }
        }
        lasting
    }

    /// Memory in use [bytes].
    pub fn bytes(&self) -> usize {
        let spins = !self.twist.is_empty();
        let rows = if spins { 4 } else { 2 } * size_of::<Row>();
        let grain = rows
            + size_of::<DQuat>()
            + size_of::<DVec3>()
            + size_of::<Constraint>()
            + 4
            + 8 * if spins { 4 } else { 3 };
        // SAFETY: lengths do not change while the solver steps.
        let along =
            unsafe { size_of_val(self.rows.left.read()) + size_of_val(self.rows.way.read()) };
        along + self.id.len() * grain + self.slabs.iter().map(Slab::bytes).sum::<usize>()
    }
}

fn with_dummies(grains: &[Grain], row: fn(&Grain) -> Row, dummies: &[Row]) -> Shared<Row> {
    let rows = grains.iter().map(row);
    Shared::new(rows.chain(dummies.iter().copied()).collect())
}

/// Bring a grain back into the box along periodic sides; its displacement is kept.
fn wrap(model: &Model, grain: &mut Grain) {
    for axis in 0..2 {
        if model.domain.periodic[axis] {
            let length = model.domain.size[axis];
            let turns = (grain.position[axis] / length).floor();
            if turns != 0.0 {
                grain.position[axis] -= turns * length;
                grain.origin[axis] -= turns * length;
            }
        }
    }
}

/// For each wall the sorted grains whose surface is nearer to it than `skin`.
fn near_walls(model: &Model, grains: &[Grain], offsets: &[f64], skin: f64) -> Vec<Vec<u32>> {
    let near = |normal: DVec3, offset: f64| {
        let close = move |g: &Grain| g.position.dot(normal) - offset < g.radius + skin;
        let all = grains.iter().enumerate();
        all.filter(|(_, g)| close(g))
            .map(|(k, _)| k as u32)
            .collect()
    };
    let walls = model.walls.iter().zip(offsets);
    walls
        .map(|(wall, &offset)| near(wall.normal, offset))
        .collect()
}

/// Held and driven grains of each layer, sorted.
pub(crate) type Layers = [Vec<u32>; 2];

/// One gauge for each wall, then the held and the driven layer.
fn lay_gauges(grains: &[Grain], near_walls: &[Vec<u32>]) -> (Gauges, Layers) {
    let layer = |kind: Horizontal| -> Vec<u32> {
        let all = grains.iter().enumerate();
        all.filter(|(_, g)| g.constraint.horizontal == kind)
            .map(|(k, _)| k as u32)
            .collect()
    };
    let layers = [layer(Horizontal::Held), layer(Horizontal::Driven)];
    let mut ranges = Vec::new();
    let mut end = 0;
    for gauge in near_walls.iter().chain(&layers) {
        ranges.push(end..end + gauge.len());
        end += gauge.len();
    }
    let gauges = Gauges {
        values: Shared::new(vec![0.0; end]),
        ranges,
    };
    (gauges, layers)
}

/// Cut the grains into ranges of whole blocks with about the same number of pairs.
fn borders(n: usize, pairs: &[[u32; 2]], threads: usize) -> Vec<Range<usize>> {
    let blocks = n.div_ceil(BLOCK);
    // A grain costs about as much as a pair besides its own pairs.
    let mut work = vec![0usize; blocks];
    for (block, work) in work.iter_mut().enumerate() {
        *work = ((block + 1) * BLOCK).min(n) - block * BLOCK;
    }
    for pair in pairs {
        work[pair[0] as usize / BLOCK] += 1;
    }
    let total: usize = work.iter().sum();
    let mut ranges = Vec::with_capacity(threads);
    let (mut block, mut done) = (0, 0);
    for thread in 0..threads {
        let first = block;
        while block < blocks && done + work[block] / 2 < total * (thread + 1) / threads {
            done += work[block];
            block += 1;
        }
        if thread + 1 == threads {
            block = blocks;
        }
        ranges.push((first * BLOCK).min(n)..(block * BLOCK).min(n));
    }
    ranges
}
