//! Faces and cells: mean velocities, the volume they bring, pressure, and what pushes back.
//!
//! Every face has a mean velocity of the solid, v_f = Σ a_if v_i and a share of the walls' (the
//! images of grains beside them). The faces at the walls move with these. A cell gets
//! Q = Σ v_f A_f from its six faces, and a pressure difference G_f = A_f (p_right - p_left) pushes
//! a face's grains by -a_if G_f and the walls by their share.
//!
//! Loose grains: every few steps they are dragged towards the mean, each by s_f γ_i K_if (v_f - v_i)
//! at each of its faces, and the face's grains get what is lost, R_f = Σ s_f γ_i K_if (v_i - v_f).
//! γ_i = (1 - w_i) m ν T/dt is the drag of the T between two drags at once. The velocity between
//! the two crowds falls by the rate ν + Σ γ K/m_f, m_f = ρ Σ w V K, times T: by r, were it not
//! for s_f = 1/max(1 + r/2, r). So the mean over T of the velocity that a steady force keeps up is
//! that of drag in every step, up to r = 2, and nothing overshoots beyond: the quadratic form of
//! the drag, with |v_f|² ≤ Σ a_if v_i², is at most s_f r of the kinetic energy's. In a virgin bed
//! of k_n = 1e9 N/m too weak a drag shows: pressure at T = 0.4 was 13.6 % low with implicit drag,
//! 1/(1 + r), every 8 steps, 10.8 % with this one every 4, 10 % with drag in every step.

use crate::exchange::{Exchange, Layout, Touch, gather_all};
use crate::kernel::{folded_cell, folded_face};
use crate::lattice::Lattice;
use dem::{Moved, Row, Shared, Threads, WallState};
use std::ops::Range;

/// Steps between two drags of loose grains.
pub(crate) const DRAG_EVERY: u64 = 4;

/// Is loose grains' drag part of this step? Not of the forces at which water joins.
pub(crate) fn drags(step: u64) -> bool {
    step > 0 && step.is_multiple_of(DRAG_EVERY)
}

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

/// What changes in every step, one entry a cell or its lower faces.
pub(crate) struct Fields {
    /// Mean velocity [m/s].
    pub velocity: Shared<Row>,
    /// R_f [N].
    reaction: Shared<Row>,
    /// Padded: what faces push with per w V K, and s_f v_f.
    push: Shared<Row>,
    mean: Shared<Row>,
    /// Σ γ K v of loose grains, one array a part.
    loose: Vec<Shared<Row>>,
    /// ∫Q dt since the last fluid step [m³].
    pub collected: Shared<f64>,
    /// Pressure that grains feel [Pa].
    pub pressure: Shared<f64>,
    /// Force on the bottom and the top wall, away from the grains [N], one entry a plane.
    pub on_walls: Shared<[f64; 2]>,
}

impl Fields {
    pub fn new(lattice: &Lattice) -> Self {
        let padded = lattice.padded()[0] * lattice.padded_plane();
        let rows = |count| Shared::new(vec![Row::ZERO; count]);
        let count = lattice.count();
        Self {
            velocity: rows(count),
            reaction: rows(count),
            push: rows(padded),
            mean: rows(padded),
            loose: Vec::new(),
            collected: Shared::new(vec![0.0; count]),
            pressure: Shared::new(vec![0.0; count]),
            on_walls: Shared::new(vec![[0.0; 2]; lattice.cells[0]]),
        }
    }

    /// Make room for the sums of the parts.
    pub fn fit<const N: usize>(&mut self, exchange: &Exchange<N>, lattice: &Lattice) {
        let nodes = |planes: &Range<usize>| planes.len() * lattice.padded_plane();
        let parts = exchange.parts.iter();
        self.loose = parts
            .map(|part| Shared::new(vec![Row::ZERO; nodes(&part.planes)]))
            .collect();
    }
}

/// All that the threads share in one step.
pub(crate) struct Pass<'a, const N: usize> {
    pub lattice: &'a Lattice,
    pub exchange: &'a Exchange<N>,
    pub frozen: &'a Frozen,
    pub fields: &'a Fields,
    /// Indices of the bottom and the top wall.
    pub walls: [usize; 2],
}

