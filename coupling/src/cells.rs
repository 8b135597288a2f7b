//! From the velocities of faces to pressure, and from pressure to what faces push with.

use crate::faces::Pass;
use crate::kernel::half_width;
use crate::trend::Trend;
use dem::{Moved, Row, Threads};

impl<const N: usize> Pass<'_, N> {
    /// Collect the volume that faces have brought to the cells since the last exchange, and
    /// hand it on: what grains feel.
    pub fn collect(
        &self,
        moved: &Moved,
        threads: &Threads,
        pressure: impl Fn(usize, f64, &mut Trend) -> f64,
    ) {
        let top = self.wall_velocities(moved)[1];
        let passed = moved.passed[0] as f64;
        // SAFETY: velocities are written before the last meeting.
        let velocity = unsafe { self.fields.velocity.read() };
        for plane in threads.share(self.lattice.cells[0]) {
            let range = self.lattice.cells_of(plane);
            // SAFETY: each plane is one thread's.
            let (collected, feel, trends) = unsafe {
                let feel = self.fields.pressure.write(range.clone());
                let trends = self.fields.trends.write(range.clone());
                (self.fields.collected.write(range.clone()), feel, trends)
            };
            let mut book = self.book_cells(plane);
            self.brought(plane, velocity, top, |own, flux| {
                let volume = self.step * flux;
                book(own, feel[own], passed, volume);
                collected[own] += passed * volume;
                feel[own] = pressure(range.start + own, collected[own], &mut trends[own]);
            });
        }
    }

    /// Volume that faces of these velocities bring to the cells of a plane, and the top wall [m³/s].
    pub fn brought(
        &self,
        plane: usize,
        velocity: &[Row],
        top: f64,
        mut each: impl FnMut(usize, f64),
    ) {
        let lattice = self.lattice;
        let [_, ny, nz] = lattice.cells;
        let side = lattice.spacing * lattice.height;
        let floor = lattice.spacing * lattice.spacing;
        for j in 0..ny {
            let here = lattice.cell([plane, j, 0]);
            let behind = lattice.cell([lattice.next(0, plane), j, 0]);
            let beside = lattice.cell([plane, lattice.next(1, j), 0]);
            for k in 0..nz {
                let v = &velocity[here + k].0;
                let above = if k + 1 < nz {
                    velocity[here + k + 1].0[2]
                } else {
                    top
                };
                let along = (velocity[behind + k].0[0] - v[0]) + (velocity[beside + k].0[1] - v[1]);
                each(j * nz + k, side * along + floor * (above - v[2]));
            }
        }
    }

    /// What faces push their grains with, and walls.
    pub fn push(&self, threads: &Threads) {
        threads.meet();
        // SAFETY: pressure and velocities are written before this meeting.
        let pressure = unsafe { self.fields.pressure.read() };
        for plane in threads.share(self.lattice.cells[0]) {
            self.push_plane(plane, pressure);
        }
        threads.meet();
    }

    fn push_plane(&self, i: usize, pressure: &[f64]) {
        let drags = self.share.is_some();
        let (lattice, frozen) = (self.lattice, self.frozen);
        let nz = lattice.cells[2];
        let side = lattice.spacing * lattice.height;
        let floor = lattice.spacing * lattice.spacing;
        let mut on_walls = [0.0; 2];
        // SAFETY: each plane is one thread's; velocities and reactions are written before the last
        // meeting.
        let (lines, velocity, reaction) = unsafe {
            let velocity = self.fields.velocity.read();
            (self.lines(i), velocity, self.fields.reaction.read())
        };
        let (plane, reach) = (self.plane(i), half_width(N));
        for (j, line) in lines.enumerate() {
            let here = lattice.cell([i, j, 0]);
            let left = lattice.cell([lattice.last(0, i), j, 0]);
            let front = lattice.cell([i, lattice.last(1, j), 0]);
            let mut below = pressure[here];
            for (k, push) in line[reach..reach + nz].iter_mut().enumerate() {
                let cell = here + k;
                let p = pressure[cell];
                let mut force = [
                    side * (pressure[left + k] - p),
                    side * (pressure[front + k] - p),
                    floor * (below - p),
                    0.0,
                ];
                below = p;
                if let Some(kept) = self.fields.kept.get(cell) {
                    for lane in 0..3 {
                        force[lane] -= kept.0[lane];
                    }
                }
                if drags {
                    for lane in 0..3 {
                        force[lane] += reaction[cell].0[lane];
                    }
                }
                for lane in 0..4 {
                    push.0[lane] = force[lane] * frozen.inverse[cell].0[lane];
                }
                if !frozen.walls.is_empty() {
                    let [bottom, top] = frozen.walls[cell];
                    on_walls[0] -= bottom * force[2];
                    on_walls[1] += top * force[2];
                }
            }
            plane.mirror(line);
            on_walls[0] += floor * pressure[here];
            on_walls[1] += floor * pressure[here + nz - 1];
            if let Some([bottom, top]) = self.fields.ends.get(i * lattice.cells[1] + j) {
                line[reach].0[2] = bottom.push;
                line[reach + nz].0[2] = top.push;
                on_walls[0] += floor * bottom.excess;
                on_walls[1] += floor * top.excess;
            }
        }
        // SAFETY: each plane is one thread's.
        unsafe {
            self.fields.on_walls.write(i..i + 1)[0] = on_walls;
            self.give(i, &self.fields.push);
        }
        if drags {
            self.book_reactions(i);
            // SAFETY: as above.
            let lines = unsafe { self.lines(i) };
            for (j, line) in lines.enumerate() {
                let here = lattice.cell([i, j, 0]);
                for (k, mean) in line[reach..reach + nz].iter_mut().enumerate() {
                    for lane in 0..4 {
                        let ease = frozen.ease[here + k].0[lane];
                        mean.0[lane] = ease * velocity[here + k].0[lane];
                    }
                }
                plane.mirror(line);
            }
            // SAFETY: as above.
            unsafe { self.give(i, &self.fields.mean) };
        }
    }

    /// Force on the bottom (0) or the top wall (1), away from the grains [N].
    pub fn on_wall(&self, side: usize) -> f64 {
        // SAFETY: written before the last meeting.
        let planes = unsafe { self.fields.on_walls.read() };
        planes.iter().map(|plane| plane[side]).sum()
    }
}
