//! Scatter from grains to the faces of cells, and gather back: the hot loops over grains.
//!
//! A face's velocity is v_f = Σ a_if v_i with a_if = w_i V_i K_if / Σ w V K, and the force of the
//! pressure on a grain F_i = -Σ a_if A_f (p_right - p_left), with the same a_if. Weights are
//! frozen between renewals: what is kept for each grain is the first cell that it reaches, and
//! its place in the middle one, in single precision. Weights are made from it on the way, the same
//! ones in scatter and gather and in the sums by which they are divided, so that means stay exact;
//! the three faces of a node share a vector.
//!
//! Sums over grains are sums over parts of the bed whose number does not depend on that of the
//! threads: the bits do not either.

use crate::kernel::{Table, half_width, table};
use crate::lattice::Lattice;
use dem::{Row, Shared};
use std::ops::Range;

/// How one grain meets the lattice, until the next renewal.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Touch<const N: usize> {
    /// Padded place of the first node that it reaches.
    first: u32,
    /// Place in the middle one of its cells.
    within: [f32; 3],
    /// What it counts: w V [m³].
    pub volume: f64,
}

/// Drag of a loose grain to the mean [N s/m], and the part of it that faces along each axis take.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Loose {
    pub drag: f64,
    pub grip: [f64; 4],
}

impl<const N: usize> Touch<N> {
    /// Of a grain at `at` cells along x, y, and z from the bottom.
    pub fn new(lattice: &Lattice, at: [f64; 3], volume: f64) -> Self {
        let (cell, within) = middle(lattice, at);
        let m = half_width(N) as i64;
        let plane = lattice.padded_place(0, cell[0]) as i64 - m;
        let column = lattice.padded_place(1, cell[1]) as i64 - m;
        let node = cell[2] + lattice.pad_z as i64 - m;
        let (planes, columns) = (
            lattice.padded_plane() as i64,
            lattice.padded_column() as i64,
        );
        Self {
            first: (plane * planes + column * columns + node) as u32,
            within: within.map(|t| t as f32),
            volume,
        }
    }

    /// The padded planes that it reaches.
    pub fn planes(&self, lattice: &Lattice) -> Range<usize> {
        let first = self.first as usize / lattice.padded_plane();
        first..first + N
    }

    /// Weights along x, y, z of the faces of normal x, y, z, and zero.
    #[inline(always)]
    fn rows(&self, table: &Table<N>) -> [[[f64; 4]; N]; 3] {
        let mut rows = [[[0.0; 4]; N]; 3];
        for axis in 0..3 {
            let t = f64::from(self.within[axis]);
            for k in 0..N {
                let [a, b, c] = &table[axis][k];
                for lane in 0..4 {
                    rows[axis][k][lane] = a[lane] + t * (b[lane] + t * c[lane]);
                }
            }
        }
        rows
    }

    /// Add `what` times the weights to nodes, the fourth number times zero; `start`: padded place of the first of these.
    #[inline(always)]
    pub fn scatter(&self, layout: Layout<N>, what: [f64; 4], nodes: &mut [Row], start: usize) {
        let [x, y, z] = self.rows(layout.table);
        let first = self.first as usize - start;
        let most = first + (N - 1) * (layout.plane + layout.column) + N;
        assert!(most <= nodes.len(), "the grain lies on the lattice");
        for i in 0..N {
            let across = times(what, x[i]);
            for j in 0..N {
                let along = times(across, y[j]);
                let column = first + i * layout.plane + j * layout.column;
                // SAFETY: no node is behind the last one, which was looked at above.
                let column = unsafe { nodes.get_unchecked_mut(column..column + N) };
                for k in 0..N {
                    let add = times(along, z[k]);
                    let sum = &mut column[k].0;
                    for lane in 0..4 {
                        sum[lane] += add[lane];
                    }
                }
            }
        }
    }

