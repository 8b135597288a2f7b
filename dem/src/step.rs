//! The order of one grain step, as every thread of a solver walks through it.

use crate::barrier::Barrier;
use crate::boundary::{Boundary, Loading};
use crate::companion::{Beside, Companion, Moved, Threads};
use crate::kernels::Kernels;
use crate::lanes::Row;
use crate::motion::{Own, TURN_EVERY, turned};
use crate::regroup::REGROUP_EVERY;
use crate::shared::Shared;
use crate::slab::Slab;
use crate::view::View;
use glam::DQuat;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Rows of all grains in sorted order; positions, velocities and spins end with the dummies.
pub(crate) struct Rows {
    pub position: Shared<Row>,
    pub velocity: Shared<Row>,
    /// Empty where grains do not spin, as `turned`.
    pub spin: Shared<Row>,
    pub turned: Shared<Row>,
    pub orientation: Shared<DQuat>,
    /// Where grains were at the last exchange with a companion, and how far they have got until the
    /// present one [m]; empty without one.
    pub left: Shared<Row>,
    pub way: Shared<Row>,
}

impl Rows {
    /// Ways of all grains begin here.
    pub fn leave(&mut self) {
        let position = self.position.get_mut().to_vec();
        self.way = Shared::new(vec![Row::ZERO; position.len()]);
        self.left = Shared::new(position);
    }
}

/// Forces that are summed over walls and layers: one array each.
pub(crate) struct Gauges {
    pub values: Shared<f64>,
    /// The walls, the held layer, the driven layer.
    pub ranges: Vec<Range<usize>>,
}

/// What the threads of one call share.
pub(crate) struct Crew<'a> {
    pub kernels: Kernels,
    pub loading: Loading<'a>,
    pub rows: &'a Rows,
    pub gauges: &'a Gauges,
    pub kick: &'a [f64],
    pub twist: &'a [f64],
    pub mass: &'a [f64],
    pub outside: Option<(&'a [Row], &'a [Row])>,
    pub barrier: &'a Barrier,
    /// The highest speed bound of each thread, as bits.
    pub speeds: &'a [AtomicU64],
    /// The way after which the neighbour list may miss a pair [m].
    pub reach: f64,
}

/// Why the threads came back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stop {
    /// All steps are made.
    Done,
    /// Grains have moved, and the forces of their new places need a new neighbour list.
    Search {
        /// Bound on the speed of the fastest grain [m/s].
        speed: f64,
    },
    /// The companion wants to be alone.
    Due,
}

/// How far a step has got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    Begun,
    /// Grains and walls have moved, and a companion has followed them.
    Moved,
}

