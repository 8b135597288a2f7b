//! Where cells and nodes lie in memory.
//!
//! Cells here run z fastest and x slowest, as the grains of `dem` do: so a stretch of grains meets
//! few planes, and threads share planes of x. `lbm` has x fastest. A node is the lower corner
//! of a cell, and stands for its three lower faces. Four cells that follow each other in a plane are a
//! group: the hot loops take them at once, a lane each.

use crate::kernel::half_width;
use std::ops::Range;

/// The lattice of a bed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// Length of a cell along x and y [m].
    pub spacing: f64,
    /// Height of the bottom [m].
    pub bottom: f64,
    /// Height of a cell [m].
    pub height: f64,
}

impl Lattice {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Cells of a plane of x.
    pub fn plane(&self) -> usize {
        self.cells[1] * self.cells[2]
    }

    /// Cell at [i, j, k].
    pub fn cell(&self, [i, j, k]: [usize; 3]) -> usize {
        (i * self.cells[1] + j) * self.cells[2] + k
    }

    /// The same cell in the order of `lbm`.
    pub fn cell_of_lbm(&self, cell: usize) -> usize {
        let [nx, ny, nz] = self.cells;
        let (i, j, k) = (cell / (ny * nz), cell / nz % ny, cell % nz);
        (k * ny + j) * nx + i
    }

    /// Volume of a cell [m³].
    pub fn volume(&self) -> f64 {
        self.spacing * self.spacing * self.height
    }

    /// Area of the bed [m²].
    pub fn area(&self) -> f64 {
        self.spacing * self.spacing * (self.cells[0] * self.cells[1]) as f64
    }

    /// The cell that stands for place `at` of axis 0 or 1, which may lie outside the box.
    pub fn wrapped(&self, axis: usize, at: i64) -> usize {
        at.rem_euclid(self.cells[axis] as i64) as usize
    }

    /// The `k`-th of the planes that a kernel reaches from `plane`.
    pub fn plane_near<const N: usize>(&self, plane: usize, k: usize) -> usize {
        (plane + self.cells[0] * N + k - half_width(N)) % self.cells[0]
    }

    /// Groups of four cells in a plane; the last may be less than full.
    pub fn groups(&self) -> usize {
        self.plane().div_ceil(4)
    }

    /// The group of a cell of a plane, and its lane there.
    pub fn lane(&self, plane: usize, cell: usize) -> (usize, usize) {
        (plane * self.groups() + cell / 4, cell % 4)
    }

    /// Next and last cell along a periodic axis.
    pub fn next(&self, axis: usize, at: usize) -> usize {
        (at + 1) % self.cells[axis]
    }
    pub fn last(&self, axis: usize, at: usize) -> usize {
        (at + self.cells[axis] - 1) % self.cells[axis]
    }

    /// Cells of one plane.
    pub fn cells_of(&self, plane: usize) -> Range<usize> {
        plane * self.plane()..(plane + 1) * self.plane()
    }
}
