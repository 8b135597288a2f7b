//! What the water must know of the grains: their weights at the faces, solid volume, storage, lift.

use super::Water;
use crate::Error;
use crate::exchange::{Exchange, Loose, Touch, middle};
use crate::faces::{DRAG_EVERY, Frozen, Pass};
use crate::kernel::{folded_cell, folded_face, half_width, shares};
use crate::lattice::Lattice;
use dem::Row;
use glam::DVec3;

impl<const N: usize> Water<N> {
    /// Weigh the grains and lay them on the lattice: weights, solid volume, storage.
    pub(super) fn weigh(&mut self, bed: &dem::Bed) -> Result<(), Error> {
        span(&mut self.lattice, self.walls, bed);
        let lattice = &self.lattice;
        bed.contact_loads(&mut self.scratch.loads);
        let memory = self.model.load_memory;
        self.loads
            .read(bed.id, &self.scratch.loads, bed.time, memory);
        let half = self.model.loose * self.loads.over_all();

        let gravity = bed.model.gravity.z;
        let density = self.model.fluid.density;
        self.solid.fill(0.0);
        let mut touches = Vec::with_capacity(bed.id.len());
        let mut looseness = Vec::with_capacity(bed.id.len());
        self.lift.clear();
        let mut images = Vec::new();
        if N > 3 {
            images.resize(lattice.count(), [0.0; 2]);
        }
        for k in 0..bed.id.len() {
            let row = bed.position[k];
            let volume = volume(row);
            self.lift.push(-density * gravity * volume);
            let weight = (bed.mass[k] - density * volume).abs() * gravity.abs();
            let counts = self.loads.weight(bed.id[k], weight, half);
            let at = place(lattice, row.xyz());
            deposit::<N>(lattice, at, volume, &mut self.solid);
            if N > 3 {
                add_images::<N>(lattice, at, counts * volume, &mut images);
            }
            touches.push(Touch::new(lattice, at, counts * volume));
            looseness.push(1.0 - counts);
        }
        for cell in 0..lattice.count() {
            let pores = lattice.volume() - self.solid[cell];
            if pores < 0.02 * lattice.volume() {
                let what = format!("a cell of the water holds {pores:.2e} m³ of it: too little");
                return Err(Error::Invalid(what));
            }
            self.storage[cell] = self.model.fluid.compressibility * pores;
        }
        if let Some(cavitation) = self.model.cavitation {
            let weight = density * gravity.abs();
            for cell in 0..lattice.count() {
                let depth = (lattice.cells[2] - cell % lattice.cells[2]) as f64 - 0.5;
                self.least[cell] = cavitation.pressure - weight * depth * lattice.height;
            }
        }
        self.freeze(bed, touches, &looseness, images);
        Ok(())
    }

    /// What faces weigh with these grains; `looseness` is the part of each that does not count.
    fn freeze(
        &mut self,
        bed: &dem::Bed,
        touches: Vec<Touch<N>>,
        looseness: &[f64],
        images: Vec<[f64; 2]>,
    ) {
        let lattice = &self.lattice;
        // ν T of each grain, were it quite loose.
        let mut paces = Vec::with_capacity(touches.len());
        let loose = looseness.iter().enumerate().map(|(k, looseness)| {
            let at = place(lattice, bed.position[k].xyz());
            let (cell, _) = middle(lattice, at);
            let [i, j] = [0, 1].map(|axis| cell[axis].rem_euclid(lattice.cells[axis] as i64));
            let at = lattice.cell([i as usize, j as usize, cell[2] as usize]);
            let solid = self.solid[at] / lattice.volume();
            let porosity = 1.0 - solid;
            let resistance = self.resistance(porosity, [0.0; 3]);
            let drag = porosity * porosity * resistance * volume(bed.position[k]) / solid;
            let drag = DRAG_EVERY as f64 * drag;
            paces.push(drag * self.step / bed.mass[k]);
            Loose {
                drag: looseness * drag,
                grip: [0.0; 4],
            }
        });
        let loose = loose.collect();
        let mut exchange = Exchange::new(lattice, touches, loose);
        self.fields.fit(&exchange, lattice);
        let pass = Pass {
            lattice,
            exchange: &exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
        };
        // Sums with the very weights of the steps to come.
        let [mut inverse, mut loose, fast] = pass.sums_of([
            &|grain| exchange.touches[grain].volume,
            &|grain| exchange.loose[grain].drag,
            &|grain| exchange.loose[grain].drag * paces[grain],
        ]);
        let mut ease = vec![Row::ZERO; lattice.count()];
        for cell in 0..lattice.count() {
            for lane in 0..3 {
                let images = match (lane, images.get(cell)) {
                    (2, Some(share)) => share[0] + share[1],
                    _ => 0.0,
                };
                let weight = inverse[cell].0[lane] + images;
                let drag = loose[cell].0[lane];
                let carry = self.density * weight;
                // Of the velocity between loose grains and the others r = (ν + Σ γ K/m_f) T
                // would go at the pace that it has now.
                let eased = if carry > 0.0 && drag > 0.0 {
                    let r = fast[cell].0[lane] / drag + drag * self.step / carry;
                    1.0 / (1.0 + 0.5 * r).max(r)
                } else {
                    0.0
                };
                ease[cell].0[lane] = eased;
                loose[cell].0[lane] = eased * drag;
                inverse[cell].0[lane] = if weight > 0.0 { 1.0 / weight } else { 0.0 };
            }
        }
        let mut walls = images;
        for (share, inverse) in walls.iter_mut().zip(&inverse) {
            *share = share.map(|s| s * inverse.0[2]);
        }
        self.frozen = Frozen {
            inverse,
            ease,
            loose,
            walls,
        };
        let grips = Pass {
            lattice,
            exchange: &exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
        }
        .gathered(&self.frozen.ease);
        for (loose, grip) in exchange.loose.iter_mut().zip(grips) {
            loose.grip = grip;
        }
        self.exchange = exchange;
    }

