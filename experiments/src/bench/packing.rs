//! The bed that is sheared: 1000 grains settled under 100 kPa, repeated along x and y.
//!
//! `packing.csv` was made with LAMMPS for this purpose: radii 8 to 12 mm, mean 10 mm,
//! stiffness 1e9 N/m, periodic sides, solid fraction 0.62 between the planes.

use anyhow::{Context, Result, ensure};
use glam::DVec3;
use std::f64::consts::PI;

/// Sides of the packing in the file (m).
const SIDE: f64 = 0.2;
/// Height of the upper plane (m); the lower one is at 0.
pub const HEIGHT: f64 = 0.174_287_454_884_305;
/// Grains in the file.
const UNIT: usize = 1000;

/// A dense bed between two planes, periodic along x and y.
pub struct Packing {
    /// Lengths along x and y (m).
    pub size: [f64; 2],
    /// Centres (m).
    pub position: Vec<DVec3>,
    /// Radii (m).
    pub radius: Vec<f64>,
}

/// Can the packing be repeated to `grains`?
pub fn check_count(grains: usize) -> Result<()> {
    ensure!(
        grains > 0 && grains.is_multiple_of(UNIT),
        "--grains {grains}: the packing is made of blocks of {UNIT}; give a multiple of {UNIT}"
    );
    Ok(())
}

impl Packing {
    /// The packing of `grains` grains, a multiple of 1000, in as square a box as that allows.
    pub fn of(grains: usize) -> Self {
        let unit = read_unit(include_str!("packing.csv")).expect("packing.csv belongs to esker");
        let blocks = grains / UNIT;
        let ny = (1..=blocks.isqrt())
            .rev()
            .find(|n| blocks.is_multiple_of(*n))
            .unwrap_or(1);
        let nx = blocks / ny;
        let mut packing = Self {
            size: [SIDE * nx as f64, SIDE * ny as f64],
            position: Vec::with_capacity(grains),
            radius: Vec::with_capacity(grains),
        };
        for a in 0..nx {
            for b in 0..ny {
                let corner = DVec3::new(SIDE * a as f64, SIDE * b as f64, 0.0);
                let moved = unit.iter().map(|(position, _)| corner + *position);
                packing.position.extend(moved);
                packing.radius.extend(unit.iter().map(|(_, radius)| radius));
            }
        }
        packing
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// Volume of the grains over that between the planes.
    pub fn solid_fraction(&self) -> f64 {
        let grains: f64 = self.radius.iter().map(|r| 4.0 / 3.0 * PI * r.powi(3)).sum();
        grains / (self.size[0] * self.size[1] * HEIGHT)
    }
}

/// Centres and radii (m) of a table with the columns x, y, z, radius and one header line.
fn read_unit(text: &str) -> Result<Vec<(DVec3, f64)>> {
    let grain = |line: &str| {
        let values: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let [x, y, z, radius] = values
            .with_context(|| format!("not numbers: {line}"))?
            .try_into()
            .ok()
            .with_context(|| format!("not 4 columns: {line}"))?;
        Ok((DVec3::new(x, y, z), radius))
    };
    text.lines().skip(1).map(grain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_packing_fills_its_box_at_every_size() {
        for grains in [1000, 7000, 10_000] {
            let packing = Packing::of(grains);
            assert_eq!(packing.len(), grains);
            assert!((packing.solid_fraction() - 0.6186).abs() < 1e-4);
            let [lx, ly] = packing.size;
            let inside = |p: &DVec3| p.x >= 0.0 && p.x < lx && p.y >= 0.0 && p.y < ly;
            assert!(packing.position.iter().all(inside));
        }
    }

    #[test]
    fn a_box_is_as_square_as_the_count_allows() {
        let size = Packing::of(10_000).size;
        assert_eq!(size, [SIDE * 5.0, SIDE * 2.0]);
    }

    #[test]
    fn counts_that_are_no_multiple_are_refused() {
        assert!(check_count(1000).is_ok());
        assert!(check_count(0).is_err());
        assert!(check_count(1500).is_err());
    }
}
