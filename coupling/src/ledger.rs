//! Where the energy of the water is, and where it went.
//!
//! Water gains what grains and walls do to it, and what comes through open sides; it loses by
//! Darcy's law, and grains that are loose lose to it by their drag:
//!
//! > E - E₀ = W_grains + W_walls + W_sides - D_darcy - D_loose - residual,
//!
//! Works of grains and walls are forces before and after a drift times half of it, and so is what
//! cells get of them, -p dV. The loss of loose grains is the work of the forces that drag them and of
//! the reactions. Darcy's loss is what cells get, with the work at the sides, less what
//! they keep in E = ½ Σ β V_p p²; in it is what the lattice adds to R q², 3 % for a bed of four cells that
//! drains, more where pressure varies from cell to cell, and what it costs or gives that pressure is
//! held between exchanges (`trend.rs`). The residual is then what the exchange between
//! grains and cells loses or invents, and what a renewal of the pores does to pressure.
//!
//! In open pores the water has kinetic energy too, and `open/books.rs` tells what drag and its own
//! shear take; there the residual is that forces on grains act half a step late.
//!
//! Works are those of p, the deviation from hydrostatic; buoyancy works on the grains too, and is
//! a potential. Nothing is summed where the grains keep no ledger.

use crate::Water;
use crate::water::Pending;
use dem::{Bed, Moved, Shared, Threads};
use lbm::Side;

/// Energy and volume of the water. The first five are of this instant, works and losses sums since
/// the water joined the grains: no numbers where these keep no ledger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger {
    /// Energy of compressed water, ½ Σ β V_p p², and of the room that vapour has opened [J].
    pub elastic: f64,
    /// Kinetic energy of the water [J]; none where drag holds it.
    pub kinetic: f64,
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
    /// Lost in the flow of water through the bed, by its own shear too [J].
    pub dissipated_darcy: f64,
    /// Lost to the method in open pores, whose pressure is implicit in time [J].
    pub dissipated_method: f64,
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
    /// What renewals have made of the energy [J].
    renewed: f64,
    /// Lost on a lattice before the pores opened [J].
    darcy: f64,
    /// Of the loose grains in orders that are gone.
    loose: f64,
}

/// Work of the walls until the last exchange, but for their ways in half of the step before it [m].
#[derive(Clone, Copy, Default)]
struct WallWork {
    work: f64,
    half: [f64; 2],
}

impl Books {
    pub fn new(kept: bool) -> Self {
        Self {
            kept,
            start: [0.0; 2],
            walls: Shared::new(vec![WallWork::default()]),
            sides: 0.0,
            renewed: 0.0,
            darcy: 0.0,
            loose: 0.0,
        }
    }
}

impl<const N: usize> Water<N> {
    /// The water joins now.
    pub(crate) fn open_books(&mut self, bed: &Bed) {
        self.books.start = [self.elastic(|_| 0.0), self.lift_potential(bed)];
        if self.books.kept {
            self.fields.brought = Shared::new(vec![0.0; self.lattice.count()]);
        }
    }

    /// Book the work of the walls since the last exchange, but for half of the last step.
    pub(crate) fn book_walls(&self, moved: &Moved, threads: &Threads) {
        if !self.books.kept {
            return;
        }
        for _ in threads.share(1) {
            // SAFETY: one thread alone has a share of one.
            let books = unsafe { &mut self.books.walls.write(0..1)[0] };
            for side in 0..2 {
                let wall = self.walls[side];
                let half = 0.5 * self.step * moved.walls[wall].velocity;
                let way = books.half[side] + moved.wall_ways[wall] - half;
                books.work += self.pass().on_wall(side) * way;
                books.half[side] = half;
            }
        }
    }

    /// The order of the grains is about to change: take what each has lost.
    pub(crate) fn book_loose(&mut self) {
        self.books.loose += self.fields.lost.get_mut().iter().sum::<f64>();
    }

    /// A renewal has made of this energy [J] what it is now.
    pub(crate) fn book_renewal(&mut self, before: f64) {
        self.books.renewed += self.energy() - before;
    }

