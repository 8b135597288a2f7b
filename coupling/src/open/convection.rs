//! How much is left out by leaving out convection of momentum.
//!
//! The equations have no ρ u·∇u. What it would be with the velocities that were found is measured
//! beside the drag, both per volume of bed, as root mean squares over all cells and all renewals:
//!
//! > C = √(Σ |φ ρ u·∇u|² / Σ |φ R q|²).
//!
//! It does not tell what a wake behind a single grain does, which drag laws contain, but what those
//! of many grains, jets and rolls longer than a cell would.

use super::{Open, neighbours, porosity};
use crate::lattice::Lattice;

/// Sums of squares over cells and renewals [N²/m⁶].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Convection {
    left_out: f64,
    drag: f64,
}

impl Convection {
    /// What is left out, over the drag; none where nothing has moved yet.
    pub fn share(&self) -> Option<f64> {
        (self.drag > 0.0).then(|| (self.left_out / self.drag).sqrt())
    }
}

impl Open {
    /// Look at the flow as it is.
    pub(super) fn see_convection(&mut self, lattice: &Lattice) {
        let [nx, ny, nz] = lattice.cells;
        let mean: Vec<[f64; 3]> = (0..lattice.count())
            .map(|cell| {
                let mut mean = [0.0; 3];
                for (axis, (lower, upper)) in neighbours(lattice, cell).into_iter().enumerate() {
                    mean[axis] = 0.5 * (self.velocity[lower][axis] + self.velocity[upper][axis]);
                }
                mean
            })
            .collect();
        for i in 0..nx {
            for j in 0..ny {
                for k in 0..nz {
                    let cell = lattice.cell([i, j, k]);
                    // Central differences; towards a wall, one-sided ones.
                    let (below, above) = (k.max(1) - 1, (k + 1).min(nz - 1));
                    let beside = [
                        (
                            lattice.cell([lattice.last(0, i), j, k]),
                            lattice.cell([lattice.next(0, i), j, k]),
                            2.0 * lattice.spacing,
                        ),
                        (
                            lattice.cell([i, lattice.last(1, j), k]),
                            lattice.cell([i, lattice.next(1, j), k]),
                            2.0 * lattice.spacing,
                        ),
                        (
                            lattice.cell([i, j, below]),
                            lattice.cell([i, j, above]),
                            (above - below) as f64 * lattice.height,
                        ),
                    ];
                    let share = &self.shares[neighbours(lattice, cell)[2].0][2];
                    let weight = porosity(share) * self.fluid.density;
                    for axis in 0..3 {
                        let each = beside.iter().enumerate().map(|(b, (from, to, way))| {
                            mean[cell][b] * (mean[*to][axis] - mean[*from][axis]) / way
                        });
                        let left_out = weight * each.sum::<f64>();
                        self.convection.left_out += left_out * left_out;
                    }
                }
            }
        }
        for (shares, flux) in self.shares.iter().zip(&self.flux) {
            for (share, flux) in shares.iter().zip(flux) {
                let resistance = share.resistance(&self.resistance, &self.fluid, flux.abs());
                self.convection.drag += (porosity(share) * resistance * flux).powi(2);
            }
        }
    }

    /// Convection of momentum, which is left out, over the drag, so far: root mean squares.
    pub fn left_out(&self) -> Option<f64> {
        self.convection.share()
    }
}
