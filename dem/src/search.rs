//! Who is near whom: a uniform grid with sorted cell lists, and the list of near pairs.
//!
//! Cells are about as wide as a mean grain, whatever the largest is: each pair is found
//! from its larger grain, which looks as far as its own size demands. So a few large
//! grains among many small ones cost only the cells that they cover.
//! Order and pairs are functions of the positions and identities alone, so that a run
//! that was stopped and one that was not go on alike.

use crate::Domain;
use glam::DVec3;

/// The grid over the grains.
pub(crate) struct Grid {
    domain: Domain,
    origin: DVec3,
    /// Cells along x, y, z.
    cells: [usize; 3],
    /// Inverse width of a cell [1/m].
    inverse_width: DVec3,
    /// Grains of cell c are `start[c]..start[c + 1]` in sorted order.
    start: Vec<u32>,
}

/// Most cells for each grain; a bed that is sparser gets wider cells.
const CELLS_A_GRAIN: usize = 4;

impl Grid {
    /// Lay a grid over grains at `position` and return it with the order of the grains
    /// along its cells, x slowest and z fastest, ties broken by `id`.
    pub fn new(domain: Domain, position: &[DVec3], id: &[u32], width: f64) -> (Self, Vec<u32>) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &x in position {
            low = low.min(x);
            high = high.max(x);
        }
        for axis in 0..2 {
            if domain.periodic[axis] {
                low[axis] = 0.0;
                high[axis] = domain.size[axis];
            }
        }
        let extent = (high - low).max(DVec3::splat(f64::MIN_POSITIVE));
        let mut cells = [1usize; 3];
        let mut width = width;
        loop {
            for axis in 0..3 {
                cells[axis] = ((extent[axis] / width).floor() as usize).max(1);
            }
            let count = cells.iter().fold(1usize, |n, &c| n.saturating_mul(c));
            if count <= CELLS_A_GRAIN * position.len() + 64 {
                break;
            }
            width *= 1.26; // half as many cells
        }
        let counts = DVec3::new(cells[0] as f64, cells[1] as f64, cells[2] as f64);
        let mut grid = Self {
            domain,
            origin: low,
            cells,
            inverse_width: counts / extent,
            start: Vec::new(),
        };
        let order = grid.sort(position, id);
        (grid, order)
    }

    fn sort(&mut self, position: &[DVec3], id: &[u32]) -> Vec<u32> {
        let count = self.cells.iter().product::<usize>();
        let cell: Vec<u32> = position
            .iter()
            .map(|&x| self.index(self.locate(x)) as u32)
            .collect();
        let mut start = vec![0u32; count + 1];
        for &c in &cell {
            start[c as usize + 1] += 1;
        }
        for c in 0..count {
            start[c + 1] += start[c];
        }
        let mut next = start.clone();
        let mut order = vec![0u32; position.len()];
        for (k, &c) in cell.iter().enumerate() {
            order[next[c as usize] as usize] = k as u32;
            next[c as usize] += 1;
        }
        for c in 0..count {
            order[start[c] as usize..start[c + 1] as usize]
                .sort_unstable_by_key(|&k| id[k as usize]);
        }
        self.start = start;
        order
    }

    fn locate(&self, x: DVec3) -> [usize; 3] {
        let at = (x - self.origin) * self.inverse_width;
        let cell = |axis: usize| (at[axis].max(0.0) as usize).min(self.cells[axis] - 1);
        [cell(0), cell(1), cell(2)]
    }

    fn index(&self, cell: [usize; 3]) -> usize {
        (cell[0] * self.cells[1] + cell[1]) * self.cells[2] + cell[2]
    }

    /// Cells along `axis` that reach from `x - reach` to `x + reach`, each one once.
    fn range(&self, axis: usize, x: f64, reach: f64) -> impl Iterator<Item = usize> + use<> {
        let cells = self.cells[axis] as i64;
        let at = |x: f64| ((x - self.origin[axis]) * self.inverse_width[axis]).floor() as i64;
        let (first, last) = (at(x - reach), at(x + reach));
        let periodic = axis < 2 && self.domain.periodic[axis];
        let (first, count) = if periodic {
            (first, (last - first + 1).min(cells))
        } else {
            let first = first.clamp(0, cells - 1);
            (first, last.clamp(0, cells - 1) - first + 1)
        };
        (0..count).map(move |k| (first + k).rem_euclid(cells) as usize)
    }

    /// All pairs (a, b), a < b, of sorted grains whose surfaces are nearer than `skin`,
    /// sorted by a, then b. `position` and `radius` are in sorted order.
    pub fn near_pairs(&self, position: &[DVec3], radius: &[f64], skin: f64) -> Vec<[u32; 2]> {
        let mut pairs = Vec::with_capacity(4 * position.len());
        let mut count = vec![0u32; position.len() + 1];
        for i in 0..position.len() {
            let (x, r) = (position[i], radius[i]);
            let reach = 2.0 * r + skin;
            for cx in self.range(0, x.x, reach) {
                for cy in self.range(1, x.y, reach) {
                    for cz in self.range(2, x.z, reach) {
                        let c = self.index([cx, cy, cz]);
                        for j in self.start[c] as usize..self.start[c + 1] as usize {
                            // From the larger one; between equals from the earlier one.
                            if radius[j] > r || (radius[j] == r && j <= i) {
                                continue;
                            }
                            let near = r + radius[j] + skin;
                            let d = self.domain.nearest_image(x - position[j]);
                            if d.length_squared() < near * near {
                                let (a, b) = (i.min(j), i.max(j));
                                pairs.push([a as u32, b as u32]);
                                count[a + 1] += 1;
                            }
                        }
                    }
                }
            }
        }
        for a in 0..position.len() {
            count[a + 1] += count[a];
        }
        let mut sorted = vec![[0u32; 2]; pairs.len()];
        let mut next = count.clone();
        for pair in pairs {
            let slot = &mut next[pair[0] as usize];
            sorted[*slot as usize] = pair;
            *slot += 1;
        }
        for a in 0..position.len() {
            sorted[count[a] as usize..count[a + 1] as usize].sort_unstable();
        }
        sorted
    }
}

