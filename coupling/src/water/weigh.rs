//! What the water must know of the grains: their weights at the faces, solid volume, storage, lift.

use super::Water;
use super::flow::Flow;
use crate::Error;
use crate::exchange::Place;
use crate::faces::Frozen;
use crate::kernel::{folded_cell, folded_face, half_width, shares};
use crate::lattice::Lattice;
use crate::open::share;
use dem::{Row, Shared};
use glam::DVec3;

/// A grain on the scales.
struct Weight {
    /// Its volume [m³], and the parts of it that count and are dragged.
    volume: f64,
    counts: f64,
    loose: f64,
}

impl<const N: usize> Water<N> {
    /// Weigh the grains and lay them on the lattice: weights, solid volume, storage.
    pub(super) fn weigh(&mut self, bed: &dem::Bed) -> Result<(), Error> {
        self.book_loose();
        span(&mut self.lattice, self.walls, bed);
        self.drift_from(bed);
        let lattice = &self.lattice;
        bed.contact_loads(&mut self.scratch.loads);
        let memory = self.model.load_memory;
        self.loads
            .read(bed.id, &self.scratch.loads, bed.time, memory);
        let half = self.model.loose * self.loads.over_all();

        // Where pores are open, nothing is short-circuited: all grains count, and all are dragged.
        let open = self.is_open();
        let gravity = bed.model.gravity.z;
        let density = self.model.fluid.density;
        self.solid.fill(0.0);
        let mut places = Vec::with_capacity(bed.id.len());
        self.lift.clear();
        let mut weights = Vec::with_capacity(bed.id.len());
        let mut images = Vec::new();
        if N > 3 {
            images.resize(lattice.count(), [0.0; 2]);
        }
        for k in 0..bed.id.len() {
            let row = bed.position[k];
            let volume = volume(row);
            let weight = (bed.mass[k] - density * volume).abs() * gravity.abs();
            self.lift.push(-density * gravity * volume);
            let counts = match open {
                true => 1.0,
                false => self.loads.weight(bed.id[k], weight, half),
            };
            let place = Place::of(lattice, in_cells(lattice, row.xyz()));
            deposit::<N>(lattice, place, volume, &mut self.solid);
            if N > 3 {
                add_images::<N>(lattice, place, counts * volume, &mut images);
            }
            places.push(place);
            weights.push(Weight {
                volume,
                counts,
                loose: if open { 1.0 } else { 1.0 - counts },
            });
        }
        self.exchange.lay(lattice, &places);
        for cell in 0..lattice.count() {
            let pores = lattice.volume() - self.solid[cell];
            if pores < 0.02 * lattice.volume() {
                let what = format!(
                    "a cell of {:.2e} m³ holds {pores:.2e} m³ of water, too little: give fewer and \
                     larger cells, of two grain diameters",
                    lattice.volume()
                );
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
        if self.books.kept {
            self.fields.lost = Shared::new(vec![0.0; bed.id.len()]);
            self.fields.dragged = Shared::new(vec![Row::ZERO; bed.id.len()]);
        }
        self.freeze(bed, &places, &weights, images);
        self.drift_to(bed);
        if let Flow::Open(open) = &mut self.flow {
            let grains = bed.position.iter().take(bed.id.len());
            let grains = grains.map(|&row| (in_cells(&self.lattice, row.xyz()), volume(row)));
            let shares = share::<N>(&self.lattice, grains);
            open.weigh(&self.lattice, shares, self.density)?;
            self.events.convection = open.left_out();
        }
        Ok(())
    }

    /// What faces weigh with these grains.
    fn freeze(
        &mut self,
        bed: &dem::Bed,
        places: &[Place],
        weights: &[Weight],
        images: Vec<[f64; 2]>,
    ) {
        let mut exchange = std::mem::take(&mut self.exchange);
        let lattice = &self.lattice;
        let flux = self.is_open().then(|| self.flux());
        // Where pores are open the drag is that of each grain, and no device to hold it.
        let towed = if self.is_open() { 1.0 } else { self.towed };
        // γ times ν T of each grain, were it quite loose.
        let mut fast = vec![Row::ZERO; exchange.slots.len()];
        for (k, (place, weight)) in places.iter().zip(weights).enumerate() {
            let at = lattice.cell(place.cell);
            let solid = self.solid[at] / lattice.volume();
            let porosity = 1.0 - solid;
            let flux = flux.as_ref().map(|flux| flux[lattice.cell_of_lbm(at)]);
            let resistance = self.resistance(porosity, flux.unwrap_or_default());
            let quite = porosity * porosity * resistance * weight.volume / solid;
            let quite = towed * self.drags_every() as f64 * quite;
            let drag = weight.loose * quite;
            let (slot, lane) = exchange.at[k];
            let (slot, lane) = (slot as usize, lane as usize);
            exchange.counts[slot].0[lane] = weight.counts * weight.volume;
            exchange.lift[slot].0[lane] = self.lift[k];
            exchange.drag[slot].0[lane] = drag;
            fast[slot].0[lane] = drag * (quite * self.step / bed.mass[k]);
        }
        let pass = self.pass_over(&exchange);
        // Sums with the very weights of the steps to come.
        let [mut inverse, mut loose, fast] =
            pass.sums_of([&exchange.counts, &exchange.drag, &fast]);
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
        let mut grip = std::mem::take(&mut exchange.grip);
        self.pass_over(&exchange)
            .found(&self.frozen.ease, &mut grip);
        exchange.grip = grip;
        self.exchange = exchange;
    }

    /// Weights, porosity and permeability anew; contents stay.
    pub(super) fn renew(&mut self, bed: &dem::Bed) -> Result<(), Error> {
        let energy = self.books.kept.then(|| self.energy());
        self.weigh(bed)?;
        if self.is_open() {
            return Ok(());
        }
        let flux = match self.model.resistance.nonlinear() {
            true => self.flux(),
            false => vec![[0.0; 3]; self.lattice.count()],
        };
        let pores = self.bed_of_lbm(&flux);
        let Flow::Lattice(solver) = &mut self.flow else {
            return Ok(());
        };
        let kept = solver.set_thickness(self.lattice.height);
        if kept.and_then(|()| solver.set_bed(pores)).is_err() {
            // The bed has changed so much that this lattice does not fit it any more.
            let (between, flux) = (solver.time(), solver.snapshot().flux);
            self.lay(bed, between, Some(&flux))?;
            self.events.relaid += 1;
        }
        if let Some(energy) = energy {
            self.book_renewal(energy);
        }
        self.feel_anew();
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
pub(crate) fn volume(row: Row) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * row.w().powi(3)
}

/// Place of a grain in cells: from the origin along x and y, from the bottom along z.
fn in_cells(lattice: &Lattice, at: DVec3) -> [f64; 3] {
    let z = (at.z - lattice.bottom) / lattice.height;
    [at.x / lattice.spacing, at.y / lattice.spacing, z]
}

/// Call `each` with the first cell of every column that a grain reaches, and its share of the column.
#[inline(always)]
fn columns<const N: usize>(lattice: &Lattice, place: Place, mut each: impl FnMut(usize, f64)) {
    let [x, y] = [0, 1].map(|axis| shares::<N>(place.within[axis]).0);
    let near = |axis: usize, k: usize| {
        let at = (place.cell[axis] + k) as i64 - half_width(N) as i64;
        lattice.wrapped(axis, at)
    };
    let mut beside = [0; N];
    for j in 0..N {
        beside[j] = lattice.cell([0, near(1, j), 0]);
    }
    for i in 0..N {
        let plane = lattice.cell([near(0, i), 0, 0]);
        for j in 0..N {
            each(plane + beside[j], x[i] * y[j]);
        }
    }
}

/// Add a grain's volume to the cells.
fn deposit<const N: usize>(lattice: &Lattice, place: Place, volume: f64, solid: &mut [f64]) {
    let shares = shares::<N>(place.within[2]).0;
    let mut up = [0; N];
    for k in 0..N {
        let at = (place.cell[2] + k) as i64 - half_width(N) as i64;
        up[k] = folded_cell(at, lattice.cells[2]);
    }
    columns::<N>(lattice, place, |first, share| {
        for k in 0..N {
            solid[first + up[k]] += volume * share * shares[k];
        }
    });
}

/// Add twice the weights of a grain's images to the faces of normal z between the walls.
fn add_images<const N: usize>(
    lattice: &Lattice,
    place: Place,
    volume: f64,
    images: &mut [[f64; 2]],
) {
    let shares = shares::<N>(place.within[2]).1;
    for k in 0..N {
        let at = (place.cell[2] + k) as i64 - half_width(N) as i64;
        if let (face, Some(wall)) = folded_face(at, lattice.cells[2]) {
            let twice = 2.0 * volume * shares[k];
            columns::<N>(lattice, place, |first, share| {
                images[first + face][wall] += twice * share;
            });
        }
    }
}
