//! Where cells and nodes lie in memory.
//!
//! Cells here run z fastest and x slowest, as the grains of `dem` do: so a stretch of grains meets
//! few planes, and threads share planes of x. `lbm` has x fastest. A node is the lower corner
//! of a cell, and stands for its three lower faces. Arrays to which grains reach are padded by the
//! reach of the kernel, and along x and y by one cell more, for grains that have left the box since
//! the last search.

use std::ops::Range;

/// The lattice of a bed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// Length of a cell along x and y [m].
    pub spacing: f64,
    /// Planes and columns of padding at each end, and nodes of it along z.
    pub pad: usize,
    pub pad_z: usize,
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

    /// Padded planes, and padded columns of a plane.
    pub fn padded(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.cells[axis] + 2 * self.pad)
    }

    /// Nodes of a padded column, and of a padded plane.
    pub fn padded_column(&self) -> usize {
        self.cells[2] + 2 * self.pad_z
    }
    pub fn padded_plane(&self) -> usize {
        self.padded()[1] * self.padded_column()
    }

    /// The padded place of a cell along axis 0 or 1 that may lie outside the box.
    pub fn padded_place(&self, axis: usize, at: i64) -> usize {
        let count = self.cells[axis] as i64;
        let pad = self.pad as i64;
        let place = at + pad;
        // Far outside: a grain that nothing has wrapped; its image inside does as well.
        let fits = place >= 0 && place < count + pad;
        (if fits {
            place
        } else {
            at.rem_euclid(count) + pad
        }) as usize
    }

    /// The cell along `axis` that a padded place stands for.
    pub fn unpadded(&self, axis: usize, padded: usize) -> usize {
        let count = self.cells[axis];
        (padded + count * self.pad - self.pad) % count
    }

    /// The padded places of cell `at` along `axis`.
    pub fn aliases(&self, axis: usize, at: usize) -> impl Iterator<Item = usize> + use<> {
        let lattice = *self;
        (0..self.padded()[axis]).filter(move |&place| lattice.unpadded(axis, place) == at)
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
