//! Faces and cells: mean velocities, the volume they bring, pressure, and what pushes back.
//!
//! Every face has a mean velocity of the solid, v_f = Σ a_if v_i and a share of the walls' (the
//! images of grains beside them). The faces at the walls move with these. A cell gets
//! Q = Σ v_f A_f from its six faces, and a pressure difference G_f = A_f (p_right - p_left) pushes
//! a face's grains by -a_if G_f and the walls by their share.
//!
//! Velocities are means since the last exchange, ways over the time that they took.
//!
//! Loose grains: every few steps they are dragged towards the mean, each by s_f γ_i K_if (v_f - v_i)
//! at each of its faces, and the face's grains get what is lost, R_f = Σ s_f γ_i K_if (v_i - v_f).
//! γ_i = (1 - w_i) m ν T/dt is the drag of the T between two drags at once, or the part of it that
//! `load.rs` allows, spread over the steps until the next exchange. The velocity between
//! the two crowds falls by the rate ν + Σ γ K/m_f, m_f = ρ Σ w V K, times T: by r, were it not
//! for s_f = 1/max(1 + r/2, r). So the mean over T of the velocity that a steady force keeps up is
//! that of drag in every step, up to r = 2, and nothing overshoots beyond: the quadratic form of
//! the drag, with |v_f|² ≤ Σ a_if v_i², is at most s_f r of the kinetic energy's. Where exchanges are some steps
//! apart, drag is spread over these by velocities that are means of those before: a = s_f r/2 then falls
//! short of it, and the velocity between the crowds goes as zⁿ with z² - (1 - a) z + a = 0, |z|² ≤ 1/2. In a virgin bed
//! of k_n = 1e9 N/m too weak a drag shows: pressure at T = 0.4 was 13.6 % low with implicit drag,
//! 1/(1 + r), every 8 steps, 10.8 % with this one every 4, 10 % with drag in every step.

use crate::books::{Dragged, PlaneBooks};
use crate::exchange::Exchange;
use crate::gather::{Drawn, Given};
use crate::kernel::half_width;
use crate::kernels::{Kernels, Scatter};
use crate::lattice::Lattice;
use crate::nodes::{Plane, Scratch};
use crate::open::End;
use crate::terms::{Moments, SHEETS, Sheets, TERMS};
use crate::trend::Trend;
use dem::{Moved, Row, Shared, Threads};
use std::ops::Range;

/// Steps between two drags of loose grains, where exchanges are not farther apart.
pub(crate) const DRAG_EVERY: u64 = 4;

/// What faces weigh, until the next renewal. One row a node, for its lower faces along x, y, z.
#[derive(Default)]
pub(crate) struct Frozen {
    /// 1/Σ w V K; zero where there is no grain.
    pub inverse: Vec<Row>,
    /// s_f, and s_f Σ γ K.
    pub ease: Vec<Row>,
    pub loose: Vec<Row>,
    /// Shares of the bottom and the top wall in faces of normal z; empty where images of grains
    /// reach no face.
    pub walls: Vec<[f64; 2]>,
}

