//! Positions in fixed point: the unit that a scene needs, and the way there and back.
//!
//! A coordinate is a [`Wide`] number of units, one power of two for all axes. Overlaps of
//! grains come out with an error of about 2^-23 unit, wherever in the box they are.
//! Twin: shaders/dem/fixed.wgsl, which carries the formulas.

use super::wide::Wide;
use crate::{Domain, Error};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, IVec3, UVec3};

/// Coordinates stay below this many units.
const EXTENT: f64 = Wide::MOST;
/// The largest sum of radii, with the skin, stays below this many units ...
const REACH: f64 = 8_388_608.0;
/// ... and takes at least so many: overlaps of a millionth of it then keep four digits.
const LEAST_REACH: f64 = 4096.0;

/// Centre and radius of a grain, as the kernels read them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Place {
    /// High words of the centre.
    pub hi: [i32; 3],
    /// Radius in units: this and `radius_lo`.
    pub radius_hi: i32,
    /// Low words of the centre.
    pub lo: [u32; 3],
    /// What is missing in `radius_hi`, in [-1/2, 1/2).
    pub radius_lo: f32,
}

/// The unit of length [m]: the smallest power of two of which `extent` [m], the largest
/// coordinate, has fewer than 2^30, and `reach` [m], the largest sum of radii and skin,
/// fewer than 2^23.
///
/// # Errors
/// [`Error::Invalid`] where the box is so large against the grains that no unit suits both.
pub fn unit(extent: f64, reach: f64) -> Result<f64, Error> {
    let least = (extent / EXTENT).max(reach / REACH);
    // A maximum forgets what is not a number.
    let numbers = extent.is_finite() && reach.is_finite();
    if !numbers || extent < 0.0 || reach <= 0.0 || !(1e-30..1e30).contains(&least) {
        return Err(Error::Invalid(format!(
            "no grid for a box of {extent} m and grains that reach {reach} m: both must be \
             positive numbers"
        )));
    }
    let mut unit = least.log2().floor().exp2();
    while unit <= least {
        unit *= 2.0;
    }
    if reach < LEAST_REACH * unit {
        return Err(Error::Invalid(format!(
            "coordinates up to {extent} m are too large for grains of {:.1e} m in diameter on the \
             GPU, which takes up to {:.0} diameters: shorten the box, or use the CPU",
            reach,
            EXTENT / LEAST_REACH / 2.0
        )));
    }
    Ok(unit)
}

/// The grid of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Unit of length [m], a power of two.
    pub unit: f64,
    /// Lengths of the box in units, 0 along axes that are not periodic.
    pub length: IVec3,
}

impl Grid {
    /// The grid for coordinates up to `extent` [m] and grains that reach `reach` [m]. Periodic
    /// lengths become whole units ([`Grid::domain`]).
    ///
    /// # Errors
    /// As [`unit`].
    pub fn new(domain: &Domain, extent: f64, reach: f64) -> Result<Self, Error> {
        let longest = domain.size[0].max(domain.size[1]).max(extent);
        let unit = unit(longest, reach)?;
        let length = |axis: usize| match domain.periodic[axis] {
            true => (domain.size[axis] / unit).round() as i32,
            false => 0,
        };
        Ok(Self {
            unit,
            length: IVec3::new(length(0), length(1), 0),
        })
    }

    /// `domain` with periodic lengths of whole units: they change by half a unit at most.
    pub fn domain(&self, domain: &Domain) -> Domain {
        let mut whole = *domain;
        for axis in (0..2).filter(|&axis| domain.periodic[axis]) {
            whole.size[axis] = f64::from(self.length[axis]) * self.unit;
        }
        whole
    }

    /// A coordinate [m] in units, to the nearest part.
    ///
    /// # Errors
    /// [`Error::Invalid`] where it lies outside of what the grid covers.
    pub fn coordinate(&self, x: f64) -> Result<Wide, Error> {
        Wide::widen(x / self.unit).ok_or_else(|| {
            Error::Invalid(format!(
                "coordinate {x} m lies outside of the {:.3e} m that the GPU's grid covers on each \
                 side of the origin: use the CPU",
                EXTENT * self.unit
            ))
        })
    }

    /// A coordinate back in m, rounded to f64.
    pub fn metres(&self, x: Wide) -> f64 {
        x.units() * self.unit
    }

    /// A grain at `centre` [m] with `radius` [m], moved into the box along periodic axes.
    ///
    /// # Errors
    /// As [`Grid::coordinate`].
    pub fn place(&self, centre: DVec3, radius: f64) -> Result<Place, Error> {
        let (radius_hi, radius_lo) = self.radius(radius);
        let mut place = Place {
            radius_hi,
            radius_lo,
            ..Place::default()
        };
        for axis in 0..3 {
            let x = self.coordinate(centre[axis])?;
            place.lo[axis] = x.lo;
            place.hi[axis] = match self.length[axis] {
                0 => x.hi,
                length => x.hi.rem_euclid(length),
            };
        }
        Ok(place)
    }

