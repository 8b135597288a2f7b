//! Between moments or polynomials of cells and values at nodes: sums along one axis after the other.
//!
//! A kernel is a product of three, so that a node takes what cells have summed, and gives what
//! their grains evaluate, along x, y and z in turn: a few sums for each cell, however many grains
//! there are. Both ways are the same sums with rows and columns exchanged.
//!
//! Nodes stand on lines along z with ends for the images behind the walls, one row a node. In
//! between four cells stand side by side, and planes are repeated at both ends along y, so that four
//! cells at once find their neighbours at one distance.

use crate::kernel::{Kernel, folded_cell, folded_face, half_width};
use crate::lattice::Lattice;
use crate::terms::{COLUMNS, Moments, SHEETS, Sheets, Sum, along, column, sheet, term};
use dem::Row;
use dem::lanes::Lanes;

/// A plane of the lattice.
#[derive(Clone, Copy)]
pub(crate) struct Plane<const N: usize> {
    pub lattice: Lattice,
    pub plane: usize,
}

/// What is needed for the work on a plane, and is worth nothing afterwards.
pub(crate) struct Scratch<'a> {
    /// Sheets and columns: arrays of numbers.
    pub numbers: &'a mut [f64],
    /// Nodes, one line along z after the other.
    pub lines: &'a mut [Row],
}

impl<const N: usize> Plane<N> {
    /// Numbers and nodes of the scratch.
    pub fn needs(&self) -> [usize; 2] {
        let lines = self.lattice.cells[1] * self.line();
        [(SHEETS + COLUMNS) * self.width(), lines]
    }

    /// Place of the first cell in an array of the plane.
    fn front(&self) -> usize {
        (half_width(N) * self.lattice.cells[2]).next_multiple_of(4) + 4
    }
    fn width(&self) -> usize {
        2 * self.front() + 4 * self.lattice.groups()
    }
    /// Nodes of a line along z, with those behind the walls.
    pub fn line(&self) -> usize {
        self.lattice.cells[2] + 2 * half_width(N)
    }

    /// Repeat the columns at the ends of the arrays.
    #[inline(always)]
    fn repeat(&self, arrays: &mut [f64]) {
        let [_, ny, nz] = self.lattice.cells;
        let (front, reach) = (self.front(), half_width(N));
        let places = |column: i64| {
            let from = front + self.lattice.wrapped(1, column) * nz;
            (from, (front as i64 + column * nz as i64) as usize)
        };
        // Four numbers at a time: too many at first, which the next column mends.
        for array in arrays.chunks_exact_mut(self.width()) {
            for k in 0..reach {
                let (from, to) = places((ny + k) as i64);
                for at in (0..nz).step_by(4) {
                    let four = four(array, from + at);
                    array[to + at..to + at + 4].copy_from_slice(&four.0);
                }
                let (from, to) = places(-1 - k as i64);
                for at in (0..nz).step_by(4) {
                    let four = four(array, from + nz - at - 4);
                    array[to + nz - at - 4..to + nz - at].copy_from_slice(&four.0);
                }
            }
        }
    }

    /// The nodes of the plane take the moments of all cells around.
    #[inline(always)]
    pub fn take<V: Lanes>(&self, moments: &[Moments], scratch: Scratch, nodes: &mut [Row]) {
        let (sheets, columns) = scratch.numbers.split_at_mut(SHEETS * self.width());
        self.take_along_x::<V>(moments, sheets);
        self.repeat(sheets);
        self.take_along_y::<V, 0>(sheets, columns);
        self.take_along_y::<V, 1>(sheets, columns);
        self.take_along_y::<V, 2>(sheets, columns);
        self.take_along_z::<V>(columns, scratch.lines);
        self.fold(scratch.lines, nodes);
    }

    #[inline(always)]
    fn take_along_x<V: Lanes>(&self, moments: &[Moments], sheets: &mut [f64]) {
        let (groups, width) = (self.lattice.groups(), self.width());
        // Cells in the k-th plane before this one find it k-th behind them.
        let mut planes = [0; N];
        for k in 0..N {
            planes[k] = self.lattice.plane_near::<N>(self.plane, N - 1 - k);
        }
        for group in 0..groups {
            let mut near = [&moments[group]; N];
            for k in 0..N {
                near[k] = &moments[planes[k] * groups + group];
            }
            let at = self.front() + 4 * group;
            sum_along_x::<V, N, 0>(near, &mut sheets[at..], width);
            sum_along_x::<V, N, 1>(near, &mut sheets[at..], width);
            sum_along_x::<V, N, 2>(near, &mut sheets[at..], width);
        }
    }