    /// Weights, porosity and permeability anew; contents stay.
    pub(super) fn renew(&mut self, bed: &dem::Bed) -> Result<(), Error> {
        self.weigh(bed)?;
        let flux = match self.model.resistance.nonlinear() {
            true => self.fluid.snapshot().flux,
            false => vec![[0.0; 3]; self.lattice.count()],
        };
        let height = self.lattice.height;
        let kept = self
            .fluid
            .set_thickness(height)
            .and_then(|()| self.fluid.set_bed(self.bed_of_lbm(&flux)));
        if kept.is_err() {
            // The bed has changed so much that this lattice does not fit it any more.
            let flux = self.fluid.snapshot().flux;
            let between = self.fluid.time();
            self.lay(between, &flux)?;
            self.events.relaid += 1;
        }
        Ok(())
    }
}

/// Stretch the lattice from wall to wall.
pub(super) fn span(lattice: &mut Lattice, walls: [usize; 2], bed: &dem::Bed) {
    let [bottom, top] = walls.map(|k| bed.walls[k].offset / bed.model.walls[k].normal.z);
    lattice.bottom = bottom;
    lattice.height = (top - bottom) / lattice.cells[2] as f64;
}

/// Volume of a grain from its row [m³].
pub(super) fn volume(row: Row) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * row.w().powi(3)
}

/// Place of a grain in cells: from the origin along x and y, from the bottom along z.
fn place(lattice: &Lattice, at: DVec3) -> [f64; 3] {
    let z = (at.z - lattice.bottom) / lattice.height;
    [at.x / lattice.spacing, at.y / lattice.spacing, z]
}

/// Call `each` with every cell that a grain reaches, that of its lower face along z with the wall
/// behind which it lies if it does, and its shares of both.
fn visit<const N: usize>(
    lattice: &Lattice,
    at: [f64; 3],
    mut each: impl FnMut(usize, f64, (usize, Option<usize>), f64),
) {
    let (cell, [x, y, z]) = middle(lattice, at);
    let (across, along) = (shares::<N>(x).0, shares::<N>(y).0);
    let (cells, faces) = shares::<N>(z);
    let m = half_width(N) as i64;
    let [nx, ny, nz] = lattice.cells;
    for i in 0..N {
        let plane = (cell[0] + i as i64 - m).rem_euclid(nx as i64) as usize;
        for j in 0..N {
            let column = (cell[1] + j as i64 - m).rem_euclid(ny as i64) as usize;
            let first = lattice.cell([plane, column, 0]);
            let share = across[i] * along[j];
            for k in 0..N {
                let up = cell[2] + k as i64 - m;
                let (face, behind) = folded_face(up, nz);
                let at = first + folded_cell(up, nz);
                each(
                    at,
                    share * cells[k],
                    (first + face, behind),
                    share * faces[k],
                );
            }
        }
    }
}

/// Add a grain's volume to the cells.
fn deposit<const N: usize>(lattice: &Lattice, at: [f64; 3], volume: f64, solid: &mut [f64]) {
    visit::<N>(lattice, at, |cell, share, _, _| {
        solid[cell] += volume * share
    });
}

/// Add twice the weights of a grain's images to the faces of normal z between the walls.
fn add_images<const N: usize>(
    lattice: &Lattice,
    at: [f64; 3],
    volume: f64,
    images: &mut [[f64; 2]],
) {
    visit::<N>(lattice, at, |_, _, (face, behind), share| {
        if let Some(wall) = behind {
            images[face][wall] += 2.0 * volume * share;
        }
    });
}