    /// Sum of the nodes' values times the weights; the fourth number is zero. (Those who leave it
    /// away make the compiler leave vectors away.)
    #[inline(always)]
    pub fn gather(&self, layout: Layout<N>, nodes: &[Row]) -> [f64; 4] {
        let [x, y, z] = self.rows(layout.table);
        let first = self.first as usize;
        let most = first + (N - 1) * (layout.plane + layout.column) + N;
        assert!(most <= nodes.len(), "the grain lies on the lattice");
        let mut sum = [0.0; 4];
        for i in 0..N {
            let mut across = [0.0; 4];
            for j in 0..N {
                let column = first + i * layout.plane + j * layout.column;
                // SAFETY: no node is behind the last one, which was looked at above.
                let column = unsafe { nodes.get_unchecked(column..column + N) };
                let mut along = [0.0; 4];
                for k in 0..N {
                    let add = times(column[k].0, z[k]);
                    for lane in 0..4 {
                        along[lane] += add[lane];
                    }
                }
                let add = times(along, y[j]);
                for lane in 0..4 {
                    across[lane] += add[lane];
                }
            }
            let add = times(across, x[i]);
            for lane in 0..4 {
                sum[lane] += add[lane];
            }
        }
        sum
    }
}

/// Distances between planes and columns of padded nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout<'a, const N: usize> {
    pub plane: usize,
    pub column: usize,
    /// Of the kernel. Read from memory: where the compiler knows the numbers, it computes with
    /// them one by one instead of four at a time.
    pub table: &'a Table<N>,
}

impl<'a, const N: usize> Layout<'a, N> {
    pub fn of(lattice: &Lattice, table: &'a Table<N>) -> Self {
        Self {
            table,
            plane: lattice.padded_plane(),
            column: lattice.padded_column(),
        }
    }
}

/// The cell in which a grain is, and its place there; between the walls along z.
pub(crate) fn middle(lattice: &Lattice, at: [f64; 3]) -> ([i64; 3], [f64; 3]) {
    let mut cell = at.map(f64::floor);
    cell[2] = cell[2].clamp(0.0, lattice.cells[2] as f64 - 1.0);
    let within = [0, 1, 2].map(|axis| (at[axis] - cell[axis]).clamp(0.0, 1.0));
    (cell.map(|k| k as i64), within)
}

#[inline(always)]
fn times(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
}

/// A stretch of grains, and its own sums.
pub(crate) struct Part {
    pub grains: Range<usize>,
    /// The padded planes that its grains reach.
    pub planes: Range<usize>,
    /// Σ w V K v on the nodes of these.
    pub sums: Shared<Row>,
}

/// Grains in a part, at least, and the most parts.
const PART: usize = 256;
const PARTS: usize = 64;

/// All grains, and how they are shared out.
pub(crate) struct Exchange<const N: usize> {
    pub touches: Vec<Touch<N>>,
    pub table: Box<Table<N>>,
    /// For each of the touches, but needed seldom.
    pub loose: Vec<Loose>,
    pub parts: Vec<Part>,
    /// For each plane of cells the parts that reach it, with the padded plane.
    pub reached: Vec<Vec<(usize, usize)>>,
}

impl<const N: usize> Exchange<N> {
    /// Share out `touches`.
    pub fn new(lattice: &Lattice, touches: Vec<Touch<N>>, loose: Vec<Loose>) -> Self {
        let n = touches.len();
        let count = (n / PART).clamp(1, PARTS);
        let mut parts = Vec::with_capacity(count);
        for part in 0..count {
            let grains = n * part / count..n * (part + 1) / count;
            let reached = touches[grains.clone()]
                .iter()
                .map(|touch| touch.planes(lattice));
            let whole = reached.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
            let planes = whole.unwrap_or(0..0);
            let nodes = planes.len() * lattice.padded_plane();
            parts.push(Part {
                grains,
                planes,
                sums: Shared::new(vec![Row::ZERO; nodes]),
            });
        }
        let reached = (0..lattice.cells[0]).map(|plane| {
            let aliases = || lattice.aliases(0, plane);
            let all = parts.iter().enumerate();
            all.flat_map(|(k, part)| {
                let planes = part.planes.clone();
                aliases()
                    .filter(move |alias| planes.contains(alias))
                    .map(move |alias| (k, alias))
            })
            .collect()
        });
        let reached = reached.collect();
        Self {
            touches,
            table: Box::new(table()),
            loose,
            parts,
            reached,
        }
    }

