//! Where the energy of the water is, and where it went.
//!
//! Water gains what grains and walls do to it, and what comes through open sides; it loses by
//! Darcy's law, and grains that are loose lose to it by their drag:
//!
//! > E - E₀ = W_grains + W_walls + W_sides - D_darcy - D_loose - residual,
//!
//! Works of grains and walls are forces before and after a drift times half of it, and the loss of
//! loose grains is the power of the forces that drag them. Darcy's loss is what the water's own
//! steps take of E = ½ Σ β V_p p² and of the work at the sides, with what the lattice adds to
//! R q²: 3 % for a bed of four cells that drains, more where pressure varies from cell to cell.
//! The residual is then what the exchange between grains and cells loses or invents; it is a
//! hundred-thousandth of the works of a load, and 3e-4 of them in shear.
//!
//! Works are those of p, the deviation from hydrostatic; buoyancy works on the grains too, and is
//! a potential. Nothing is summed where the grains keep no ledger,
//! nor yet in open pores, whose water has kinetic energy too.

use crate::Water;
use crate::faces::drags;
use dem::{Bed, Moved, Shared, Threads};
use lbm::Side;

/// Energy and volume of the water. The first four are of this instant, works and losses sums since
/// the water joined the grains: no numbers where these keep no ledger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger {
    /// Energy of compressed water, ½ Σ β V_p p², and of the room that vapour has opened [J].
    pub elastic: f64,
    /// Water beyond that at rest, with what has been collected since the last fluid step [m³].
    pub content: f64,
    /// Vapour [m³].
    pub vapour: f64,
    /// Volume between the walls less that of all grains, at the last renewal [m³].
    pub pores: f64,
    /// Work of the grains on the water [J], without that of buoyancy.
    pub work_grains: f64,
    /// Work of the walls on the water [J].
    pub work_walls: f64,
    /// Work of what presses water in through open sides, less that against which it leaves [J].
    pub work_sides: f64,
    /// Lost in the flow of water through the bed [J].
    pub dissipated_darcy: f64,
    /// Lost in the drag of loose grains [J].
    pub dissipated_loose: f64,
    /// Work that arrived and is not found [J]: work - change of energy - dissipation.
    pub residual: f64,
}

/// Sums over time.
pub(crate) struct Books {
    /// Does anyone ask for them?
    pub kept: bool,
    /// Energy and potential of buoyancy when the water joined [J].
    start: [f64; 2],
    walls: Shared<WallWork>,
    sides: f64,
    darcy: f64,
    /// What had been collected before the last step before a fluid step [m³].
    collected: Shared<f64>,
    /// Of the loose grains in orders that are gone.
    loose: f64,
}

/// Work of the walls until the forces of the last step, and velocities before these [m/s].
#[derive(Clone, Copy, Default)]
struct WallWork {
    work: f64,
    before: [f64; 2],
}

impl Books {
    pub fn new(kept: bool, cells: usize) -> Self {
        Self {
            kept,
            start: [0.0; 2],
            walls: Shared::new(vec![WallWork::default()]),
            sides: 0.0,
            darcy: 0.0,
            collected: Shared::new(vec![0.0; if kept { cells } else { 0 }]),
            loose: 0.0,
        }
    }
}

impl<const N: usize> Water<N> {
    /// The water joins now.
    pub(crate) fn open_books(&mut self, bed: &Bed) {
        self.books.start = [self.elastic(|_| 0.0), self.lift_potential(bed)];
    }

    /// The work of the walls with the forces before this drift, and after the last one.
    pub(crate) fn book_walls(&self, moved: &Moved, threads: &Threads) {
        for _ in threads.share(1) {
            // SAFETY: one thread alone has a share of one.
            let books = unsafe { &mut self.books.walls.write(0..1)[0] };
            let now = self.walls.map(|wall| moved.walls[wall].velocity);
            for side in 0..2 {
                let way = 0.5 * self.step * (books.before[side] + now[side]);
                books.work += self.pass().on_wall(side) * way;
            }
            books.before = now;
        }
    }

    /// The order of the grains is about to change: take what each has lost.
    pub(crate) fn book_loose(&mut self) {
        self.books.loose += self.step * self.fields.lost.get_mut().iter().sum::<f64>();
    }

    /// Energy of the water [J] when what has been collected has gone; of vapour the work that has
    /// opened it.
    pub(crate) fn elastic(&self, collected: impl Fn(usize) -> f64) -> f64 {
        let each = (0..self.lattice.count()).map(|cell| {
            let gone = collected(cell);
            let (pressure, storage) = (self.pressure_of(cell, gone), self.storage[cell]);
            let whole = 0.5 * storage * pressure * pressure;
            if self.least[cell].is_infinite() {
                return whole;
            }
            let water = self.content[cell] - self.vapour[cell] - gone;
            // Beyond what the least pressure stretches.
            let open = (storage * self.least[cell] - water).max(0.0);
            whole - self.least[cell] * open
        });
        each.sum()
    }

