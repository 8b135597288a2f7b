//! What goes along with the grains and pushes them: pore water, for one.
//!
//! Grains and companion meet at exchanges: every few steps, as the companion says, and at each
//! neighbour search. In between its forces are held. A step with an exchange is: grains and walls
//! move; all threads [`follow`](Companion::follow) them; the companion is
//! [`alone`](Companion::alone) for a moment if it wants to, and where it is
//! [`due`](Companion::due) for longer, [`settles`](Companion::settle); then all threads
//! [`push`](Companion::push), and contacts add their forces. A search comes after grains have been
//! followed in their old order, and before they are pushed in the new one. A companion
//! reads the grains where the solver keeps them, and is told how far each has moved since
//! the last exchange: the sum of all drifts, whatever happened in between.
//!
//! Where the solver keeps a ledger, the work of the forces on the grains is booked, half of that
//! of a drift with the forces before it and half with those after it, as that of the walls.
//!
//! The companion of [`Solver::advance`] is `()`: then none of this is compiled in.

use crate::barrier::Barrier;
use crate::grains::{Constraint, Horizontal};
use crate::lanes::Row;
use crate::slab::Slab;
use crate::{Error, Model, Solver, WallMotion, WallState};
use glam::DVec3;
use std::cell::UnsafeCell;
use std::ops::Range;

/// Something that follows the motion of grains and walls and pushes them.
///
/// Grains are in the solver's order, which changes with each neighbour search. For the same
/// bits on any number of threads, sums must not depend on how grains are shared out.
pub trait Companion: Send + Sync {
    /// Is there anything to do?
    const ACTIVE: bool = true;

    /// The order of the grains is new: before the first step, and after each neighbour search.
    ///
    /// # Errors
    /// What makes it impossible to go on.
    fn arrange(&mut self, bed: &Bed) -> Result<(), String>;

    /// Is there an exchange in this step (the first one is 1), whether or not there is a search?
    fn exchanges(&self, step: u64) -> bool;

    /// Grains and walls have moved: called by all threads.
    fn follow(&self, moved: &Moved, threads: &Threads);

    /// Is [`alone`](Self::alone) to be called at the exchange of this step?
    fn wants_to_be_alone(&self, step: u64) -> bool;

    /// Alone, after all have followed, while the threads wait: for what is done often. What goes
    /// wrong is told in [`settle`](Self::settle) or [`arrange`](Self::arrange).
    fn alone(&mut self, moved: &Moved);

    /// Is [`settle`](Self::settle) to be called at the exchange of this step?
    fn due(&self, step: u64) -> bool;

    /// Alone, between the motion of a step and its forces.
    ///
    /// # Errors
    /// What makes it impossible to go on.
    fn settle(&mut self, bed: &Bed) -> Result<(), String>;

    /// Write the forces [N] on the grains `own`, until the next exchange, to `force`, which is zero:
    /// called by all threads, each with the grains that it moves. `moved.step` is 0 for the
    /// forces of the instant at which the companion joins. Forces along directions that a
    /// constraint holds act on its layer.
    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]);

    /// The force on a wall along minus its normal [N], positive when it pushes the wall away from
    /// the grains: asked by each thread, after its `push`.
    fn wall_force(&self, wall: usize) -> f64;
}

/// A companion as the threads of a step see it: all at once, and now and then one alone.
pub(crate) struct Beside<'a, C>(&'a UnsafeCell<C>);

// SAFETY: access goes through `shared` and `alone`, whose callers promise not to mix them.
unsafe impl<C: Send + Sync> Sync for Beside<'_, C> {}

impl<'a, C> Beside<'a, C> {
    pub fn new(companion: &'a mut C) -> Self {
        Self(UnsafeCell::from_mut(companion))
    }

    /// # Safety
    /// Nobody is alone with it.
    pub unsafe fn shared(&self) -> &C {
        // SAFETY: the caller's promise.
        unsafe { &*self.0.get() }
    }

    /// # Safety
    /// Nobody else has it, until all have met.
    #[allow(clippy::mut_from_ref, reason = "that is the point, as `Shared::write`")]
    pub unsafe fn alone(&self) -> &mut C {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.0.get() }
    }
}

/// No companion.
impl Companion for () {
    const ACTIVE: bool = false;

