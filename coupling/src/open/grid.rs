//! Where faces and cells of the lattice lie: columns of nodes with one more for the top.

use crate::lattice::Lattice;

/// Number of nodes, tops of columns included.
pub(super) fn nodes(lattice: &Lattice) -> usize {
    lattice.cells[0] * lattice.cells[1] * (lattice.cells[2] + 1)
}

/// Areas of faces along x, y, z [m²].
pub(super) fn areas(lattice: &Lattice) -> [f64; 3] {
    let side = lattice.spacing * lattice.height;
    [side, side, lattice.spacing * lattice.spacing]
}

/// The nodes of the lower and the upper face of a cell along each axis.
pub(super) fn neighbours(lattice: &Lattice, cell: usize) -> [(usize, usize); 3] {
    let [_, ny, nz] = lattice.cells;
    let (i, j, k) = (cell / (ny * nz), cell / nz % ny, cell % nz);
    let at = |i: usize, j: usize, k: usize| (i * ny + j) * (nz + 1) + k;
    let here = at(i, j, k);
    [
        (here, at(lattice.next(0, i), j, k)),
        (here, at(i, lattice.next(1, j), k)),
        (here, here + 1),
    ]
}

/// The cell before `cell` along an axis; itself at the bottom.
pub(super) fn neighbour(lattice: &Lattice, cell: usize, axis: usize) -> usize {
    let [_, ny, nz] = lattice.cells;
    let (i, j, k) = (cell / (ny * nz), cell / nz % ny, cell % nz);
    match axis {
        0 => lattice.cell([lattice.last(0, i), j, k]),
        1 => lattice.cell([i, lattice.last(1, j), k]),
        _ => cell - usize::from(k > 0),
    }
}