impl<const N: usize> Pass<'_, N> {
    /// Mean velocities of all faces.
    pub fn follow(&self, moved: &Moved, threads: &Threads) {
        let (lattice, exchange) = (self.lattice, self.exchange);
        for k in threads.share(exchange.parts.len()) {
            // SAFETY: each part is one thread's until they meet.
            unsafe {
                exchange.scatter(lattice, k, |grain, touch| {
                    moved.velocity[grain].0.map(|v| touch.volume * v)
                });
                if drags(moved.step) {
                    exchange.scatter_into(lattice, k, &self.fields.loose[k], |grain, _| {
                        moved.velocity[grain]
                            .0
                            .map(|v| exchange.loose[grain].drag * v)
                    });
                }
            }
        }
        threads.meet();
        let walls = self.wall_velocities(moved.walls);
        for plane in threads.share(lattice.cells[0]) {
            self.mean_velocities(plane, walls);
            if drags(moved.step) {
                self.reactions(plane);
            }
        }
        threads.meet();
    }

    /// Velocities of the bottom and the top wall along z.
    fn wall_velocities(&self, walls: &[WallState]) -> [f64; 2] {
        let [bottom, top] = self.walls.map(|k| walls[k].velocity);
        [bottom, -top]
    }

    /// Add up what parts have scattered to the nodes of a plane, in one order.
    fn add_up<'s>(&'s self, plane: usize, of: impl Fn(usize) -> &'s [Row], to: &mut [Row]) {
        let lattice = self.lattice;
        let nz = lattice.cells[2];
        to.fill(Row::ZERO);
        for &(part, alias) in &self.exchange.reached[plane] {
            let first = self.exchange.parts[part].planes.start;
            let start = (alias - first) * lattice.padded_plane();
            let from = &of(part)[start..start + lattice.padded_plane()];
            let pad = lattice.pad_z;
            for (padded, column) in from.chunks_exact(lattice.padded_column()).enumerate() {
                let j = lattice.unpadded(1, padded);
                let to = &mut to[j * nz..(j + 1) * nz];
                for (sum, row) in to.iter_mut().zip(&column[pad..]) {
                    for lane in 0..4 {
                        sum.0[lane] += row.0[lane];
                    }
                }
                // What fell behind the walls, of the opposite flux.
                for k in (0..pad).chain(pad + nz..pad + nz + pad) {
                    let place = k as i64 - pad as i64;
                    let sum = &mut to[folded_cell(place, nz)].0;
                    sum[0] += column[k].0[0];
                    sum[1] += column[k].0[1];
                    let (face, behind) = folded_face(place, nz);
                    if behind.is_some() && face < nz {
                        to[face].0[2] -= column[k].0[2];
                    }
                }
            }
        }
    }

    fn mean_velocities(&self, plane: usize, walls: [f64; 2]) {
        let range = self.lattice.cells_of(plane);
        // SAFETY: each plane is one thread's; parts are read between two meetings.
        let velocity = unsafe { self.fields.velocity.write(range.clone()) };
        let parts = &self.exchange.parts;
        // SAFETY: as above.
        let sums = |part: usize| unsafe { parts[part].sums.read() };
        self.add_up(plane, sums, velocity);
        for (velocity, inverse) in velocity.iter_mut().zip(&self.frozen.inverse[range.clone()]) {
            for lane in 0..4 {
                velocity.0[lane] *= inverse.0[lane];
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

    fn reactions(&self, plane: usize) {
        let range = self.lattice.cells_of(plane);
        // SAFETY: each plane is one thread's; parts are read between two meetings.
        let (reaction, velocity) = unsafe {
            let velocity = &self.fields.velocity.read()[range.clone()];
            (self.fields.reaction.write(range.clone()), velocity)
        };
        // SAFETY: as above.
        let sums = |part: usize| unsafe { self.fields.loose[part].read() };
        self.add_up(plane, sums, reaction);
        let frozen = &self.frozen;
        let weights = frozen.ease[range.clone()].iter().zip(&frozen.loose[range]);
        for ((reaction, velocity), (ease, loose)) in reaction.iter_mut().zip(velocity).zip(weights)
        {
            for lane in 0..3 {
                let given = ease.0[lane] * reaction.0[lane];
                reaction.0[lane] = given - loose.0[lane] * velocity.0[lane];
            }
        }
    }

    /// Σ `of` K over the grains at each face, on the caller's thread.
    pub fn sums_of<const M: usize>(&self, of: [&dyn Fn(usize) -> f64; M]) -> [Vec<Row>; M] {
        of.map(|of| {
            for k in 0..self.exchange.parts.len() {
                // SAFETY: there is one thread.
                unsafe {
                    let value = |grain: usize, _: &Touch<N>| [of(grain); 4];
                    self.exchange.scatter(self.lattice, k, value);
                }
            }
            let mut sums = vec![Row::ZERO; self.lattice.count()];
            for plane in 0..self.lattice.cells[0] {
                let parts = &self.exchange.parts;
                // SAFETY: as above.
                let of_part = |part: usize| unsafe { parts[part].sums.read() };
                self.add_up(plane, of_part, &mut sums[self.lattice.cells_of(plane)]);
            }
            sums
        })
    }

    /// What each grain gathers of `field`, one row a node, on the caller's thread.
    pub fn gathered(&self, field: &[Row]) -> Vec<[f64; 4]> {
        let lattice = self.lattice;
        let mut nodes = vec![Row::ZERO; lattice.padded()[0] * lattice.padded_plane()];
        let columns = nodes.chunks_exact_mut(lattice.padded_column());
        for (column, nodes) in columns.enumerate() {
            let [planes, along] = [column / lattice.padded()[1], column % lattice.padded()[1]];
            let (i, j) = (lattice.unpadded(0, planes), lattice.unpadded(1, along));
            let first = lattice.cell([i, j, 0]);
            let field = &field[first..first + lattice.cells[2]];
            nodes[lattice.pad_z..][..field.len()].copy_from_slice(field);
            self.mirror(nodes);
        }
        let mut sums = Vec::with_capacity(self.exchange.touches.len());
        let layout = Layout::of(lattice, &self.exchange.table);
        gather_all(&self.exchange.touches, layout, &nodes, |_, _, sum| {
            sums.push(sum);
        });
        sums
    }

    /// Fill the padding of a column behind the walls: what images of grains are pushed with.
    fn mirror(&self, column: &mut [Row]) {
        let (nz, pad) = (self.lattice.cells[2], self.lattice.pad_z);
        column[pad].0[2] = 0.0;
        for k in (0..pad).chain(pad + nz..pad + nz + pad) {
            let place = k as i64 - pad as i64;
            let cell = column[pad + folded_cell(place, nz)].0;
            let (face, behind) = folded_face(place, nz);
            let across = match behind.is_some() && face < nz {
                true => -column[pad + face].0[2],
                false => 0.0,
            };
            column[k] = Row([cell[0], cell[1], across, 0.0]);
        }
    }

    /// Collect the volume that faces bring to the cells in `step` [s], and hand it on.
    pub fn collect(
        &self,
        moved: &Moved,
        threads: &Threads,
        step: f64,
        pressure: impl Fn(usize, f64) -> f64,
    ) {
        let lattice = self.lattice;
        let [_, ny, nz] = lattice.cells;
        let top = self.wall_velocities(moved.walls)[1];
        let side = lattice.spacing * lattice.height;
        let floor = lattice.spacing * lattice.spacing;
        // SAFETY: velocities are written before the last meeting.
        let velocity = unsafe { self.fields.velocity.read() };
        for i in threads.share(lattice.cells[0]) {
            let range = lattice.cells_of(i);
            // SAFETY: each plane is one thread's.
            let (collected, feel) = unsafe {
                let feel = self.fields.pressure.write(range.clone());
                (self.fields.collected.write(range.clone()), feel)
            };
            for j in 0..ny {
                let here = lattice.cell([i, j, 0]);
                let behind = lattice.cell([lattice.next(0, i), j, 0]);
                let beside = lattice.cell([i, lattice.next(1, j), 0]);
                for k in 0..nz {
                    let v = &velocity[here + k].0;
                    let above = if k + 1 < nz {
                        velocity[here + k + 1].0[2]
                    } else {
                        top
                    };
                    let along =
                        (velocity[behind + k].0[0] - v[0]) + (velocity[beside + k].0[1] - v[1]);
                    let flux = side * along + floor * (above - v[2]);
                    let own = j * nz + k;
                    collected[own] += step * flux;
                    feel[own] = pressure(here + k, collected[own]);
                }
            }
        }
    }

    /// What faces push their grains with, and walls.
    pub fn push(&self, moved: &Moved, threads: &Threads) {
        threads.meet();
        // SAFETY: pressure and velocities are written before this meeting.
        let pressure = unsafe { self.fields.pressure.read() };
        for padded in threads.share(self.lattice.padded()[0]) {
            self.push_plane(padded, pressure, drags(moved.step));
        }
        threads.meet();
    }

    fn push_plane(&self, padded: usize, pressure: &[f64], drags: bool) {
        let lattice = self.lattice;
        let [nx, ny, nz] = lattice.cells;
        let i = lattice.unpadded(0, padded);
        let own = padded >= lattice.pad && padded < lattice.pad + nx;
        let side = lattice.spacing * lattice.height;
        let floor = lattice.spacing * lattice.spacing;
        let nodes = padded * lattice.padded_plane()..(padded + 1) * lattice.padded_plane();
        // SAFETY: each padded plane is one thread's; velocities and reactions are written before
        // the last meeting.
        let (push, mean, velocity, reaction) = unsafe {
            (
                self.fields.push.write(nodes.clone()),
                self.fields.mean.write(nodes),
                self.fields.velocity.read(),
                self.fields.reaction.read(),
            )
        };
        let mut on_walls = [0.0; 2];
        let before = lattice.last(0, i);
        for column in 0..lattice.padded()[1] {
            let j = lattice.unpadded(1, column);
            let first = column >= lattice.pad && column < lattice.pad + ny;
            let here = lattice.cell([i, j, 0]);
            let left = lattice.cell([before, j, 0]);
            let front = lattice.cell([i, lattice.last(1, j), 0]);
            let first_node = column * lattice.padded_column() + lattice.pad_z;
            for k in 0..nz {
                let (cell, node) = (here + k, first_node + k);
                let p = pressure[cell];
                let below = if k > 0 { pressure[cell - 1] } else { p };
                let mut force = [
                    side * (pressure[left + k] - p),
                    side * (pressure[front + k] - p),
                    floor * (below - p),
                ];
                if drags {
                    for lane in 0..3 {
                        force[lane] += reaction[cell].0[lane];
                        let ease = self.frozen.ease[cell].0[lane];
                        mean[node].0[lane] = ease * velocity[cell].0[lane];
                    }
                }
                for lane in 0..3 {
                    push[node].0[lane] = force[lane] * self.frozen.inverse[cell].0[lane];
                }
                if own && first && !self.frozen.walls.is_empty() {
                    let [bottom, top] = self.frozen.walls[cell];
                    on_walls[0] -= bottom * force[2];
                    on_walls[1] += top * force[2];
                }
            }
            let nodes = column * lattice.padded_column()..(column + 1) * lattice.padded_column();
            self.mirror(&mut push[nodes.clone()]);
            if drags {
                self.mirror(&mut mean[nodes]);
            }
            if own && first {
                on_walls[0] += floor * pressure[here];
                on_walls[1] += floor * pressure[here + nz - 1];
            }
        }
        if own {
            // SAFETY: each plane is one thread's.
            unsafe { self.fields.on_walls.write(i..i + 1)[0] = on_walls };
        }
    }

    /// Add the water's push to the forces of the grains `own`, and `lift` of each [N].
    pub fn gather(
        &self,
        moved: &Moved,
        own: Range<usize>,
        force: &mut [Row],
        lift: impl Fn(usize) -> f64,
    ) {
        let layout = Layout::of(self.lattice, &self.exchange.table);
        let touches = &self.exchange.touches[own.clone()];
        // SAFETY: written before the last meeting.
        let (push, mean) = unsafe { (self.fields.push.read(), self.fields.mean.read()) };
        gather_all(touches, layout, push, |k, touch, sum| {
            let force = &mut force[k].0;
            for lane in 0..4 {
                force[lane] += touch.volume * sum[lane];
            }
            force[2] += lift(own.start + k);
        });
        if drags(moved.step) {
            let loose = &self.exchange.loose[own.clone()];
            gather_all(touches, layout, mean, |k, _, sum| {
                let velocity = moved.velocity[own.start + k].0;
                let force = &mut force[k].0;
                for lane in 0..4 {
                    let slip = sum[lane] - loose[k].grip[lane] * velocity[lane];
                    force[lane] += loose[k].drag * slip;
                }
            });
        }
    }

    /// Force on the bottom (0) or the top wall (1), away from the grains [N].
    pub fn on_wall(&self, side: usize) -> f64 {
        // SAFETY: written before the last meeting.
        let planes = unsafe { self.fields.on_walls.read() };
        planes.iter().map(|plane| plane[side]).sum()
    }
}
