//! A loose random start: spheres thrown in without overlap, the large ones first.

use glam::DVec3;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::collections::HashMap;

/// Solid fraction of the start where a scene says nothing. Random sequential addition of equal spheres jams at 0.38
/// (Widom 1966); well below it a place is found in a few tries.
pub const FRACTION: f64 = 0.25;

/// Tries for one grain before the whole is begun anew with more height.
const TRIES: usize = 2000;

/// Centres of spheres of these radii in `domain`, resting on nothing, above z = 0 [m], that fill
/// this fraction of the room up to the highest.
pub fn place(
    radius: &[f64],
    domain: &dem::Domain,
    fraction: f64,
    random: &mut ChaCha8Rng,
) -> Vec<DVec3> {
    let volume: f64 = radius
        .iter()
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum();
    let largest = radius.iter().copied().fold(0.0, f64::max);
    let mut height = volume / (fraction * domain.area()) + 2.0 * largest;
    loop {
        if let Some(position) = try_height(radius, domain, height, random) {
            return position;
        }
        height *= 1.2;
    }
}

fn try_height(
    radius: &[f64],
    domain: &dem::Domain,
    height: f64,
    random: &mut ChaCha8Rng,
) -> Option<Vec<DVec3>> {
    let mut order: Vec<usize> = (0..radius.len()).collect();
    order.sort_by(|&a, &b| radius[b].total_cmp(&radius[a]));
    let mut position = vec![DVec3::ZERO; radius.len()];
    let mut levels: Vec<Level> = Vec::new();
    for k in order {
        let r = radius[k];
        // Each level holds radii down to half its largest.
        if levels.last().is_none_or(|level| r < 0.5 * level.largest) {
            levels.push(Level::new(r, domain));
        }
        let place = (0..TRIES).find_map(|_| {
            let x = any(domain, 0, r, random);
            let y = any(domain, 1, r, random);
            let z = r + (height - 2.0 * r) * random.random::<f64>();
            let centre = DVec3::new(x, y, z);
            let free = |level: &Level| !level.overlaps(centre, r, &position, radius);
            levels.iter().all(free).then_some(centre)
        })?;
        position[k] = place;
        levels.last_mut().expect("pushed above").insert(k, place);
    }
    Some(position)
}

/// A coordinate along a side, off its walls.
fn any(domain: &dem::Domain, side: usize, r: f64, random: &mut ChaCha8Rng) -> f64 {
    let margin = if domain.periodic[side] { 0.0 } else { r };
    margin + (domain.size[side] - 2.0 * margin) * random.random::<f64>()
}

/// Grains of similar size in cells that are no smaller than the largest of them.
struct Level {
    largest: f64,
    domain: dem::Domain,
    cells: [i64; 2],
    grains: HashMap<[i64; 3], Vec<usize>>,
}

impl Level {
    fn new(largest: f64, domain: &dem::Domain) -> Self {
        let along = |k: usize| ((domain.size[k] / (2.0 * largest)) as i64).max(1);
        Self {
            largest,
            domain: *domain,
            cells: [along(0), along(1)],
            grains: HashMap::new(),
        }
    }

    fn cell(&self, at: DVec3) -> [i64; 3] {
        let along = |x: f64, k: usize| {
            let n = self.cells[k];
            ((x / self.domain.size[k] * n as f64) as i64).clamp(0, n - 1)
        };
        let z = (at.z / (2.0 * self.largest)) as i64;
        [along(at.x, 0), along(at.y, 1), z]
    }

    fn insert(&mut self, k: usize, at: DVec3) {
        let cell = self.cell(at);
        self.grains.entry(cell).or_default().push(k);
    }

    /// Does a sphere of radius `r`, at most this level's, overlap one of its grains?
    fn overlaps(&self, at: DVec3, r: f64, position: &[DVec3], radius: &[f64]) -> bool {
        let [x, y, z] = self.cell(at);
        let touches = |&k: &usize| {
            let reach = r + radius[k];
            self.separation(at - position[k]).length_squared() < reach * reach
        };
        self.around(x, 0).any(|x| {
            self.around(y, 1).any(|y| {
                (z - 1..=z + 1).any(|z| {
                    let cell = self.grains.get(&[x, y, z]);
                    cell.is_some_and(|grains| grains.iter().any(touches))
                })
            })
        })
    }

    /// The cells beside cell `c` along a side, each once.
    fn around(&self, c: i64, side: usize) -> impl Iterator<Item = i64> + use<> {
        let n = self.cells[side];
        let periodic = self.domain.periodic[side];
        let width = if n < 3 && periodic { n } else { 3 };
        (0..width)
            .map(move |k| c - 1 + k)
            .filter(move |c| periodic || (0..n).contains(c))
            .map(move |c| c.rem_euclid(n))
    }

    fn separation(&self, mut d: DVec3) -> DVec3 {
        for k in 0..2 {
            if self.domain.periodic[k] {
                d[k] -= self.domain.size[k] * (d[k] / self.domain.size[k]).round();
            }
        }
        d
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn check(radius: &[f64], size: [f64; 2], periodic: [bool; 2]) {
        let domain = dem::Domain { size, periodic };
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let position = place(radius, &domain, FRACTION, &mut random);
        for i in 0..radius.len() {
            let (p, r) = (position[i], radius[i]);
            assert!(p.z >= r);
            for k in 0..2 {
                let margin = if periodic[k] { 0.0 } else { r };
                assert!(p[k] >= margin && p[k] <= size[k] - margin);
            }
            for j in 0..i {
                let mut d = p - position[j];
                for k in 0..2 {
                    if periodic[k] {
                        d[k] -= size[k] * (d[k] / size[k]).round();
                    }
                }
                assert!(d.length() >= r + radius[j], "{i} overlaps {j}");
            }
        }
        let again = place(radius, &domain, FRACTION, &mut ChaCha8Rng::seed_from_u64(3));
        assert_eq!(position, again);
    }

    #[test]
    fn equal_grains_do_not_overlap() {
        check(&[0.5; 500], [7.3, 5.1], [true, true]);
        check(&[0.5; 500], [7.3, 5.1], [false, true]);
        check(&[0.5; 100], [2.0, 2.9], [true, false]);
    }

    #[test]
    fn radii_of_1_to_10_do_not_overlap() {
        let radius: Vec<f64> = (0..800)
            .map(|k| 0.1 * 10f64.powf(f64::from(k % 21) / 20.0))
            .collect();
        check(&radius, [6.0, 6.0], [true, true]);
        check(&radius, [6.0, 6.0], [false, false]);
    }
}