    /// A drift is about to be collected. Half of the work of one before a fluid step is done with
    /// the pressure which that leaves, not with that which was predicted.
    pub(crate) fn mark_collected(&self, step: u64, threads: &Threads) {
        if !self.books.kept || !self.drains(step) {
            return;
        }
        for plane in threads.share(self.lattice.cells[0]) {
            let range = self.lattice.cells_of(plane);
            // SAFETY: each plane is one thread's.
            unsafe {
                let now = &self.fields.collected.read()[range.clone()];
                self.books.collected.write(range).copy_from_slice(now);
            }
        }
    }

    /// What a fluid step begins with: energy [J], and the volume that the last drift has brought to
    /// each cell [m³].
    pub(crate) fn before_fluid_step(&mut self) -> f64 {
        // SAFETY: there is one thread.
        let gone = unsafe { self.fields.collected.read() };
        let marked = self.books.collected.get_mut();
        for (marked, gone) in marked.iter_mut().zip(gone) {
            *marked = gone - *marked;
        }
        self.elastic(|cell| gone[cell]) + self.half_of_last(|cell| gone[cell])
    }

    /// A fluid step is made, before which there was this energy [J], and through bottom and top so
    /// much has left [m³].
    pub(crate) fn book_fluid_step(&mut self, energy: f64, left: [f64; 2], passed: f64) {
        let work = self.work_of_sides(left, passed);
        let now = self.elastic(|_| 0.0) + self.half_of_last(|_| 0.0);
        self.books.sides += work;
        self.books.darcy += energy + work - now;
    }

    /// Half of the work on the last volume that was collected, with the pressure now.
    fn half_of_last(&self, gone: impl Fn(usize) -> f64) -> f64 {
        // SAFETY: there is one thread.
        let last = unsafe { self.books.collected.read() };
        let each = last.iter().enumerate();
        each.map(|(cell, last)| 0.5 * last * self.pressure_of(cell, gone(cell)))
            .sum()
    }

    /// Work on what has come in through the sides, less what has `left` through them [m³], in the
    /// time that has `passed` [s].
    fn work_of_sides(&self, left: [f64; 2], passed: f64) -> f64 {
        let nz = self.lattice.cells[2];
        let time = self.flow.time() - 0.5 * passed;
        let work = |end: usize| match &self.model.sides[end] {
            Side::Pressure(signal) => -left[end] * signal.at(time),
            Side::Flux(signal) => {
                // The pressure which that flux needs.
                let layer = (0..self.lattice.count())
                    .filter(|cell| cell % nz == end * (nz - 1))
                    .map(|cell| {
                        let porosity = 1.0 - self.solid[cell] / self.lattice.volume();
                        let half = 0.5 * self.lattice.height * self.resistance(porosity, [0.0; 3]);
                        self.pressure_of(cell, 0.0) + half * signal.at(time)
                    });
                let columns = self.lattice.count() / nz;
                -left[end] * layer.sum::<f64>() / columns as f64
            }
            Side::FreeSlip | Side::NoSlip(_) => 0.0,
        };
        work(0) + work(1)
    }

    /// Potential energy of the displaced water [J], as lift works on the grains.
    fn lift_potential(&self, bed: &Bed) -> f64 {
        let each = self.lift.iter().zip(bed.position);
        each.map(|(lift, at)| -lift * at.xyz().z).sum()
    }
}

impl Ledger {
    pub(crate) fn of<const N: usize>(water: &Water<N>, grains: &dem::Solver) -> Self {
        let now = water.snapshot();
        let bed = grains.bed();
        let books = &water.books;
        let sum = |value: f64| if books.kept { value } else { f64::NAN };
        // SAFETY: a shared borrow between steps: nobody writes.
        let (collected, walls, lost, given) = unsafe {
            (
                water.fields.collected.read(),
                books.walls.read()[0],
                water.fields.lost.read(),
                water.fields.given.read(),
            )
        };
        let elastic = water.elastic(|cell| collected[cell]);
        let last: f64 = (0..2)
            .map(|side| water.pass().on_wall(side) * walls.before[side])
            .sum();
        let lift = books.start[1] - water.lift_potential(&bed);
        let work_grains = sum(lift - grains.work_of_companion());
        let work_walls = sum(walls.work + 0.5 * water.step * last);
        let work_sides = sum(books.sides);
        let lost: f64 = lost.iter().sum();
        // Where the drag was the last that happened, the other half of its work is to come.
        let given: f64 = given.iter().map(|[sum, last]| sum + last).sum();
        let dissipated_loose = sum(books.loose + water.step * (lost - 0.5 * given));
        let dissipated_darcy = sum(books.darcy);
        let work = work_grains + work_walls + work_sides;
        Self {
            elastic,
            content: now.content,
            vapour: now.vapour.iter().sum(),
            pores: now.porosity.iter().sum::<f64>() * water.lattice.volume(),
            work_grains,
            work_walls,
            work_sides,
            dissipated_darcy,
            dissipated_loose,
            residual: work - dissipated_darcy - dissipated_loose - (elastic - books.start[0]),
        }
    }
}

/// Power of the faces' reactions at this step's velocities, kept for the half step after the drag
/// too: `sum` and `last` of a plane.
pub(crate) fn book_given(books: &mut [f64; 2], step: u64, power: impl FnOnce() -> f64) {
    if drags(step) {
        let power = power();
        *books = [books[0] + power, power];
    } else if drags(step - 1) {
        *books = [books[0] + power(), 0.0];
    }
}
