//! From the velocities of faces to pressure, and from pressure to what faces push with.

use crate::faces::{Pass, drags};
use crate::kernel::half_width;
use dem::{Moved, Threads};

impl<const N: usize> Pass<'_, N> {
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
        for plane in threads.share(self.lattice.cells[0]) {
            self.push_plane(plane, pressure, drags(moved.step));
        }
        threads.meet();
    }

    fn push_plane(&self, i: usize, pressure: &[f64], drags: bool) {
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
