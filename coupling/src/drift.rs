//! How far the solid in the cells has drifted from what flowed into them.
//!
//! Faces move with the grains that carry load, and the solid that such a flow brings to a cell is
//! Σ V K/Δ v_f A_f over its faces, with all grains in Σ V K. Where every grain counted the same this
//! would be, identically, what is found there at the next renewal. Loose grains go their own way: the
//! difference, summed since the water joined, is room that the water has not been told of. Over all
//! cells it is zero.
//!
//! It is watched at renewals, by the ways that grains have made in between, where the grains keep a
//! ledger. It is not fed back: in shear at 1 /s it grows by 0.03 of strain, and a bed of 1e-12 m² to
//! which it was told within 50 ms (a source of water, E over that time) had the strength and the
//! pressure of one to which it was not, to 0.1 %. Faster, it would let pressure leak past loose
//! grains, which is what their weight is for.

use crate::Water;
use crate::lattice::Lattice;
use crate::water::volume;
use dem::{Bed, Row};
use glam::DVec3;

/// The drift, and what the grains were like at the last renewal.
#[derive(Default)]
pub(crate) struct Drift {
    /// Solid found less solid that flowed there [m³], one entry a cell.
    volume: Vec<f64>,
    /// Grains in the order of that time: identity, place [m], and volume [m³].
    marks: Vec<(u32, DVec3, f64)>,
    /// The lattice then.
    lattice: Option<Lattice>,
}

impl Drift {
    /// Root of the mean square over the cells, as a solid fraction; none where it is not watched.
    pub fn rms(&self) -> Option<f64> {
        let lattice = self.lattice?;
        let squares: f64 = self.volume.iter().map(|v| v * v).sum();
        Some((squares / lattice.count() as f64).sqrt() / lattice.volume())
    }
}

impl<const N: usize> Water<N> {
    /// The lattice is where it will be; weights and solid are still those of the last renewal.
    pub(crate) fn drift_from(&mut self, bed: &Bed) {
        let Some(before) = self.drift.lattice else {
            return;
        };
        let lattice = &self.lattice;
        let mut place = vec![0; bed.id.len()];
        for (k, &id) in bed.id.iter().enumerate() {
            place[id as usize] = k;
        }
        // Ways in cells, in which the walls stand still.
        let height = |lattice: &Lattice, z: f64| (z - lattice.bottom) / lattice.height;
        let ways: Vec<Row> = (self.drift.marks.iter())
            .map(|&(id, mark, _)| {
                let now = bed.position[place[id as usize]].xyz();
                let way = bed.model.domain.nearest_image(now - mark) / lattice.spacing;
                let up = height(lattice, now.z) - height(&before, mark.z);
                Row([way.x, way.y, up, 0.0])
            })
            .collect();
        let mut volumes = vec![Row::ZERO; self.exchange.slots.len()];
        for (&(slot, lane), &(_, _, volume)) in self.exchange.at.iter().zip(&self.drift.marks) {
            volumes[slot as usize].0[lane as usize] = volume;
        }
        let [all] = self.pass().sums_of([&volumes]);
        let flow = self.pass().flow_of(&self.exchange.counts, &ways);
        // Solid that has passed the lower faces of a cell; none passes a wall.
        let passed = |cell: usize| {
            let mean = self.frozen.inverse[cell].0;
            let walls = self.frozen.walls.get(cell).map_or(0.0, |w| w[0] + w[1]);
            let up = match cell % lattice.cells[2] {
                0 => 0.0,
                _ => all[cell].0[2] / (1.0 - walls) * mean[2] * flow[cell].0[2],
            };
            [
                all[cell].0[0] * mean[0] * flow[cell].0[0],
                all[cell].0[1] * mean[1] * flow[cell].0[1],
                up,
            ]
        };
        let [nx, ny, nz] = lattice.cells;
        for i in 0..nx {
            for j in 0..ny {
                for k in 0..nz {
                    let cell = lattice.cell([i, j, k]);
                    let [x, y, z] = passed(cell);
                    let behind = passed(lattice.cell([lattice.next(0, i), j, k]))[0];
                    let beside = passed(lattice.cell([i, lattice.next(1, j), k]))[1];
                    let above = if k + 1 < nz { passed(cell + 1)[2] } else { 0.0 };
                    let brought = (x - behind) + (y - beside) + (z - above);
                    self.drift.volume[cell] -= self.solid[cell] + brought;
                }
            }
        }
    }

    /// The solid has been laid anew.
    pub(crate) fn drift_to(&mut self, bed: &Bed) {
        if !self.books.kept || self.is_open() {
            return;
        }
        let drift = &mut self.drift;
        match drift.lattice {
            Some(_) => {
                for (volume, solid) in drift.volume.iter_mut().zip(&self.solid) {
                    *volume += solid;
                }
            }
            None => drift.volume = vec![0.0; self.lattice.count()],
        }
        drift.lattice = Some(self.lattice);
        drift.marks.clear();
        let each = bed.id.iter().zip(bed.position);
        drift
            .marks
            .extend(each.map(|(&id, &at)| (id, at.xyz(), volume(at))));
    }
}