impl Domain {
    /// `x` brought back into the box along periodic sides.
    pub fn inside(&self, mut x: DVec3) -> DVec3 {
        for axis in 0..2 {
            if self.periodic[axis] {
                // A tiny negative number wraps to the length itself.
                let wrapped = x[axis].rem_euclid(self.size[axis]);
                x[axis] = if wrapped < self.size[axis] {
                    wrapped
                } else {
                    0.0
                };
            }
        }
        x
    }

    /// The shortest of the images of `d` along periodic sides.
    pub fn nearest_image(&self, mut d: DVec3) -> DVec3 {
        for axis in 0..2 {
            if self.periodic[axis] {
                let length = self.size[axis];
                d[axis] -= length * (d[axis] / length).round();
            }
        }
        d
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator is enough here: only a scatter of points is wanted.
    fn scatter(n: usize) -> (Vec<DVec3>, Vec<f64>) {
        let mut seed = 12345u64;
        let mut next = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let position = (0..n)
            .map(|_| DVec3::new(next(), 0.7 * next(), 0.5 * next()))
            .collect();
        let radius = (0..n).map(|_| 0.008 * 10f64.powf(next())).collect();
        (position, radius)
    }

    #[test]
    fn the_grid_finds_the_same_pairs_as_trying_all_of_them() {
        for periodic in [[true, true], [true, false], [false, false]] {
            let domain = Domain {
                size: [1.0, 0.7],
                periodic,
            };
            let (position, radius) = scatter(400);
            let id: Vec<u32> = (0..400).collect();
            let (grid, order) = Grid::new(domain, &position, &id, 0.05);
            let x: Vec<DVec3> = order.iter().map(|&k| position[k as usize]).collect();
            let r: Vec<f64> = order.iter().map(|&k| radius[k as usize]).collect();
            let found = grid.near_pairs(&x, &r, 0.01);
            let mut expected = Vec::new();
            for a in 0..400 {
                for b in a + 1..400 {
                    let d = domain.nearest_image(x[a] - x[b]).length();
                    if d < r[a] + r[b] + 0.01 {
                        expected.push([a as u32, b as u32]);
                    }
                }
            }
            assert!(expected.len() > 400);
            assert_eq!(found, expected);
        }
    }
}