    fn arrange(&mut self, _: &Bed) -> Result<(), String> {
        Ok(())
    }
    fn exchanges(&self, _: u64) -> bool {
        false
    }
    fn follow(&self, _: &Moved, _: &Threads) {}
    fn wants_to_be_alone(&self, _: u64) -> bool {
        false
    }
    fn alone(&mut self, _: &Moved) {}
    fn due(&self, _: u64) -> bool {
        false
    }
    fn settle(&mut self, _: &Bed) -> Result<(), String> {
        Ok(())
    }
    fn push(&self, _: &Moved, _: &Threads, _: Range<usize>, _: &mut [Row]) {}
    fn wall_force(&self, _: usize) -> f64 {
        0.0
    }
}

/// The threads of a solver, as one of them sees them.
pub struct Threads<'a> {
    pub(crate) index: usize,
    pub(crate) count: usize,
    pub(crate) barrier: &'a Barrier,
}

impl Threads<'_> {
    /// Return when all threads have called this. What each wrote before is visible to all
    /// afterwards.
    pub fn meet(&self) {
        self.barrier.wait();
    }

    /// This thread's share of `count` things.
    pub fn share(&self, count: usize) -> Range<usize> {
        count * self.index / self.count..count * (self.index + 1) / self.count
    }
}

/// Where grains and walls have got to at an exchange. Rows beyond the grains are the solver's own.
pub struct Moved<'a> {
    /// Number of the step since the solver began, from 1.
    pub step: u64,
    /// Steps since the last exchange, and from the one before until that; zero where there was none.
    pub passed: [u64; 2],
    /// Centre [m] and radius [m].
    pub position: &'a [Row],
    /// Way since the last exchange [m]. After a search it is zero.
    pub way: &'a [Row],
    /// Velocity half a step ago [m/s].
    pub velocity: &'a [Row],
    /// Way of the walls along their normals since the last exchange [m].
    pub wall_ways: &'a [f64],
    /// Walls, velocities half a step ago.
    pub walls: &'a [WallState],
}

/// The grains between two parts of a step, in the solver's order.
pub struct Bed<'a> {
    /// What is solved.
    pub model: &'a Model,
    /// Number of the step since the solver began that moved the grains to where they are.
    pub step: u64,
    /// Simulated time of the positions [s].
    pub time: f64,
    /// Identities.
    pub id: &'a [u32],
    /// Centre [m] and radius [m]; not wrapped at periodic sides since the last search.
    pub position: &'a [Row],
    /// Masses [kg].
    pub mass: &'a [f64],
    /// What is held or prescribed.
    pub constraint: &'a [Constraint],
    /// Walls, velocities half a step ago.
    pub walls: &'a [WallState],
    slabs: &'a [Slab],
}

impl Bed<'_> {
    /// Sum of the normal forces that push each grain in its contacts [N], walls included, in
    /// the last evaluation; in the solver's order.
    pub fn contact_loads(&self, loads: &mut Vec<f64>) {
        loads.clear();
        loads.resize(self.id.len(), 0.0);
        for slab in self.slabs {
            for slot in Slab::touches(&slab.touching, slab.pair_count) {
                let [i, j] = slab.pairs[slot / 4][slot % 4].map(|place| place.index());
                let between = self.position[i].xyz() - self.position[j].xyz();
                let normal = self.model.domain.nearest_image(between).normalize_or_zero();
                let load = slab.slots.get(slot).force.xyz().dot(normal).max(0.0);
                for k in [i, j] {
                    if slab.own.contains(&k) {
                        loads[k] += load;
                    }
                }
            }
            for (wall, description) in slab.walls.iter().zip(&self.model.walls) {
                for slot in Slab::touches(&wall.touching, wall.count) {
                    let force = wall.slots.get(slot).force.xyz();
                    loads[wall.grains[slot].index()] += force.dot(description.normal).max(0.0);
                }
            }
        }
    }
}

impl Solver {
    /// Advance by `steps` time steps together with `companion`, which joins at the first call and
    /// stays: a solver that has one cannot go on without it.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance), and [`Error::Companion`].
    pub fn advance_together<C: Companion>(
        &mut self,
        steps: u64,
        companion: &mut C,
    ) -> Result<(), Error> {
        self.change_outside(None);
        if !self.joined {
            self.join(companion)?;
        }
        self.walk(steps, companion)
    }

    /// Work of the companion on the grains since it joined [J]; zero without a ledger.
    pub fn work_of_companion(&self) -> f64 {
        self.losses().companion + self.held_work()
    }