    /// Centre of a grain [m].
    pub fn centre(&self, place: &Place) -> DVec3 {
        self.vector(place.hi.into(), place.lo.into())
    }

    /// Three two-word numbers of units as a vector [m].
    pub fn vector(&self, hi: IVec3, lo: UVec3) -> DVec3 {
        let along = |axis: usize| {
            self.metres(Wide {
                hi: hi[axis],
                lo: lo[axis],
            })
        };
        DVec3::new(along(0), along(1), along(2))
    }

    /// A radius or another reach [m] as whole units and a rest in [-1/2, 1/2).
    pub fn radius(&self, radius: f64) -> (i32, f32) {
        let units = radius / self.unit;
        let whole = (units + 0.5).floor();
        let rest = (units - whole) as f32;
        // In f32 the rest can round up to one half.
        match rest < 0.5 {
            true => (whole as i32, rest),
            false => (whole as i32 + 1, -0.5),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Domain = Domain {
        size: [0.5, 0.3],
        periodic: [true, false],
    };

    #[test]
    fn the_unit_is_the_smallest_power_of_two_that_serves_both() {
        // 0.021 m < 2^23 units: the grains decide; 50 m < 2^30 units: the box does.
        assert_eq!(unit(0.5, 0.021).unwrap(), 2f64.powi(-28));
        assert_eq!(unit(50.0, 0.021).unwrap(), 2f64.powi(-24));
        // "Fewer than": exactly 2^30 or 2^23 units are too many.
        assert_eq!(unit(1.0, 1e-3).unwrap(), 2f64.powi(-29));
        assert_eq!(unit(1e-3, 2f64.powi(-10)).unwrap(), 2f64.powi(-32));
    }

    #[test]
    fn a_box_too_large_for_its_grains_is_refused_with_the_remedy() {
        let wrong = unit(1e4, 1e-3).unwrap_err().to_string();
        assert!(wrong.contains("shorten the box, or use the CPU"), "{wrong}");
        for (extent, reach) in [
            (f64::NAN, 1.0),
            (1.0, f64::NAN),
            (0.0, 0.0),
            (f64::INFINITY, 1.0),
        ] {
            assert!(unit(extent, reach).is_err(), "{extent} m, {reach} m");
        }
    }

    #[test]
    fn coordinates_go_there_and_back() {
        let grid = Grid::new(&BOX, 0.4, 0.021).unwrap();
        for k in 0..10_000 {
            let x = (f64::from(k) * 0.618_033_988_749).fract() * 0.3;
            let back = grid.metres(grid.coordinate(x).unwrap());
            assert!((back - x).abs() <= grid.unit * 2f64.powi(-33) + x * f64::EPSILON / 2.0);
            // What came from the grid stays where it is, unless f64 has no room for its digits.
            assert_eq!(grid.metres(grid.coordinate(back).unwrap()), back);
            let (hi, lo) = grid.radius(x);
            let radius = (f64::from(hi) + f64::from(lo)) * grid.unit;
            assert!((radius - x).abs() <= grid.unit * 2f64.powi(-26) + x * f64::EPSILON);
            assert!((-0.5..0.5).contains(&lo));
        }
    }

    #[test]
    fn grains_outside_of_a_periodic_side_are_moved_in() {
        let grid = Grid::new(&BOX, 0.4, 0.021).unwrap();
        let length = grid.domain(&BOX).size[0];
        assert!((length - 0.5).abs() <= grid.unit / 2.0);
        let place = grid.place(DVec3::new(-0.1, -0.1, 0.1), 0.01).unwrap();
        let centre = grid.centre(&place);
        assert!(centre.distance(DVec3::new(length - 0.1, -0.1, 0.1)) < 1e-15);
        let place = grid.place(DVec3::new(length, 0.0, 0.0), 0.01).unwrap();
        assert_eq!(grid.centre(&place).x, 0.0);
    }

    #[test]
    fn a_coordinate_off_the_grid_is_refused_with_the_remedy() {
        let grid = Grid::new(&BOX, 0.4, 0.021).unwrap();
        let wrong = grid.coordinate(1e6).unwrap_err().to_string();
        assert!(
            wrong.contains("1000000 m") && wrong.contains("use the CPU"),
            "{wrong}"
        );
        assert!(grid.place(DVec3::new(0.0, 0.0, f64::NAN), 0.01).is_err());
    }
}