/// What changes at every exchange.
pub(crate) struct Fields {
    /// Σ w V B and Σ γ B times the ways over the grains of each cell, one entry a group.
    pub moments: Shared<Moments>,
    pub loose: Shared<Moments>,
    /// Mean velocity since the last exchange [m/s] of the lower faces of each cell.
    pub velocity: Shared<Row>,
    /// R_f [N].
    pub reaction: Shared<Row>,
    /// What cells read of that with which faces push per w V K, and of s_f v_f; one entry a group.
    pub push: Shared<Sheets>,
    pub mean: Shared<Sheets>,
    /// Of the work on planes.
    numbers: Shared<f64>,
    lines: Shared<Row>,
    /// What the water keeps of the push at the faces [N]; empty where it keeps nothing.
    pub kept: Vec<Row>,
    /// Half cells at the ends of columns through which water flows; empty as well.
    pub ends: Vec<[End; 2]>,
    /// ∫Q dt since the last fluid step [m³], one entry a cell.
    pub collected: Shared<f64>,
    /// Pressure that grains feel until the next exchange [Pa], and how it went.
    pub pressure: Shared<f64>,
    pub trends: Shared<Trend>,
    /// Force on the bottom and the top wall, away from the grains [N], one entry a plane.
    pub on_walls: Shared<[f64; 2]>,
    /// What the ledger needs (`ledger.rs`), empty where there is none: drag on each grain [N] and what
    /// it has lost by it [J], in the present order; what cells collect in a step [m³]; sums of planes.
    pub dragged: Shared<Row>,
    pub lost: Shared<f64>,
    pub brought: Shared<f64>,
    pub books: Shared<PlaneBooks>,
    pub dragged_at: Dragged,
}

impl Fields {
    pub fn new<const N: usize>(lattice: &Lattice) -> Self {
        let planes = lattice.cells[0];
        let groups = planes * lattice.groups();
        let rows = |count| Shared::new(vec![Row::ZERO; count]);
        let numbers = |count| Shared::new(vec![0.0; count]);
        let moments = || Shared::new(vec![[Row::ZERO; TERMS]; groups]);
        let sheets = || Shared::new(vec![[Row::ZERO; SHEETS]; groups]);
        let count = lattice.count();
        let plane = Plane::<N> {
            lattice: *lattice,
            plane: 0,
        };
        let [scratch, lines] = plane.needs();
        Self {
            moments: moments(),
            loose: moments(),
            velocity: rows(count),
            reaction: rows(count),
            push: sheets(),
            mean: sheets(),
            numbers: numbers(planes * scratch),
            lines: rows(planes * lines),
            kept: Vec::new(),
            ends: Vec::new(),
            collected: numbers(count),
            pressure: numbers(count),
            trends: Shared::new(vec![Trend::default(); count]),
            on_walls: Shared::new(vec![[0.0; 2]; planes]),
            dragged: rows(0),
            lost: numbers(0),
            brought: numbers(0),
            books: Shared::new(vec![PlaneBooks::default(); planes]),
            dragged_at: Dragged::default(),
        }
    }
}

/// All that the threads share in one step.
pub(crate) struct Pass<'a, const N: usize> {
    pub lattice: &'a Lattice,
    pub kernels: &'a Kernels<N>,
    pub exchange: &'a Exchange,
    pub frozen: &'a Frozen,
    pub fields: &'a Fields,
    /// Indices of the bottom and the top wall.
    pub walls: [usize; 2],
    /// Grain step [s].
    pub step: f64,
    /// Part of a drag that each of the steps until the next exchange takes, if there is one.
    pub share: Option<f64>,
}