    /// Steps since the last exchange with a companion, ways since then of the grains in the solver's
    /// order, and of the walls along their normals [m]; none where it has not joined yet.
    pub fn since_exchange(&self) -> (u64, Vec<Row>, Vec<f64>) {
        if !self.joined {
            let walls = vec![0.0; self.boundary.walls.len()];
            return (0, vec![Row::ZERO; self.sorted.id.len()], walls);
        }
        // SAFETY: the solver is not stepping, so nobody writes.
        let (now, left) = unsafe {
            let rows = &self.sorted.rows;
            (rows.position.read(), rows.left.read())
        };
        let ways = now[..self.sorted.id.len()].iter().zip(left);
        let ways = ways.map(|(now, left)| Row::new(now.xyz() - left.xyz(), 0.0));
        let walls = self.boundary.walls.iter().zip(&self.boundary.left);
        (
            self.boundary.sums.steps - self.boundary.exchanged,
            ways.collect(),
            walls.map(|(wall, left)| wall.offset - left).collect(),
        )
    }

    /// Work since the last exchange of the forces that are held [J].
    pub(crate) fn held_work(&self) -> f64 {
        if !self.joined || !self.model.ledger {
            return 0.0;
        }
        // SAFETY: the solver is not stepping, so nobody writes.
        let (now, left) = unsafe {
            let rows = &self.sorted.rows;
            (rows.position.read(), rows.left.read())
        };
        let works = self.sorted.slabs.iter().flat_map(|slab| {
            let places = now[slab.own.clone()].iter().zip(&left[slab.own.clone()]);
            let pushed = slab.pushed.iter().zip(places);
            pushed.map(|(pushed, (now, left))| pushed.xyz().dot(now.xyz() - left.xyz()))
        });
        works.sum()
    }

    /// The grains where the solver keeps them.
    pub fn bed(&self) -> Bed<'_> {
        self.bed_after(0)
    }

    /// The same after this many further motions.
    pub(crate) fn bed_after(&self, motions: u64) -> Bed<'_> {
        let step = self.boundary.sums.steps + motions;
        // SAFETY: the solver is not stepping, so nobody writes.
        let position = unsafe { self.sorted.rows.position.read() };
        Bed {
            model: &self.model,
            step,
            time: self.start + step as f64 * self.model.step,
            id: &self.sorted.id,
            position,
            mass: &self.sorted.mass,
            constraint: &self.sorted.constraint,
            walls: &self.boundary.walls,
            slabs: &self.sorted.slabs,
        }
    }

    /// The forces of a companion that joins act from this instant: velocities, half a step
    /// behind, take half a kick back, as from the other forces of the start.
    fn join<C: Companion>(&mut self, companion: &mut C) -> Result<(), Error> {
        companion.arrange(&self.bed()).map_err(Error::Companion)?;
        self.sorted.rows.leave();
        self.boundary.leave();
        self.boundary.exchanged = self.boundary.sums.steps;
        let n = self.sorted.id.len();
        let mut pushes = vec![Row::ZERO; n];
        {
            let barrier = Barrier::new(1);
            let threads = Threads {
                index: 0,
                count: 1,
                barrier: &barrier,
            };
            // SAFETY: the solver is not stepping, so nobody writes.
            let moved = unsafe {
                Moved {
                    step: 0,
                    passed: [0; 2],
                    position: self.sorted.rows.position.read(),
                    way: self.sorted.rows.way.read(),
                    velocity: self.sorted.rows.velocity.read(),
                    wall_ways: &self.boundary.ways,
                    walls: &self.boundary.walls,
                }
            };
            companion.push(&moved, &threads, 0..n, &mut pushes);
        }
        let velocity = self.sorted.rows.velocity.get_mut();
        for slab in &mut self.sorted.slabs {
            for (own, k) in slab.own.clone().enumerate() {
                let free = match self.sorted.constraint[k].horizontal {
                    Horizontal::Free => DVec3::ONE,
                    Horizontal::Held | Horizontal::Driven => DVec3::Z,
                };
                let push = free * pushes[k].xyz();
                let force = &mut slab.force[own];
                *force = Row::new(force.xyz() + push, force.w());
                let back = 0.5 * self.sorted.kick[k] * push;
                velocity[k] = Row::new(velocity[k].xyz() - back, velocity[k].w());
            }
            slab.pushed = pushes[slab.own.clone()].to_vec();
        }
        for (k, wall) in self.model.walls.iter().enumerate() {
            let force = companion.wall_force(k);
            self.boundary.companion_force[k] = force;
            if let WallMotion::Stress(load) = wall.motion {
                self.boundary.walls[k].velocity += 0.5 * self.model.step * force / load.mass;
            }
        }
        self.joined = true;
        Ok(())
    }
}
