//! The solver: it is told to advance by n steps, and is then read.

use crate::barrier::Barrier;
use crate::boundary::{Boundary, Loading};
use crate::companion::{Beside, Companion};
use crate::grains::Horizontal;
use crate::kernels::Kernels;
use crate::lanes::Row;
use crate::slab::{Loss, Slab};
use crate::sorted::{Lasting, Sorted, grains_of};
use crate::step::{Crew, Stage, Stop};
use crate::{Ledger, Model, State};
use glam::DVec3;
use std::sync::Mutex;
use std::sync::atomic::AtomicU64;

/// Grains in motion.
pub struct Solver {
    pub(crate) model: Model,
    pub(crate) kernels: Kernels,
    threads: usize,
    /// None: the caller's thread does all.
    pool: Option<rayon::ThreadPool>,
    /// Time of step zero [s].
    pub(crate) start: f64,
    pub(crate) sorted: Sorted,
    pub(crate) boundary: Boundary,
    driven_mass: f64,
    /// Forces and torques from outside in sorted order, while there are any.
    pub(crate) outside: Option<(Vec<Row>, Vec<Row>)>,
    /// Has a companion joined?
    pub(crate) joined: bool,
    skin: f64,
    searches: u64,
    /// Step of the last search.
    searched_at: u64,
    /// Losses booked before the last search.
    loss: Loss,
    /// Energies when the solver began.
    pub(crate) ledger_start: Ledger,
}

/// Why a solver was not made, or stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The description or the state cannot be right.
    #[error("{0}")]
    Invalid(String),
    /// What goes along with the grains cannot go on.
    #[error("{0}")]
    Companion(String),
    /// The device of a solver on the GPU fails.
    #[error(transparent)]
    Device(#[from] shaders::Error),
    /// The numbers ran away.
    #[error("step {step}: {what}")]
    Unstable {
        /// Steps made since the solver began.
        step: u64,
        /// What was seen, and the remedy.
        what: String,
    },
}

/// Forces and torques from outside, one for each grain in the order of identities.
///
/// Along directions that a constraint holds they are ignored.
#[derive(Clone, Copy, Debug)]
pub struct Outside<'a> {
    /// Force on each grain [N].
    pub force: &'a [DVec3],
    /// Torque on each grain [N m].
    pub torque: &'a [DVec3],
}

impl Outside<'_> {
    /// Refuse what is not one finite force and torque for each of `n` grains.
    pub(crate) fn check(&self, n: usize) -> Result<(), Error> {
        if self.force.len() != n || self.torque.len() != n {
            let (f, t) = (self.force.len(), self.torque.len());
            let what = format!("{f} outside forces and {t} torques for {n} grains");
            return Err(Error::Invalid(what));
        }
        let mut all = self.force.iter().chain(self.torque);
        if !all.all(|vector| vector.is_finite()) {
            let what = "outside forces and torques must be finite numbers";
            return Err(Error::Invalid(what.into()));
        }
        Ok(())
    }
}

/// First surplus of the neighbour search, in mean radii; adapted if the model leaves it open.
const SKIN: f64 = 0.02;
/// Bounds of the adapted skin, in mean radii.
const SKIN_RANGE: [f64; 2] = [0.005, 0.5];
/// Steps between searches that the adapted skin aims at: a search costs about as much as
/// ten steps, and near pairs that do not touch cost a few per cent of a step.
const SEARCH_EVERY: f64 = 1000.0;

impl Solver {
    /// Take over `state` under `model`, on `threads` threads (0: one for each core).
    ///
    /// The forces of the start are computed without advancing any spring. The same
    /// state gives the same bits whatever was before and whatever `threads` is.
    /// Whether the step is stable is for the caller to ask
    /// ([`stable_step`](crate::stability::stable_step)).
    ///
    /// # Errors
    /// [`Error::Invalid`] for a description or state that cannot be right.
    pub fn new(model: Model, mut state: State, threads: usize) -> Result<Self, Error> {
        crate::check::check(&model, &state)?;
        let cores = || std::thread::available_parallelism().map_or(1, |n| n.get());
        let threads = if threads == 0 { cores() } else { threads };
        let pool = match threads {
            1 => None,
            _ => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                Some(pool.map_err(|e| Error::Invalid(format!("no {threads} threads: {e}")))?)
            }
        };