    /// Scatter `what` of each grain of part `k` into the sums of the part.
    ///
    /// # Safety
    /// Nobody else touches the part.
    pub unsafe fn scatter(
        &self,
        lattice: &Lattice,
        k: usize,
        what: impl Fn(usize, &Touch<N>) -> [f64; 4],
    ) {
        // SAFETY: the caller's promise.
        unsafe { self.scatter_into(lattice, k, &self.parts[k].sums, what) }
    }

    /// The same into `sums`, one row for each node of the planes of the part.
    ///
    /// # Safety
    /// Nobody else touches these.
    pub unsafe fn scatter_into(
        &self,
        lattice: &Lattice,
        k: usize,
        sums: &Shared<Row>,
        what: impl Fn(usize, &Touch<N>) -> [f64; 4],
    ) {
        let part = &self.parts[k];
        let layout = Layout::of(lattice, &self.table);
        let start = part.planes.start * layout.plane;
        // SAFETY: the caller's promise.
        let sums = unsafe { sums.write(0..part.planes.len() * layout.plane) };
        let touches = &self.touches[part.grains.clone()];
        scatter_all(touches, part.grains.start, layout, sums, start, what);
    }
}

/// The loop over the grains of a part: `dem`'s vectors where the processor has them.
#[inline]
fn scatter_all<const N: usize>(
    touches: &[Touch<N>],
    first: usize,
    layout: Layout<N>,
    sums: &mut [Row],
    start: usize,
    what: impl Fn(usize, &Touch<N>) -> [f64; 4],
) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has them.
        return unsafe { scatter_avx2(touches, first, layout, sums, start, what) };
    }
    scatter_loop(touches, first, layout, sums, start, what);
}

#[inline(always)]
fn scatter_loop<const N: usize>(
    touches: &[Touch<N>],
    first: usize,
    layout: Layout<N>,
    sums: &mut [Row],
    start: usize,
    what: impl Fn(usize, &Touch<N>) -> [f64; 4],
) {
    sums.fill(Row::ZERO);
    for (k, touch) in touches.iter().enumerate() {
        touch.scatter(layout, what(first + k, touch), sums, start);
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn scatter_avx2<const N: usize>(
    touches: &[Touch<N>],
    first: usize,
    layout: Layout<N>,
    sums: &mut [Row],
    start: usize,
    what: impl Fn(usize, &Touch<N>) -> [f64; 4],
) {
    scatter_loop(touches, first, layout, sums, start, what);
}

/// Gather for each of `touches`, and hand on to `take`.
#[inline]
pub(crate) fn gather_all<const N: usize>(
    touches: &[Touch<N>],
    layout: Layout<N>,
    nodes: &[Row],
    take: impl FnMut(usize, &Touch<N>, [f64; 4]),
) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has them.
        return unsafe { gather_avx2(touches, layout, nodes, take) };
    }
    gather_loop(touches, layout, nodes, take);
}

#[inline(always)]
fn gather_loop<const N: usize>(
    touches: &[Touch<N>],
    layout: Layout<N>,
    nodes: &[Row],
    mut take: impl FnMut(usize, &Touch<N>, [f64; 4]),
) {
    for (k, touch) in touches.iter().enumerate() {
        take(k, touch, touch.gather(layout, nodes));
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn gather_avx2<const N: usize>(
    touches: &[Touch<N>],
    layout: Layout<N>,
    nodes: &[Row],
    take: impl FnMut(usize, &Touch<N>, [f64; 4]),
) {
    gather_loop(touches, layout, nodes, take);
}
