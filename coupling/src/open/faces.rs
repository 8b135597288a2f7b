//! What acts on the water at each face, and what it does there: shear, drag, inertia, flux.

use super::{Open, neighbour, neighbours, porosity};
use crate::lattice::Lattice;
use dem::Row;
use lbm::Side;

impl Open {
    /// μ ∇²u at all faces between cells; nothing sticks to the walls.
    pub(super) fn shear(&mut self, lattice: &Lattice) {
        let [nx, ny, nz] = lattice.cells;
        let at = |i: usize, j: usize, k: usize| (i * ny + j) * (nz + 1) + k;
        let across = self.fluid.viscosity / lattice.spacing.powi(2);
        let along = self.fluid.viscosity / lattice.height.powi(2);
        let u = &self.velocity;
        for i in 0..nx {
            for j in 0..ny {
                let beside = |k: usize| {
                    [
                        at(lattice.next(0, i), j, k),
                        at(lattice.last(0, i), j, k),
                        at(i, lattice.next(1, j), k),
                        at(i, lattice.last(1, j), k),
                    ]
                };
                for k in 0..nz {
                    let here = at(i, j, k);
                    for axis in 0..3 {
                        if axis == 2 && k == 0 {
                            continue;
                        }
                        let own = u[here][axis];
                        let around = beside(k).map(|node| u[node][axis] - own);
                        let most = if axis == 2 { nz } else { nz - 1 };
                        let up = if k < most {
                            u[here + 1][axis] - own
                        } else {
                            0.0
                        };
                        let down = if k > 0 { u[here - 1][axis] - own } else { 0.0 };
                        self.shear[here][axis] =
                            across * around.iter().sum::<f64>() + along * (up + down);
                    }
                }
            }
        }
    }

    /// Inertia and drag at all faces: what the flux would be without a gradient of pressure, and
    /// how it yields to one. Returns the pressure outside of the bottom and the top.
    pub(super) fn react(
        &mut self,
        lattice: &Lattice,
        grains: &impl Fn(usize) -> [f64; 3],
    ) -> [f64; 2] {
        let inertia = self.fluid.density / self.step;
        let nz = lattice.cells[2];
        self.square(lattice);
        let mut outside = [0.0; 2];
        for node in 0..self.shares.len() {
            let (column, k) = (node / (nz + 1), node % (nz + 1));
            let v = grains(node);
            for axis in 0..3 {
                let end = axis == 2 && (k == 0 || k == nz);
                if k == nz && axis < 2 {
                    continue;
                }
                let side = usize::from(k > 0);
                let mut given = None;
                if end {
                    match &self.sides[side] {
                        Side::Pressure(signal) => outside[side] = signal.at(self.time),
                        Side::Flux(signal) => {
                            let into = signal.at(self.time);
                            given = Some(if side == 0 { into } else { -into });
                        }
                        _ => {
                            self.free[node][2] = 0.0;
                            self.yielding[node][2] = 0.0;
                            continue;
                        }
                    }
                }
                let share = &self.shares[node][axis];
                let phi = porosity(share);
                // Beside its own flux the mean of the others' around it.
                let cell = column * nz + k.min(nz - 1);
                let before = neighbour(lattice, cell, axis);
                let others: f64 = (0..3)
                    .filter(|&other| other != axis)
                    .map(|other| 0.5 * (self.squares[cell][other] + self.squares[before][other]))
                    .sum();
                let own = self.flux[node][axis];
                let speed = (own * own + others).sqrt();
                let drag = phi * share.resistance(&self.resistance, &self.fluid, speed);
                let reach = inertia + drag;
                let slip = self.velocity[node][axis] - v[axis];
                let push = inertia * slip + self.shear[node][axis] / phi;
                if let Some(flux) = given {
                    self.free[node][2] = flux;
                    self.yielding[node][2] = 0.0;
                    let drop = 0.5 * lattice.height * (reach * flux / phi - push);
                    self.ends[column][side].excess = if side == 0 { drop } else { -drop };
                    continue;
                }
                self.free[node][axis] = phi * push / reach;
                let distance = match axis {
                    2 if end => 0.5 * lattice.height,
                    2 => lattice.height,
                    _ => lattice.spacing,
                };
                self.yielding[node][axis] = phi / (reach * distance);
            }
        }
        outside
    }

