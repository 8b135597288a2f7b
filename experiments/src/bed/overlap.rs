//! The largest overlap of a bed, found without looking at all pairs.
//!
//! Grains are sorted into cubes by size and place: a grain of diameter d stands in a cube of
//! the next power of two above d. Then all that a grain can touch among grains of at least
//! its own size is in the 27 cubes around its centre, for each size of cube.

use super::Bed;
use glam::DVec3;
use std::cmp::Ordering;

/// How far two grains are inside of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Numbers of the two grains, from 0.
    pub grains: [usize; 2],
    /// Sum of the radii less the distance of the centres, over the smaller radius \[-\].
    pub ratio: f64,
}

impl Bed {
    /// The largest overlap; none if no two grains touch. Grains near a periodic side of
    /// `domain` meet the images of those at the other.
    pub fn largest_overlap(&self, domain: &dem::Domain) -> Option<Overlap> {
        let cubes = Cubes::of(&self.radius, self.wrapped(domain));
        let (low, high) = super::corners(&cubes.position);
        let margin = 2.0 * self.radius.iter().copied().fold(0.0, f64::max);
        let shifts = |side: usize| match domain.periodic[side] {
            true => vec![0.0, -domain.size[side], domain.size[side]],
            false => vec![0.0],
        };
        let [along_x, along_y] = [shifts(0), shifts(1)];
        let mut largest: Option<Overlap> = None;
        for (i, &place) in cubes.position.iter().enumerate() {
            for &x in &along_x {
                for &y in &along_y {
                    let image = place + DVec3::new(x, y, 0.0);
                    let far = image.cmplt(low - margin) | image.cmpgt(high + margin);
                    if far.any() {
                        continue;
                    }
                    for j in cubes.around(image, self.radius[i]) {
                        let [r, other] = [self.radius[i], self.radius[j]];
                        let depth = r + other - image.distance(cubes.position[j]);
                        let ratio = depth / r.min(other);
                        if i != j && ratio > largest.map_or(0.0, |found| found.ratio) {
                            let grains = [i.min(j), i.max(j)];
                            largest = Some(Overlap { grains, ratio });
                        }
                    }
                }
            }
        }
        largest
    }

    fn wrapped(&self, domain: &dem::Domain) -> Vec<DVec3> {
        let mut position = self.position.clone();
        for side in (0..2).filter(|&side| domain.periodic[side]) {
            for place in &mut position {
                place[side] = place[side].rem_euclid(domain.size[side]);
            }
        }
        position
    }
}

/// A cube: the exponent of its edge, and its place in units of the edge.
type Cube = (i32, [i64; 3]);

struct Cubes {
    position: Vec<DVec3>,
    /// Grains with their cube, sorted by it.
    sorted: Vec<(Cube, usize)>,
    /// Exponents that occur, in ascending order.
    exponents: Vec<i32>,
}

impl Cubes {
    fn of(radius: &[f64], position: Vec<DVec3>) -> Self {
        let cubes = position.iter().zip(radius);
        let cubes = cubes.map(|(&place, &r)| (exponent(r), cube(place, exponent(r))));
        let mut sorted: Vec<_> = cubes.zip(0..).collect();
        sorted.sort_unstable();
        let mut exponents: Vec<i32> = sorted.iter().map(|&((e, _), _)| e).collect();
        exponents.dedup();
        Self {
            position,
            sorted,
            exponents,
        }
    }

    /// The grains in cubes around `place` that are no smaller than those of `radius`.
    fn around(&self, place: DVec3, radius: f64) -> impl Iterator<Item = usize> {
        let own = exponent(radius);
        let larger = self.exponents.iter().filter(move |&&e| e >= own);
        larger.flat_map(move |&e| {
            let [x, y, z] = cube(place, e);
            (x - 1..=x + 1).flat_map(move |x| {
                (y - 1..=y + 1).flat_map(move |y| {
                    // Three cubes one above the other are neighbours in the sorted list.
                    let [first, last] = [(e, [x, y, z - 1]), (e, [x, y, z + 1])];
                    let begin = self
                        .sorted
                        .partition_point(|(c, _)| c.cmp(&first) == Ordering::Less);
                    let column = self.sorted[begin..].iter();
                    column.take_while(move |(c, _)| *c <= last).map(|&(_, j)| j)
                })
            })
        })
    }
}

/// Exponent of the smallest power of two that is no less than the diameter.
fn exponent(radius: f64) -> i32 {
    (2.0 * radius).log2().ceil() as i32
}

fn cube(place: DVec3, exponent: i32) -> [i64; 3] {
    let edge = 2f64.powi(exponent);
    // Far below the largest i64, so that a neighbour has a number too.
    let along = |x: f64| (x / edge).floor().clamp(-1e15, 1e15) as i64;
    place.to_array().map(along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dem::Domain;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// All pairs, each at the shortest distance of its images.
    fn of_all_pairs(bed: &Bed, domain: &Domain) -> Option<Overlap> {
        let mut largest: Option<Overlap> = None;
        for j in 0..bed.len() {
            for i in 0..j {
                let mut apart = bed.position[j] - bed.position[i];
                for side in (0..2).filter(|&side| domain.periodic[side]) {
                    let length = domain.size[side];
                    apart[side] -= length * (apart[side] / length).round();
                }
                let [r, other] = [bed.radius[i], bed.radius[j]];
                let ratio = (r + other - apart.length()) / r.min(other);
                if ratio > largest.map_or(0.0, |found| found.ratio) {
                    let grains = [i, j];
                    largest = Some(Overlap { grains, ratio });
                }
            }
        }
        largest
    }

    #[test]
    fn the_search_finds_what_all_pairs_give() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        // From a few grains, which hardly touch, to many.
        for count in [2, 5, 10, 20, 40, 80, 160] {
            for periodic in [[false, false], [true, false], [true, true]] {
                let size = [2.0, 3.0];
                let mut bed = Bed::default();
                for _ in 0..count {
                    let [x, y, z] = [2.0, 3.0, 2.5].map(|l| l * random.random::<f64>());
                    bed.position.push(DVec3::new(x, y, z - 1.0));
                    bed.radius.push(0.03 * 10f64.powf(random.random::<f64>()));
                }
                let domain = Domain { size, periodic };
                let [found, expected] = [bed.largest_overlap(&domain), of_all_pairs(&bed, &domain)];
                assert_eq!(found.map(|o| o.grains), expected.map(|o| o.grains));
                let apart = found.map_or(0.0, |o| o.ratio) - expected.map_or(0.0, |o| o.ratio);
                assert!(apart.abs() < 1e-12, "{found:?}, {expected:?}");
            }
        }
    }

    #[test]
    fn images_across_a_periodic_side_overlap() {
        let bed = Bed {
            position: vec![DVec3::new(0.1, 0.5, 0.5), DVec3::new(3.9, 0.5, 0.5)],
            radius: vec![0.2, 0.1],
            ..Bed::default()
        };
        let size = [4.0, 4.0];
        let walled = Domain {
            size,
            periodic: [false, true],
        };
        assert_eq!(bed.largest_overlap(&walled), None);
        let open = Domain {
            size,
            periodic: [true, true],
        };
        let found = bed.largest_overlap(&open).unwrap();
        assert_eq!(found.grains, [0, 1]);
        // 0.3 m of radii, 0.2 m apart.
        assert!((found.ratio - 1.0).abs() < 1e-12, "{found:?}");
    }
}