        let drive_velocity = crate::start::constrain(&model, &mut state);
        let grains = grains_of(&state);
        let driven = |g: &&crate::sorted::Grain| g.constraint.horizontal == Horizontal::Driven;
        let driven_mass = grains.iter().filter(driven).map(|g| g.mass).sum();
        let walls = state.walls.clone();
        let boundary = Boundary {
            wall_force: vec![0.0; walls.len()],
            companion_force: vec![0.0; walls.len()],
            sums: crate::Sums {
                wall_force: vec![0.0; walls.len()],
                ..Default::default()
            },
            start: walls.iter().map(|wall| wall.offset).collect(),
            walls,
            drive_velocity,
            ..Default::default()
        };

        let mean_radius = state.grains.mean_radius();
        let skin = model.skin.unwrap_or(SKIN * mean_radius);
        let lasting: Vec<Lasting> = state.contacts.iter().map(Lasting::of).collect();
        let offsets: Vec<f64> = boundary.walls.iter().map(|w| w.offset).collect();
        let sorted = Sorted::new(&model, grains, &lasting, &offsets, skin, threads)?;
        let mut solver = Self {
            kernels: Kernels::choose(&model.law, model.ledger),
            model,
            threads,
            pool,
            start: state.time,
            sorted,
            boundary,
            driven_mass,
            outside: None,
            joined: false,
            skin,
            searches: 1,
            searched_at: 0,
            loss: Loss::default(),
            ledger_start: Ledger::default(),
        };
        solver.begin();
        Ok(solver)
    }

    /// Forces of the start, and velocities half a step back.
    fn begin(&mut self) {
        let mut slabs = std::mem::take(&mut self.sorted.slabs);
        let barrier = Barrier::new(1);
        let crew = self.crew(&barrier, &[]);
        for slab in &mut slabs {
            let walls = slab.walls.iter().map(|wall| wall.slots.clone());
            let (pairs, walls) = (slab.slots.clone(), walls.collect::<Vec<_>>());
            crew.push_own(slab, &self.boundary, 0.0, |_| {});
            // Measuring must not change what the contacts remember: a sliding one lies on its
            // limit, and half of them would stick by the change of velocities over half a step.
            let touching = Slab::touches(&slab.touching, slab.pair_count);
            slab.slots.take_springs(&pairs, touching);
            for (wall, given) in slab.walls.iter_mut().zip(&walls) {
                let touching = Slab::touches(&wall.touching, wall.count);
                wall.slots.take_springs(given, touching);
            }
            // Nothing has been lost yet.
            slab.force.iter_mut().for_each(|row| row.0[3] = 0.0);
            slab.torque.iter_mut().for_each(|row| row.0[3] = 0.0);
            slab.rolling_loss.fill(0.0);
            slab.regroup();
        }
        self.sorted.slabs = slabs;
        let gauges = &mut self.sorted.gauges;
        self.boundary.begin(&gauges.ranges, gauges.values.get_mut());

        let loading = self.loading();
        let half = 0.5 * self.model.step;
        let walls: Vec<f64> = (0..self.boundary.walls.len())
            .map(|k| loading.wall_acceleration(&self.boundary, k))
            .collect();
        let drive = loading.drive_acceleration(&self.boundary);
        for (wall, acceleration) in self.boundary.walls.iter_mut().zip(walls) {
            wall.velocity -= half * acceleration;
        }
        self.boundary.drive_velocity -= half * drive;
        let sorted = &mut self.sorted;
        let velocity = sorted.rows.velocity.get_mut();
        let spin = sorted.rows.spin.get_mut();
        for slab in &sorted.slabs {
            for (own, k) in slab.own.clone().enumerate() {
                let back = 0.5 * sorted.kick[k] * slab.force[own].xyz();
                velocity[k] = Row::new(velocity[k].xyz() - back, 0.0);
                if !spin.is_empty() {
                    let back = 0.5 * sorted.twist[k] * slab.torque[own].xyz();
                    spin[k] = Row::new(spin[k].xyz() - back, spin[k].w());
                }
            }
        }
        self.ledger_start = self.energies();
    }

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// [`Error::Unstable`] when the numbers run away.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        self.change_outside(None);
        self.walk_alone(steps)
    }

    /// Advance by `steps` time steps under constant `outside` forces.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance), and [`Error::Invalid`] for forces that are not
    /// one for each grain, or no numbers.
    pub fn advance_with(&mut self, steps: u64, outside: Outside) -> Result<(), Error> {
        let outside = self.sort_outside(outside)?;
        self.change_outside(Some(outside));
        self.walk_alone(steps)
    }

    /// Outside forces change at this instant, half a step ahead of the velocities: the half
    /// step until now belongs to the old ones, the whole kick to come is made by the new ones.
    pub(crate) fn change_outside(&mut self, new: Option<(Vec<Row>, Vec<Row>)>) {
        let old = std::mem::replace(&mut self.outside, new);
        if old.is_none() && self.outside.is_none() {
            return;
        }
        let sorted = &mut self.sorted;
        let velocity = sorted.rows.velocity.get_mut();
        let spin = sorted.rows.spin.get_mut();
        for k in 0..sorted.id.len() {
            let acting = |outside: &Option<(Vec<Row>, Vec<Row>)>| {
                let rows = outside.as_ref();
                rows.map_or((DVec3::ZERO, DVec3::ZERO), |(f, t)| {
                    (f[k].xyz(), t[k].xyz())
                })
            };
            let (before, after) = (acting(&old), acting(&self.outside));
            let kick = 0.5 * sorted.kick[k] * (before.0 - after.0);
            velocity[k] = Row::new(velocity[k].xyz() + kick, velocity[k].w());
            if !sorted.twist.is_empty() {
                let twist = 0.5 * sorted.twist[k] * (before.1 - after.1);
                spin[k] = Row::new(spin[k].xyz() + twist, spin[k].w());
            }
        }
    }

    fn walk_alone(&mut self, steps: u64) -> Result<(), Error> {
        if self.joined {
            let what = "this solver has a companion: advance them together, or begin anew";
            return Err(Error::Invalid(what.into()));
        }
        self.walk(steps, &mut ())
    }

    pub(crate) fn walk<C: Companion>(
        &mut self,
        steps: u64,
        companion: &mut C,
    ) -> Result<(), Error> {
        let until = self.boundary.sums.steps + steps;
        let mut stage = Stage::Begun;
        while self.boundary.sums.steps < until {
            match self.dispatch(until, stage, companion) {
                Stop::Done => {}
                Stop::Search { speed } => {
                    self.search(speed)?;
                    if C::ACTIVE {
                        self.sorted.rows.leave();
                    }
                    companion
                        .arrange(&self.bed_after(1))
                        .map_err(Error::Companion)?;
                    stage = Stage::Moved;
                }
                Stop::Due => {
                    companion
                        .settle(&self.bed_after(1))
                        .map_err(Error::Companion)?;
                    stage = Stage::Moved;
                }
            }
        }
        Ok(())
    }

    /// Let the threads walk.
    fn dispatch<C: Companion>(&mut self, until: u64, stage: Stage, companion: &mut C) -> Stop {
        let companion = Beside::new(companion);
        let slabs: Vec<Mutex<Slab>> = self.sorted.slabs.drain(..).map(Mutex::new).collect();
        let barrier = Barrier::new(self.threads);
        let speeds: Vec<AtomicU64> = (0..self.threads).map(|_| AtomicU64::new(0)).collect();
        let crew = self.crew(&barrier, &speeds);
        let walk = |thread: usize| {
            let mut slab = slabs[thread]
                .lock()
                .expect("each thread locks only its own slab");
            let boundary = self.boundary.clone();
            crew.walk(thread, &mut slab, boundary, until, stage, &companion)
        };
        let (boundary, stop) = match &self.pool {
            None => walk(0),
            Some(pool) => {
                let copies = pool.broadcast(|context| walk(context.index()));
                copies.into_iter().next().expect("a pool has a thread")
            }
        };
        let unlock = |slab: Mutex<Slab>| slab.into_inner().expect("no thread panicked");
        self.sorted.slabs = slabs.into_iter().map(unlock).collect();
        self.boundary = boundary;
        stop
    }

    fn crew<'a>(&'a self, barrier: &'a Barrier, speeds: &'a [AtomicU64]) -> Crew<'a> {
        Crew {
            kernels: self.kernels,
            loading: self.loading(),
            rows: &self.sorted.rows,
            gauges: &self.sorted.gauges,
            kick: &self.sorted.kick,
            twist: &self.sorted.twist,
            mass: &self.sorted.mass,
            outside: self.outside.as_ref().map(|(f, t)| (&f[..], &t[..])),
            barrier,
            speeds,
            reach: 0.5 * self.skin,
        }
    }

    pub(crate) fn loading(&self) -> Loading<'_> {
        Loading {
            model: &self.model,
            start: self.start,
            driven_mass: self.driven_mass,
        }
    }

    /// Sort the grains anew and find their near pairs.
    fn search(&mut self, speed: f64) -> Result<(), Error> {
        let steps = self.boundary.sums.steps;
        let way = speed * self.model.step;
        let smallest = self.smallest_radius();
        if way.is_nan() || way >= 0.5 * smallest {
            let what = format!(
                "a grain or wall moves by {way:.3e} m in one step, more than half the smallest \
                 radius {smallest:.3e} m; the time step {:.3e} s is too long for this motion",
                self.model.step
            );
            return Err(Error::Unstable { step: steps, what });
        }
        if self.model.skin.is_none() {
            let since = (steps - self.searched_at).max(1) as f64;
            let mean_radius = self.mean_radius();
            let skin = self.skin * (SEARCH_EVERY / since).clamp(0.5, 2.0);
            self.skin = skin.clamp(SKIN_RANGE[0] * mean_radius, SKIN_RANGE[1] * mean_radius);
        }
        self.loss = self.losses();
        let outside = self.outside.take().map(|rows| self.by_identity(&rows));
        let mut lasting = self.sorted.lasting();
        // An order that does not depend on slabs.
        lasting.sort_unstable_by_key(|contact| (contact.a, contact.b));
        let grains = self.sorted.grains();
        if let Some(grain) = grains.iter().find(|grain| !grain.position.is_finite()) {
            let what = format!("grain {} is nowhere; the time step is too long", grain.id);
            return Err(Error::Unstable { step: steps, what });
        }
        let offsets: Vec<f64> = self.boundary.walls.iter().map(|w| w.offset).collect();
        self.sorted = Sorted::new(
            &self.model,
            grains,
            &lasting,
            &offsets,
            self.skin,
            self.threads,
        )?;
        if self.model.ledger {
            for kept in &self.sorted.parted {
                let [sliding, rolling] = kept.energies(&self.model.law);
                self.loss.friction += sliding;
                self.loss.rolling += rolling;
            }
        }
        self.outside = outside.map(|(force, torque)| self.sorted_rows(&force, &torque));
        self.boundary.travel = 0.0;
        self.searches += 1;
        self.searched_at = steps;
        Ok(())
    }

    fn radii(&self) -> impl Iterator<Item = f64> {
        // SAFETY: the solver is not stepping, so nobody writes.
        let rows = unsafe { self.sorted.rows.position.read() };
        rows[..self.sorted.id.len()].iter().map(|row| row.w())
    }

    fn smallest_radius(&self) -> f64 {
        self.radii().fold(f64::INFINITY, f64::min)
    }

    fn mean_radius(&self) -> f64 {
        self.radii().sum::<f64>() / self.sorted.id.len().max(1) as f64
    }

    fn sort_outside(&self, outside: Outside) -> Result<(Vec<Row>, Vec<Row>), Error> {
        outside.check(self.sorted.id.len())?;
        Ok(self.sorted_rows(outside.force, outside.torque))
    }

    fn sorted_rows(&self, force: &[DVec3], torque: &[DVec3]) -> (Vec<Row>, Vec<Row>) {
        let grains = self.sorted.id.iter().zip(&self.sorted.constraint);
        let rows = grains.map(|(&id, constraint)| {
            let free = match constraint.horizontal {
                Horizontal::Free => DVec3::ONE,
                Horizontal::Held | Horizontal::Driven => DVec3::Z,
            };
            let turns = if constraint.rotation_held { 0.0 } else { 1.0 };
            let force = Row::new(free * force[id as usize], 0.0);
            (force, Row::new(turns * torque[id as usize], 0.0))
        });
        rows.unzip()
    }

    fn by_identity(&self, rows: &(Vec<Row>, Vec<Row>)) -> (Vec<DVec3>, Vec<DVec3>) {
        let n = self.sorted.id.len();
        let (mut force, mut torque) = (vec![DVec3::ZERO; n], vec![DVec3::ZERO; n]);
        for (k, &id) in self.sorted.id.iter().enumerate() {
            force[id as usize] = rows.0[k].xyz();
            torque[id as usize] = rows.1[k].xyz();
        }
        (force, torque)
    }

    /// Losses since the solver began, summed in the order of the blocks.
    pub(crate) fn losses(&self) -> Loss {
        let blocks = self.sorted.slabs.iter().flat_map(|slab| &slab.losses);
        blocks.fold(self.loss, |sum, block| Loss {
            friction: sum.friction + block.friction,
            viscosity: sum.viscosity + block.viscosity,
            rolling: sum.rolling + block.rolling,
            outside: sum.outside + block.outside,
            companion: sum.companion + block.companion,
        })
    }

    /// The description it was made with.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Number of neighbour searches so far.
    pub fn searches(&self) -> u64 {
        self.searches
    }

    /// Number of near pairs that each step looks at.
    pub fn near_pairs(&self) -> usize {
        self.sorted.pair_count
    }

    /// Memory in use [bytes].
    pub fn memory(&self) -> usize {
        self.sorted.bytes() + self.sorted.gauges.ranges.last().map_or(0, |r| 8 * r.end)
    }

    /// The vector instructions in use.
    pub fn vectors(&self) -> &'static str {
        self.kernels.vectors
    }
}
