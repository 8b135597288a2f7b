//! How the solid is shared out among the faces.
//!
//! A face's solid fraction Σ V K over the volume of a cell, K the weight by which its forces reach
//! the grains, is that around the grains *at* the face: each counts itself. In a packed bed that is
//! right, since each grain's volume is taken where no other can be; a single grain in clear water,
//! though, would be hindered by itself, by a tenth in cells of two diameters. The mean fraction
//! around a grain of a suspension exceeds the mean everywhere by own S₀, own = Σ (V K)²/Σ V K, for
//! the part 1 - S₀ of it is pushed away by the grain; S₀ is the structure factor of hard spheres at
//! long waves. So laws that hold from packed beds to single grains see the fraction less own S₀.
//!
//! Source: Carnahan and Starling (1969), J. Chem. Phys. 51, 635, for the pressure of hard spheres,
//! from which S₀ = (1-c)⁴/(1 + 4c + 4c² - 4c³ + c⁴).

use super::nodes;
use crate::Resistance;
use crate::exchange::Place;
use crate::kernel::{folded_cell, folded_face, half_width, shares};
use crate::lattice::Lattice;
use lbm::Fluid;

/// The solid at a face.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Share {
    /// Solid fraction.
    pub solid: f64,
    /// What a grain there counts of it for itself, in the mean.
    own: f64,
}

impl Share {
    /// R [Pa s/m²] at a flux [m/s]; nothing where no grain is.
    pub fn resistance(&self, law: &Resistance, fluid: &Fluid, flux: f64) -> f64 {
        let c = self.solid.clamp(0.0, 1.0 - super::POROSITY_LEAST);
        if c <= 0.0 {
            return 0.0;
        }
        let Resistance::DiFelice { .. } = law else {
            return law.at(fluid, 1.0 - c, flux);
        };
        // The drag of a grain among the others, times all that are there.
        let seen = (c - self.own * at_long_waves(c)).max(1e-6 * c);
        law.at(fluid, 1.0 - seen, flux) * c / seen
    }
}

/// Structure factor of hard spheres of this solid fraction at long waves.
fn at_long_waves(c: f64) -> f64 {
    (1.0 - c).powi(4) / (1.0 + c * (4.0 + c * (4.0 + c * (c - 4.0))))
}

/// The part of a grain in the solid of the half cell at a wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    /// Which of the grains.
    pub grain: u32,
    /// Which column, and is it the top?
    pub column: u32,
    pub side: u8,
    /// Of all the solid there.
    pub share: f64,
}

/// How all grains are shared out.
pub(crate) struct Shares {
    /// Among the faces.
    pub faces: Vec<[Share; 3]>,
    /// Among the half cells at the walls.
    pub ends: Vec<Part>,
}

/// Share out grains at these places, in cells, with their volumes [m³].
pub(crate) fn share<const N: usize>(
    lattice: &Lattice,
    grains: impl Iterator<Item = ([f64; 3], f64)>,
) -> Shares {
    let [nx, ny, nz] = lattice.cells;
    let m = half_width(N) as i64;
    let unit = 1.0 / lattice.volume();
    let mut sums = vec![[Share::default(); 3]; nodes(lattice)];
    let mut ends = Vec::new();
    for (grain, (at, volume)) in grains.enumerate() {
        let Place { cell, within } = Place::of(lattice, at);
        let cell = cell.map(|k| k as i64);
        let [x, y, z] = within.map(shares::<N>);
        let c = volume * unit;
        // Columns that are one and the same, in a narrow box, get one sum before it is squared.
        let mut seen: Vec<(usize, usize, f64)> = Vec::with_capacity(N * N * N);
        let mut add = |node: usize, axis: usize, weight: f64| match seen
            .iter_mut()
            .find(|entry| (entry.0, entry.1) == (node, axis))
        {
            Some(entry) => entry.2 += weight,
            None => seen.push((node, axis, weight)),
        };
        for i in 0..N {
            let plane = (cell[0] + i as i64 - m).rem_euclid(nx as i64) as usize;
            for j in 0..N {
                let column = (cell[1] + j as i64 - m).rem_euclid(ny as i64) as usize;
                let first = (plane * ny + column) * (nz + 1);
                for k in 0..N {
                    let up = cell[2] + k as i64 - m;
                    let (face, behind) = folded_face(up, nz);
                    let side = first + folded_cell(up, nz);
                    add(side, 0, x.1[i] * y.0[j] * z.0[k]);
                    add(side, 1, x.0[i] * y.1[j] * z.0[k]);
                    let sign = if behind.is_some() { -1.0 } else { 1.0 };
                    // Faces at walls stand for half a cell.
                    let part = if face == 0 || face == nz { 2.0 } else { 1.0 };
                    add(first + face, 2, part * sign * x.0[i] * y.0[j] * z.1[k]);
                }
            }
        }
        for (node, axis, weight) in seen {
            let share = &mut sums[node][axis];
            share.solid += c * weight;
            share.own += (c * weight).powi(2);
            let (column, k) = (node / (nz + 1), node % (nz + 1));
            if axis == 2 && (k == 0 || k == nz) {
                ends.push(Part {
                    grain: grain as u32,
                    column: column as u32,
                    side: u8::from(k > 0),
                    share: c * weight,
                });
            }
        }
    }
    for share in sums.as_flattened_mut() {
        share.own = if share.solid > 0.0 {
            share.own / share.solid
        } else {
            0.0
        };
    }
    for part in &mut ends {
        let node = part.column as usize * (nz + 1) + usize::from(part.side) * nz;
        part.share /= sums[node][2].solid.max(f64::MIN_POSITIVE);
    }
    Shares { faces: sums, ends }
}