    /// What Darcy's law has taken on the lattice [J], with what is pending: what cells have got, less
    /// what they keep.
    fn lost_on_lattice(&self, pending: &Pending) -> f64 {
        // SAFETY: a shared borrow between steps: nobody writes.
        let (planes, collected, pressure, brought) = unsafe {
            (
                self.fields.books.read(),
                self.fields.collected.read(),
                self.fields.pressure.read(),
                self.fields.brought.read(),
            )
        };
        let cells: f64 = brought
            .iter()
            .zip(pressure)
            .zip(&pending.volume)
            .map(|((half, pressure), volume)| -pressure * (0.5 * half + volume))
            .sum();
        let cells = cells + planes.iter().map(|plane| plane.cells).sum::<f64>();
        let elastic = self.elastic(|cell| collected[cell] + pending.volume[cell]);
        cells + self.books.sides + self.books.renewed - (elastic - self.books.start[0])
    }

    /// The pores open: no lattice takes anything from now on.
    pub(crate) fn close_lattice_books(&mut self) {
        // Not where the water only joins.
        if !self.fields.brought.get_mut().is_empty() {
            self.books.darcy = self.lost_on_lattice(&Pending::nothing(self));
        }
    }

    /// Energy of the water now [J].
    pub(crate) fn energy(&self) -> f64 {
        // SAFETY: there is one thread.
        let collected = unsafe { self.fields.collected.read() };
        self.elastic(|cell| collected[cell])
    }

    /// Book the work at the sides, through which so much has left [m³] in a time [s].
    pub(crate) fn book_sides(&mut self, left: [f64; 2], passed: f64) {
        self.books.sides += self.work_of_sides(left, passed);
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
        let pending = Pending::of(water, grains);
        let now = water.snapshot_after(&pending);
        let bed = grains.bed();
        let books = &water.books;
        let sum = |value: f64| if books.kept { value } else { f64::NAN };
        let pass = water.pass();
        // SAFETY: a shared borrow between steps: nobody writes.
        let (fields, collected, walls) = unsafe {
            (
                &water.fields,
                water.fields.collected.read(),
                books.walls.read()[0],
            )
        };
        let elastic = water.elastic(|cell| collected[cell] + pending.volume[cell]);
        let last: f64 = (0..2)
            .map(|side| {
                let way = walls.half[side] + pending.wall_ways[water.walls[side]];
                pass.on_wall(side) * way
            })
            .sum();
        let lift = books.start[1] - water.lift_potential(&bed);
        let work_grains = sum(lift - grains.work_of_companion());
        let work_walls = sum(walls.work + last);
        let open = water.flow.books();
        let work_sides = sum(books.sides + open.sides);
        // SAFETY: as above.
        let (planes, lost, dragged) = unsafe {
            (
                fields.books.read(),
                fields.lost.read(),
                fields.dragged.read(),
            )
        };
        let mut loose = books.loose + lost.iter().sum::<f64>()
            - planes.iter().map(|plane| plane.given).sum::<f64>();
        if fields.dragged_at.was_at(bed.step - pending.steps) {
            let drawn = dragged.iter().zip(&pending.ways);
            loose -= drawn
                .map(|(drag, way)| drag.xyz().dot(way.xyz()))
                .sum::<f64>();
            let power = pass.power_given(0..water.lattice.count(), Some(&pending.velocity));
            loose -= water.step * pending.steps as f64 * power;
        }
        let kinetic = water.flow.kinetic(&water.lattice);
        let change = elastic - books.start[0] + kinetic - open.brought;
        let dissipated_darcy = sum(match water.is_open() {
            true => books.darcy + open.drag + open.shear,
            false => water.lost_on_lattice(&pending),
        });
        let dissipated_method = sum(open.method);
        let dissipated_loose = sum(loose);
        let work = work_grains + work_walls + work_sides;
        Self {
            elastic,
            kinetic,
            content: now.content,
            vapour: now.vapour.iter().sum(),
            pores: now.porosity.iter().sum::<f64>() * water.lattice.volume(),
            work_grains,
            work_walls,
            work_sides,
            dissipated_darcy,
            dissipated_method,
            dissipated_loose,
            residual: work - dissipated_darcy - dissipated_method - dissipated_loose - change,
        }
    }
}