impl Crew<'_> {
    /// Make steps until `until` are made since the solver began, or a search is needed.
    /// The first one goes on from `stage`.
    pub fn walk<C: Companion>(
        &self,
        thread: usize,
        slab: &mut Slab,
        mut boundary: Boundary,
        until: u64,
        mut stage: Stage,
        companion: &Beside<C>,
    ) -> (Boundary, Stop) {
        let _guard = self.barrier.guard();
        let threads = Threads {
            index: thread,
            count: self.speeds.len(),
            barrier: self.barrier,
        };
        while boundary.sums.steps < until {
            // A step that goes on from here had an exchange, if there is a companion.
            let mut exchanges = C::ACTIVE && stage == Stage::Moved;
            if stage == Stage::Begun {
                // SAFETY: nobody is alone with it before all have met.
                exchanges = unsafe { companion.shared() }.exchanges(boundary.sums.steps + 1);
                if let Some(stop) =
                    self.begin(slab, &mut boundary, &threads, &mut exchanges, companion)
                {
                    return (boundary, stop);
                }
            }
            let step = self.loading.model.step;
            self.push_own(slab, &boundary, step, |slab| {
                if exchanges {
                    // SAFETY: nobody is alone with it, nobody writes rows before the next barrier.
                    let (companion, moved) = unsafe { (companion.shared(), self.moved(&boundary)) };
                    self.take_pushes(slab, &threads, companion, &moved);
                }
                if C::ACTIVE {
                    slab.add_pushed();
                }
            });
            if exchanges {
                for (k, force) in boundary.companion_force.iter_mut().enumerate() {
                    // SAFETY: as above.
                    *force = unsafe { companion.shared() }.wall_force(k);
                }
            }
            stage = Stage::Begun;
            self.barrier.wait();
            // SAFETY: gauges are written before this barrier, and next after another one.
            let values = unsafe { self.gauges.values.read() };
            boundary.read(self.loading, &self.gauges.ranges, values);
        }
        (boundary, Stop::Done)
    }

    /// Motion of grains and walls, and what the companion does before it pushes, if it `exchanges`
    /// in this step. A search makes it exchange.
    fn begin<C: Companion>(
        &self,
        slab: &mut Slab,
        boundary: &mut Boundary,
        threads: &Threads,
        exchanges: &mut bool,
        companion: &Beside<C>,
    ) -> Option<Stop> {
        let step = self.loading.model.step;
        boundary.advance(self.loading);
        let speed = self.move_own(slab, boundary);
        self.speeds[threads.index].store(speed.to_bits(), Ordering::Relaxed);
        if *exchanges {
            self.measure_ways(slab);
        }
        self.barrier.wait();
        let speeds = self.speeds.iter();
        let speed = speeds
            .map(|bits| f64::from_bits(bits.load(Ordering::Relaxed)))
            .fold(boundary.wall_speed(), f64::max);
        boundary.travel += speed * step;
        let search = boundary.travel > self.reach || boundary.travel.is_nan();
        if C::ACTIVE && search && !*exchanges {
            *exchanges = true;
            self.measure_ways(slab);
            self.barrier.wait();
        }
        if *exchanges {
            boundary.exchange();
            let now = boundary.sums.steps + 1;
            // SAFETY: rows are written before the last barrier, and next after another; nobody is
            // alone with the companion before all have met.
            let (moved, wants) = unsafe {
                let moved = self.moved(boundary);
                companion.shared().follow(&moved, threads);
                (moved, companion.shared().wants_to_be_alone(now))
            };
            if wants {
                self.barrier.wait();
                if threads.index == 0 {
                    // SAFETY: the others wait for this one.
                    unsafe { companion.alone().alone(&moved) };
                }
                self.barrier.wait();
            }
        }
        if search {
            return Some(Stop::Search { speed });
        }
        // SAFETY: as above.
        let due = *exchanges && unsafe { companion.shared().due(boundary.sums.steps + 1) };
        due.then_some(Stop::Due)
    }

    /// What a companion is told.
    ///
    /// # Safety
    /// Nobody writes rows meanwhile.
    unsafe fn moved<'a>(&'a self, boundary: &'a Boundary) -> Moved<'a> {
        // SAFETY: the caller's promise.
        let (position, way, velocity) = unsafe {
            (
                self.rows.position.read(),
                self.rows.way.read(),
                self.rows.velocity.read(),
            )
        };
        Moved {
            step: boundary.sums.steps + 1,
            passed: boundary.passed,
            position,
            way,
            velocity,
            wall_ways: &boundary.ways,
            walls: &boundary.walls,
        }
    }

    /// How far own grains have got since the last exchange, and the work of what has pushed them:
    /// of the last drift half, the other half is done by what will.
    fn measure_ways(&self, slab: &mut Slab) {
        let range = slab.own.clone();
        // SAFETY: between the barriers only this thread touches its own grains.
        let (position, velocity, left, way) = unsafe {
            (
                &self.rows.position.read()[range.clone()],
                &self.rows.velocity.read()[range.clone()],
                self.rows.left.write(range.clone()),
                self.rows.way.write(range),
            )
        };
        for ((way, left), now) in way.iter_mut().zip(left).zip(position) {
            for lane in 0..4 {
                way.0[lane] = now.0[lane] - left.0[lane];
            }
            *left = *now;
        }
        if self.loading.model.ledger {
            let half = 0.5 * self.loading.model.step;
            slab.book_companion([&way[..], velocity], [1.0, -half]);
        }
    }

    /// The forces with which a companion pushes own grains from now on.
    fn take_pushes<C: Companion>(
        &self,
        slab: &mut Slab,
        threads: &Threads,
        companion: &C,
        moved: &Moved,
    ) {
        let own = slab.own.clone();
        slab.pushed.clear();
        slab.pushed.resize(own.len(), Row::ZERO);
        companion.push(moved, threads, own.clone(), &mut slab.pushed);
        if self.loading.model.ledger {
            let velocity = &moved.velocity[own];
            slab.book_companion([velocity; 2], [0.5 * self.loading.model.step, 0.0]);
        }
    }

    /// Kick and drift of own grains.
    fn move_own(&self, slab: &mut Slab, boundary: &Boundary) -> f64 {
        let range = slab.own.clone();
        let spins = if self.twist.is_empty() {
            0..0
        } else {
            range.clone()
        };
        // SAFETY: between the barriers only this thread touches its own grains.
        let mut own = unsafe {
            Own {
                position: self.rows.position.write(range.clone()),
                velocity: self.rows.velocity.write(range.clone()),
                spin: self.rows.spin.write(spins.clone()),
                turned: self.rows.turned.write(spins.clone()),
                twist: &self.twist[spins.clone()],
                kick: &self.kick[range.clone()],
                mass: &self.mass[range.clone()],
                gravity: self.loading.model.gravity,
                step: self.loading.model.step,
                outside: self
                    .outside
                    .map(|(force, torque)| (&force[range.clone()], &torque[range.clone()])),
            }
        };
        for driven in &slab.driven {
            own.velocity[driven.own as usize].0[0] = boundary.drive_velocity;
        }
        let speed = self.kernels.motion(&mut own, slab);
        let steps = boundary.sums.steps + 1;
        if steps.is_multiple_of(REGROUP_EVERY) {
            slab.regroup();
        }
        if steps.is_multiple_of(TURN_EVERY) {
            // SAFETY: as above.
            let orientation = unsafe { self.rows.orientation.write(spins) };
            for (orientation, rotation) in orientation.iter_mut().zip(own.turned) {
                *orientation = turned(*orientation, rotation.xyz());
                *rotation = Row::ZERO;
            }
        }
        speed
    }

    /// Contact forces on own grains, and their shares of the gauges. `step` is the time
    /// over which springs grow. `together` adds what else pushes the grains.
    pub fn push_own(
        &self,
        slab: &mut Slab,
        boundary: &Boundary,
        step: f64,
        together: impl FnOnce(&mut Slab),
    ) {
        let model = self.loading.model;
        // SAFETY: rows are written before the last barrier, and next after another one.
        let view = unsafe {
            View {
                law: &model.law,
                domain: model.domain,
                position: self.rows.position.read(),
                velocity: self.rows.velocity.read(),
                spin: self.rows.spin.read(),
                step,
            }
        };
        // SAFETY: rows and slabs were made by the same search.
        unsafe { self.kernels.pairs(&view, slab) };
        for (k, wall) in model.walls.iter().enumerate() {
            let start = self.gauges.ranges[k].start + slab.walls[k].gauge;
            let range = start..start + slab.walls[k].count;
            // SAFETY: each slab has its own range of each gauge.
            let gauge = unsafe { self.gauges.values.write(range) };
            self.kernels
                .wall(&view, slab, k, wall, boundary.walls[k], gauge);
        }
        together(slab);
        self.constrain(slab);
    }

    /// Horizontal forces on held and driven grains go to the gauges instead of the grains.
    fn constrain(&self, slab: &mut Slab) {
        let gravity = self.loading.model.gravity;
        let layers = [&slab.held, &slab.driven];
        let first_layer = self.loading.model.walls.len();
        for (k, layer) in layers.into_iter().enumerate() {
            let offset = self.gauges.ranges[first_layer + k].start;
            for place in layer {
                let force = &mut slab.force[place.own as usize].0;
                let weight = self.mass[slab.own.start + place.own as usize] * gravity.x;
                let at = offset + place.gauge as usize;
                // SAFETY: each grain has its own place in the gauge.
                unsafe { self.gauges.values.write(at..at + 1)[0] = force[0] - weight };
                force[0] = 0.0;
                force[1] = 0.0;
            }
        }
        for &own in &slab.still {
            slab.torque[own as usize].0[..3].fill(0.0);
        }
    }
}