    /// What the faces of one normal take of the columns around.
    #[inline(always)]
    fn take_along_y<V: Lanes, const NORMAL: usize>(&self, sheets: &[f64], columns: &mut [f64]) {
        let (width, nz) = (self.width(), self.lattice.cells[2]);
        for c in 0..along(NORMAL, 2) {
            let column = &mut columns[column(NORMAL, c) * width..][..width];
            let sheet = |b| &sheets[sheet(NORMAL, [b, c]) * width..][..width];
            let sheets = [sheet(0), sheet(1), sheet(along(NORMAL, 1) - 1)];
            for group in 0..self.lattice.groups() {
                let at = self.front() + 4 * group;
                let last = at + half_width(N) * nz;
                let mut sum = Sum::<V>::new();
                for b in 0..along(NORMAL, 1) {
                    for k in 0..N {
                        let weight = weights::<N>(NORMAL, 1, b)[k];
                        sum = sum.add(weight, &four(sheets[b], last - k * nz));
                    }
                }
                store(sum.total(), column, at);
            }
        }
    }

    #[inline(always)]
    fn take_along_z<V: Lanes>(&self, columns: &[f64], lines: &mut [Row]) {
        let (width, zero) = (self.width(), V::splat(0.0));
        lines.fill(Row::ZERO);
        for group in 0..self.lattice.groups() {
            let at = self.front() + 4 * group;
            let load = |normal, c| four(columns, column(normal, c) * width + at);
            let mut terms = [[zero; 4]; 3];
            for c in 0..3 {
                let x = V::load(&load(0, c));
                let y = V::load(&load(1, c));
                let z = if c < 2 { V::load(&load(2, c)) } else { zero };
                terms[c] = V::transpose([x, y, z, zero]);
            }
            for lane in 0..self.lattice.plane().saturating_sub(4 * group).min(4) {
                let first = self.first_node(4 * group + lane);
                let nodes = &mut lines[first..first + N];
                for k in 0..N {
                    let mut sum = V::load(&nodes[k]);
                    for c in 0..3 {
                        let weight = &Kernel::<N>::ALONG_Z[c][k];
                        if weight.0 != [0.0; 4] {
                            sum = V::load(weight).mul_add(terms[c][lane], sum);
                        }
                    }
                    sum.store(&mut nodes[k]);
                }
            }
        }
    }

    /// The first of the nodes that a cell of the plane reaches.
    #[inline(always)]
    fn first_node(&self, cell: usize) -> usize {
        let nz = self.lattice.cells[2];
        cell + (cell / nz) * (self.line() - nz)
    }

    /// What fell behind the walls is added to the nodes before them, of the opposite flux.
    #[inline(always)]
    fn fold(&self, lines: &[Row], nodes: &mut [Row]) {
        let (nz, reach) = (self.lattice.cells[2], half_width(N));
        let lines = lines.chunks_exact(self.line());
        for (nodes, line) in nodes.chunks_exact_mut(nz).zip(lines) {
            nodes.copy_from_slice(&line[reach..reach + nz]);
            for k in (0..reach).chain(reach + nz..line.len()) {
                let place = k as i64 - reach as i64;
                let node = &mut nodes[folded_cell(place, nz)].0;
                node[0] += line[k].0[0];
                node[1] += line[k].0[1];
                let (face, behind) = folded_face(place, nz);
                if behind.is_some() && face < nz {
                    nodes[face].0[2] -= line[k].0[2];
                }
            }
        }
    }

    /// What the nodes of the plane on the lines of the scratch give, summed along z and y.
    #[inline(always)]
    pub fn give<V: Lanes>(&self, scratch: Scratch, sheets: &mut [Sheets]) {
        let columns = &mut scratch.numbers[..COLUMNS * self.width()];
        self.give_along_z::<V>(scratch.lines, columns);
        self.repeat(columns);
        self.give_along_y::<V, 0>(columns, sheets);
        self.give_along_y::<V, 1>(columns, sheets);
        self.give_along_y::<V, 2>(columns, sheets);
    }