impl<const N: usize> Pass<'_, N> {
    /// Mean velocities of all faces.
    pub fn follow(&self, moved: &Moved, threads: &Threads) {
        let (exchange, fields) = (self.exchange, self.fields);
        assert!(
            moved.way.len() >= exchange.count,
            "grains came without notice"
        );
        let groups = exchange.share(threads);
        let scatter = self.kernels.scatter;
        // SAFETY: each group is one thread's until they meet; there are ways of all grains.
        unsafe {
            let moments = fields.moments.write(groups.clone());
            scatter(
                exchange,
                groups.clone(),
                &exchange.counts,
                moved.way,
                moments,
            );
            if self.share.is_some() {
                let moments = fields.loose.write(groups.clone());
                scatter(exchange, groups, &exchange.drag, moved.way, moments);
            }
        }
        threads.meet();
        let (rate, walls) = (self.rate(moved), self.wall_velocities(moved));
        for plane in threads.share(self.lattice.cells[0]) {
            let range = self.lattice.cells_of(plane);
            // SAFETY: each plane is one thread's; moments are read between two meetings.
            unsafe {
                let velocity = fields.velocity.write(range);
                self.take(plane, fields.moments.read(), velocity);
                self.mean_velocities(plane, rate, walls, velocity);
            }
            self.book_given(plane, moved);
            if let Some(share) = self.share {
                self.reactions(plane, rate, share);
            }
        }
        threads.meet();
    }

    /// What makes velocities of ways [1/s].
    pub fn rate(&self, moved: &Moved) -> f64 {
        1.0 / (self.step * moved.passed[0] as f64)
    }

    /// Mean velocities of the bottom and the top wall along z since the last exchange.
    pub fn wall_velocities(&self, moved: &Moved) -> [f64; 2] {
        let rate = self.rate(moved);
        let [bottom, top] = self.walls.map(|k| rate * moved.wall_ways[k]);
        [bottom, -top]
    }

    pub fn plane(&self, plane: usize) -> Plane<N> {
        Plane {
            lattice: *self.lattice,
            plane,
        }
    }

    /// What the work on a plane needs.
    ///
    /// # Safety
    /// Nobody else works on the plane.
    pub unsafe fn scratch(&self, plane: usize) -> Scratch<'_> {
        let [numbers, lines] = self.plane(plane).needs();
        // SAFETY: the caller's promise.
        unsafe {
            Scratch {
                numbers: self
                    .fields
                    .numbers
                    .write(plane * numbers..(plane + 1) * numbers),
                lines: self.fields.lines.write(plane * lines..(plane + 1) * lines),
            }
        }
    }

    /// The nodes of a plane take `moments`.
    ///
    /// # Safety
    /// Nobody else works on the plane.
    unsafe fn take(&self, plane: usize, moments: &[Moments], nodes: &mut [Row]) {
        // SAFETY: the caller's promise; the kernel is one for this processor.
        unsafe {
            (self.kernels.take)(&self.plane(plane), moments, self.scratch(plane), nodes);
        }
    }

    /// The lines along z of a plane, to be filled with what its nodes give: nodes between the walls
    /// stand behind those that are behind the bottom; `Plane::mirror` fills the ends.
    ///
    /// # Safety
    /// Nobody else works on the plane.
    pub unsafe fn lines(&self, plane: usize) -> impl Iterator<Item = &mut [Row]> {
        // SAFETY: the caller's promise.
        let Scratch { lines, .. } = unsafe { self.scratch(plane) };
        lines.chunks_exact_mut(self.plane(plane).line())
    }

    /// The nodes of a plane give what its lines have been filled with.
    ///
    /// # Safety
    /// As above.
    pub unsafe fn give(&self, plane: usize, sheets: &Shared<Sheets>) {
        let groups = self.lattice.groups();
        // SAFETY: as above.
        unsafe {
            let sheets = sheets.write(plane * groups..(plane + 1) * groups);
            (self.kernels.give)(&self.plane(plane), self.scratch(plane), sheets);
        }
    }

    /// Mean velocities of the faces of a plane from what they have taken of ways.
    pub fn mean_velocities(&self, plane: usize, rate: f64, walls: [f64; 2], velocity: &mut [Row]) {
        let range = self.lattice.cells_of(plane);
        for (velocity, inverse) in velocity.iter_mut().zip(&self.frozen.inverse[range.clone()]) {
            for lane in 0..4 {
                velocity.0[lane] *= rate * inverse.0[lane];
            }
        }
        if !self.frozen.walls.is_empty() {
            for (velocity, share) in velocity.iter_mut().zip(&self.frozen.walls[range]) {
                velocity.0[2] += share[0] * walls[0] + share[1] * walls[1];
            }
        }
        for column in velocity.chunks_exact_mut(self.lattice.cells[2]) {
            column[0].0[2] = walls[0];
        }
    }

    fn reactions(&self, plane: usize, rate: f64, share: f64) {
        let range = self.lattice.cells_of(plane);
        // SAFETY: each plane is one thread's; moments are read between two meetings.
        let (reaction, velocity) = unsafe {
            let reaction = self.fields.reaction.write(range.clone());
            self.take(plane, self.fields.loose.read(), reaction);
            (reaction, &self.fields.velocity.read()[range.clone()])
        };
        let frozen = &self.frozen;
        let weights = frozen.ease[range.clone()].iter().zip(&frozen.loose[range]);
        for ((reaction, velocity), (ease, loose)) in reaction.iter_mut().zip(velocity).zip(weights)
        {
            for lane in 0..3 {
                let given = ease.0[lane] * rate * reaction.0[lane];
                reaction.0[lane] = share * (given - loose.0[lane] * velocity.0[lane]);
            }
        }
    }

    /// Σ `of` K over the grains at each face, on the caller's thread.
    pub fn sums_of<const M: usize>(&self, of: [&[Row]; M]) -> [Vec<Row>; M] {
        of.map(|of| self.sums(self.kernels.sum, of, &[]))
    }

    /// Σ `of` K times the grains' components of `vector` along the normal, one row a grain.
    pub fn flow_of(&self, of: &[Row], vector: &[Row]) -> Vec<Row> {
        assert!(
            vector.len() >= self.exchange.count,
            "one row for each grain"
        );
        self.sums(self.kernels.scatter, of, vector)
    }

    fn sums(&self, scatter: Scatter, of: &[Row], vector: &[Row]) -> Vec<Row> {
        let all = 0..self.exchange.groups.len();
        let mut sums = vec![Row::ZERO; self.lattice.count()];
        // SAFETY: there is one thread, and a vector for each grain where it is asked for.
        unsafe {
            let moments = self.fields.moments.write(all.clone());
            scatter(self.exchange, all, of, vector, moments);
            for plane in 0..self.lattice.cells[0] {
                self.take(plane, moments, &mut sums[self.lattice.cells_of(plane)]);
            }
        }
        sums
    }

    /// What each grain finds of `field`, one row a node, on the caller's thread.
    pub fn found(&self, field: &[Row], to: &mut [[Row; 3]]) {
        // SAFETY: there is one thread.
        unsafe {
            for plane in 0..self.lattice.cells[0] {
                let nz = self.lattice.cells[2];
                let nodes = field[self.lattice.cells_of(plane)].chunks_exact(nz);
                for (line, nodes) in self.lines(plane).zip(nodes) {
                    line[half_width(N)..][..nz].copy_from_slice(nodes);
                    self.plane(plane).mirror(line);
                }
                self.give(plane, &self.fields.mean);
            }
            (self.kernels.read)(self.given(&self.fields.mean), to);
        }
    }

    /// What grains gather from.
    ///
    /// # Safety
    /// The sheets are written before the last meeting.
    unsafe fn given<'s>(&'s self, sheets: &'s Shared<Sheets>) -> Given<'s> {
        Given {
            lattice: self.lattice,
            exchange: self.exchange,
            // SAFETY: the caller's promise.
            sheets: unsafe { sheets.read() },
        }
    }

    /// Add the water's push and lift to the forces of the grains `own`.
    pub fn gather(&self, moved: &Moved, own: Range<usize>, force: &mut [Row]) {
        assert!(
            moved.way.len() >= self.exchange.count,
            "grains came without notice"
        );
        // SAFETY: written before the last meeting; there are ways of all grains.
        unsafe {
            let push = self.given(&self.fields.push);
            (self.kernels.push)(push, own.clone(), force);
            if let Some(share) = self.share {
                let mean = self.given(&self.fields.mean);
                let drawn = Drawn {
                    way: moved.way,
                    rate: self.rate(moved),
                    share,
                };
                // Each grain is one thread's.
                let dragged = self.dragged(own.clone());
                dragged.fill(Row::ZERO);
                (self.kernels.drag)(mean, drawn, own.clone(), force, dragged);
                self.book_drag(moved, own);
            }
        }
    }
}