    /// Mean squares of the fluxes through the two faces of each cell along each axis.
    fn square(&mut self, lattice: &Lattice) {
        for cell in 0..lattice.count() {
            for (axis, (lower, upper)) in neighbours(lattice, cell).into_iter().enumerate() {
                let pair = [lower, upper].map(|node| self.flux[node][axis].powi(2));
                self.squares[cell][axis] = 0.5 * (pair[0] + pair[1]);
            }
        }
    }

    /// The flux under the new pressure, the water's velocity, and what it keeps.
    pub(super) fn flow(
        &mut self,
        lattice: &Lattice,
        outside: [f64; 2],
        grains: &impl Fn(usize) -> [f64; 3],
    ) {
        let nz = lattice.cells[2];
        let volume = lattice.volume();
        for node in 0..self.shares.len() {
            let (column, k) = (node / (nz + 1), node % (nz + 1));
            let v = grains(node);
            for axis in 0..3 {
                if k == nz && axis < 2 {
                    continue;
                }
                let cell = column * nz + k;
                let drop = match (axis, k) {
                    (2, 0) => outside[0] - self.pressure[cell],
                    (2, k) if k == nz => self.pressure[cell - 1] - outside[1],
                    _ => self.pressure[neighbour(lattice, cell, axis)] - self.pressure[cell],
                };
                let flux = self.free[node][axis] + self.yielding[node][axis] * drop;
                let phi = porosity(&self.shares[node][axis]);
                let velocity = v[axis] + flux / phi;
                let before = self.velocity[node][axis];
                let change = velocity - before;
                self.flux[node][axis] = flux;
                self.velocity[node][axis] = velocity;
                let inertia = phi * self.fluid.density * change / self.step;
                let kept = inertia - self.shear[node][axis];
                if axis < 2 || (k > 0 && k < nz) {
                    self.kept[cell].0[axis] = volume * kept;
                    if self.books.kept {
                        let distance = [lattice.spacing, lattice.spacing, lattice.height][axis];
                        self.book_face(lattice, [node, axis], before, drop / distance);
                    }
                    continue;
                }
                let side = usize::from(k > 0);
                let end = &mut self.ends[column][side];
                match &self.sides[side] {
                    Side::Pressure(_) | Side::Flux(_) => {
                        if matches!(self.sides[side], Side::Pressure(_)) {
                            end.excess = if side == 0 { drop } else { -drop };
                        }
                        let drop = if side == 0 { end.excess } else { -end.excess };
                        let gradient = 2.0 * drop / lattice.height;
                        let solid = self.shares[node][2].solid;
                        end.push = if solid > 0.0 {
                            (gradient - kept) / solid
                        } else {
                            0.0
                        };
                        if self.books.kept {
                            self.book_face(lattice, [node, axis], before, gradient);
                        }
                    }
                    _ => end.push = 0.0,
                }
            }
        }
    }

    /// No water passes tight walls: what drags the grains in the half cells before them.
    pub(super) fn stand(&mut self, lattice: &Lattice, velocity: &[Row], walls: [f64; 2]) {
        let nz = lattice.cells[2];
        let tight = |side: usize| !matches!(self.sides[side], Side::Pressure(_) | Side::Flux(_));
        let tight = [tight(0), tight(1)];
        for end in self.ends.as_flattened_mut() {
            end.slip = 0.0;
        }
        for part in &self.beside_walls {
            let side = usize::from(part.side);
            let slip = velocity[part.grain as usize].xyz().z - walls[side];
            self.ends[part.column as usize][side].slip += part.share * slip;
        }
        for (column, ends) in self.ends.iter_mut().enumerate() {
            for side in (0..2).filter(|&side| tight[side]) {
                let share = &self.shares[column * (nz + 1) + side * nz][2];
                let end = &mut ends[side];
                let resistance = share.resistance(&self.resistance, &self.fluid, end.slip.abs());
                let drag = -resistance * end.slip;
                end.push = match share.solid > 0.0 {
                    true => drag / share.solid,
                    false => 0.0,
                };
                let drop = 0.5 * lattice.height * drag;
                end.excess = if side == 0 { drop } else { -drop };
                if self.books.kept {
                    self.books.drag -= 0.5 * self.step * lattice.volume() * drag * end.slip;
                }
            }
        }
    }
}
