//! Where cells lie: x fastest, then y, then z.

/// Places of the lattice. It closes on itself along each axis;
/// an axis with walls has one more layer, which is solid and lies behind both of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    /// Cells of the domain.
    pub cells: [usize; 3],
    /// Layers, those in walls included.
    pub extent: [usize; 3],
    /// From one row to the next; there is at least one place behind the last cell.
    pub stride: usize,
}

impl Grid {
    /// `walled`: is there a wall at the ends of this axis?
    pub fn new(cells: [usize; 3], walled: [bool; 3]) -> Self {
        let extent = [0, 1, 2].map(|axis| cells[axis] + usize::from(walled[axis]));
        // Rows begin where a vector does.
        let stride = (cells[0] + 1).next_multiple_of(8);
        Self {
            cells,
            extent,
            stride,
        }
    }

    /// Number of places.
    pub fn places(&self) -> usize {
        self.stride * self.extent[1] * self.extent[2]
    }

    /// Place of the cell at [x, y, z].
    pub fn place(&self, at: [usize; 3]) -> usize {
        self.row(at[1], at[2]) + at[0]
    }

    /// Place of the first cell of a row.
    pub fn row(&self, y: usize, z: usize) -> usize {
        (z * self.extent[1] + y) * self.stride
    }

    /// The neighbour along `c`, around the end of the lattice if there.
    pub fn neighbour(&self, at: [usize; 3], c: [i32; 3]) -> [usize; 3] {
        [0, 1, 2].map(|axis| shift(at[axis], c[axis], self.extent[axis]))
    }

    /// Places of the cells, in the order of fields: x fastest, then y, then z.
    pub fn all(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.cells;
        let rows = (0..nz).flat_map(move |z| (0..ny).map(move |y| (y, z)));
        rows.flat_map(move |(y, z)| (0..nx).map(move |x| [x, y, z]))
    }
}

/// One along `c` from `at`, on an axis that closes on itself.
pub(crate) fn shift(at: usize, c: i32, extent: usize) -> usize {
    match c {
        1 if at + 1 == extent => 0,
        1 => at + 1,
        -1 if at == 0 => extent - 1,
        -1 => at - 1,
        _ => at,
    }
}
