//! The beds that are sheared: units of 1000 grains that rest under 100 kPa between two planes,
//! periodic along x and y, repeated along both.
//!
//! `packing.csv`, radii 8 to 12 mm at a stiffness of 1e9 N/m, was made with LAMMPS for this
//! purpose. Grains of one size and with radii 1:10, at 1e7 N/m, rest where `esker run` of the
//! scenes `one_size.toml` and `log_normal.toml` in this folder left them; `table.py` makes a
//! table of that.

use anyhow::{Context, Result, ensure};
use glam::DVec3;
use std::f64::consts::PI;

/// Grains in a unit.
const UNIT: usize = 1000;
/// Grains whose centres are nearer to a plane than this belong to its held or driven layer, in
/// mean radii.
const LAYER: f64 = 1.3;

/// Which grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sizes {
    /// Radii 8 to 12 mm.
    Poster,
    /// Radii of 10 mm.
    One,
    /// Radii 9 to 96 mm, log-normal: median 29.4 mm, 0.5 the standard deviation of ln R.
    LogNormal,
}

impl Sizes {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Poster, Self::One, Self::LogNormal];

    /// Table of a unit, its sides along x and y (m), and the height of its upper plane (m) over
    /// the lower one at 0.
    fn unit(self) -> (&'static str, f64, f64) {
        match self {
            Self::Poster => (include_str!("packing.csv"), 0.2, 0.174_287_454_884_305),
            Self::One => (include_str!("one_size.csv"), 0.2, 0.177_745_134_326_443_1),
            Self::LogNormal => (
                include_str!("log_normal.csv"),
                0.75,
                0.746_093_226_795_914_2,
            ),
        }
    }
}

/// A dense bed between two planes, periodic along x and y.
pub struct Packing {
    /// Lengths along x and y (m).
    pub size: [f64; 2],
    /// Height of the upper plane over the lower one, which is at 0 (m).
    pub height: f64,
    /// Thickness of the held and of the driven layer (m).
    pub layer: f64,
    /// Centres (m).
    pub position: Vec<DVec3>,
    /// Radii (m).
    pub radius: Vec<f64>,
}

/// Can a unit be repeated to `grains`?
pub fn check_count(grains: usize) -> Result<()> {
    ensure!(
        grains > 0 && grains.is_multiple_of(UNIT),
        "--grains {grains}: the packing is made of blocks of {UNIT}; give a multiple of {UNIT}"
    );
    Ok(())
}

impl Packing {
    /// The packing of `grains` grains, a multiple of 1000, in as square a box as that allows.
    pub fn of(sizes: Sizes, grains: usize) -> Self {
        let (table, side, height) = sizes.unit();
        let unit = read_unit(table).expect("the tables belong to esker");
        let blocks = grains / UNIT;
        let ny = (1..=blocks.isqrt())
            .rev()
            .find(|n| blocks.is_multiple_of(*n))
            .unwrap_or(1);
        let nx = blocks / ny;
        let mut packing = Self {
            size: [side * nx as f64, side * ny as f64],
            height,
            layer: LAYER * unit.iter().map(|(_, radius)| radius).sum::<f64>() / UNIT as f64,
            position: Vec::with_capacity(grains),
            radius: Vec::with_capacity(grains),
        };
        for a in 0..nx {
            for b in 0..ny {
                let corner = DVec3::new(side * a as f64, side * b as f64, 0.0);
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
        grains / (self.size[0] * self.size[1] * self.height)
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
        for (sizes, fraction) in [
            (Sizes::Poster, 0.6186),
            (Sizes::One, 0.5892),
            (Sizes::LogNormal, 0.6373),
        ] {
            for grains in [1000, 7000, 10_000] {
                let packing = Packing::of(sizes, grains);
                assert_eq!(packing.len(), grains);
                let found = packing.solid_fraction();
                assert!((found - fraction).abs() < 1e-4, "{sizes:?}: {found}");
                let [lx, ly] = packing.size;
                let inside = |p: &DVec3| p.x >= 0.0 && p.x < lx && p.y >= 0.0 && p.y < ly;
                assert!(packing.position.iter().all(inside));
            }
        }
    }

    #[test]
    fn radii_span_what_their_names_tell() {
        let ratio = |sizes| {
            let radius = Packing::of(sizes, UNIT).radius;
            let largest = radius.iter().copied().fold(0.0, f64::max);
            largest / radius.iter().copied().fold(f64::INFINITY, f64::min)
        };
        assert_eq!(ratio(Sizes::One), 1.0);
        assert!((10.0..10.5).contains(&ratio(Sizes::LogNormal)));
    }

    /// No small grain sits inside a large one, and the beds are as dense as `log_normal.toml` and
    /// `one_size.toml` left them.
    #[test]
    fn grains_touch_and_no_more() {
        for (sizes, contacts) in [(Sizes::One, 2245), (Sizes::LogNormal, 1274)] {
            let Packing {
                size,
                position,
                radius,
                ..
            } = Packing::of(sizes, UNIT);
            let (mut found, mut deepest) = (0, 0.0_f64);
            for i in 0..UNIT {
                for j in 0..i {
                    let mut d = position[i] - position[j];
                    for axis in 0..2 {
                        d[axis] -= size[axis] * (d[axis] / size[axis]).round();
                    }
                    let overlap = radius[i] + radius[j] - d.length();
                    found += u32::from(overlap > 0.0);
                    deepest = deepest.max(overlap / radius[i].min(radius[j]));
                }
            }
            assert_eq!(found, contacts, "{sizes:?}");
            assert!(deepest < 0.025, "{sizes:?}: {deepest} of a radius");
        }
    }

    #[test]
    fn a_box_is_as_square_as_the_count_allows() {
        let size = Packing::of(Sizes::Poster, 10_000).size;
        assert_eq!(size, [1.0, 0.4]);
    }

    #[test]
    fn counts_that_are_no_multiple_are_refused() {
        assert!(check_count(1000).is_ok());
        assert!(check_count(0).is_err());
        assert!(check_count(1500).is_err());
    }
}