    /// Fill the ends of a line: what images of grains are pushed with.
    pub fn mirror(&self, line: &mut [Row]) {
        let (nz, reach) = (self.lattice.cells[2], half_width(N));
        line[reach].0[2] = 0.0;
        for k in (0..reach).chain(reach + nz..reach + nz + reach) {
            let place = k as i64 - reach as i64;
            let cell = line[reach + folded_cell(place, nz)].0;
            let (face, behind) = folded_face(place, nz);
            let across = match behind.is_some() && face < nz {
                true => -line[reach + face].0[2],
                false => 0.0,
            };
            line[k] = Row([cell[0], cell[1], across, 0.0]);
        }
    }

    #[inline(always)]
    fn give_along_z<V: Lanes>(&self, lines: &[Row], columns: &mut [f64]) {
        let (width, zero) = (self.width(), V::splat(0.0));
        let last = self.lattice.plane() - 1;
        for group in 0..self.lattice.groups() {
            let at = self.front() + 4 * group;
            let mut terms = [[zero; 4]; 3];
            for lane in 0..4 {
                // Lanes without a cell repeat the last one.
                let first = self.first_node((4 * group + lane).min(last));
                let nodes = &lines[first..first + N];
                for c in 0..3 {
                    for k in 0..N {
                        let weight = &Kernel::<N>::ALONG_Z[c][k];
                        if weight.0 != [0.0; 4] {
                            let node = V::load(&nodes[k]);
                            terms[c][lane] = V::load(weight).mul_add(node, terms[c][lane]);
                        }
                    }
                }
            }
            for c in 0..3 {
                let [x, y, z, _] = V::transpose(terms[c]);
                store(x, columns, column(0, c) * width + at);
                store(y, columns, column(1, c) * width + at);
                if c < 2 {
                    store(z, columns, column(2, c) * width + at);
                }
            }
        }
    }

    /// What the faces of one normal give to the columns around.
    #[inline(always)]
    fn give_along_y<V: Lanes, const NORMAL: usize>(&self, columns: &[f64], sheets: &mut [Sheets]) {
        let (width, nz) = (self.width(), self.lattice.cells[2]);
        for c in 0..along(NORMAL, 2) {
            let column = &columns[column(NORMAL, c) * width..][..width];
            for (group, sheets) in sheets.iter_mut().enumerate() {
                let first = self.front() + 4 * group - half_width(N) * nz;
                for b in 0..along(NORMAL, 1) {
                    let mut sum = Sum::<V>::new();
                    for k in 0..N {
                        let weight = weights::<N>(NORMAL, 1, b)[k];
                        sum = sum.add(weight, &four(column, first + k * nz));
                    }
                    sum.total().store(&mut sheets[sheet(NORMAL, [b, c])]);
                }
            }
        }
    }
}

/// What the faces of one normal take of a group and of those in the planes around.
#[inline(always)]
fn sum_along_x<V: Lanes, const N: usize, const NORMAL: usize>(
    near: [&Moments; N],
    sheets: &mut [f64],
    width: usize,
) {
    for b in 0..along(NORMAL, 1) {
        for c in 0..along(NORMAL, 2) {
            let mut sum = Sum::<V>::new();
            for a in 0..along(NORMAL, 0) {
                for k in 0..N {
                    let weight = weights::<N>(NORMAL, 0, a)[k];
                    sum = sum.add(weight, &near[k][term(NORMAL, [a, b, c])]);
                }
            }
            store(sum.total(), sheets, sheet(NORMAL, [b, c]) * width);
        }
    }
}

/// Weights of the nodes along an axis in a term of the faces of `normal`.
#[inline(always)]
const fn weights<const N: usize>(normal: usize, axis: usize, term: usize) -> [f64; N] {
    match normal == axis {
        true => Kernel::<N>::FACES[term],
        false => Kernel::<N>::CELLS[term],
    }
}

/// Four numbers that follow each other, anywhere.
#[inline(always)]
fn four(from: &[f64], at: usize) -> Row {
    debug_assert!(at + 4 <= from.len());
    // SAFETY: arrays have the widths that `Plane::needs` tells, which the kernels' callers keep to;
    // checked in builds with debug assertions.
    Row(unsafe { from.as_ptr().add(at).cast::<[f64; 4]>().read() })
}
#[inline(always)]
fn store<V: Lanes>(numbers: V, to: &mut [f64], at: usize) {
    debug_assert!(at + 4 <= to.len());
    let mut row = Row::ZERO;
    numbers.store(&mut row);
    // SAFETY: as above.
    unsafe { to.as_mut_ptr().add(at).cast::<[f64; 4]>().write(row.0) };
}
