//! Pressure in all cells at once: conjugate gradients, with columns solved exactly.
//!
//! Along z, where beds vary and walls stand, each column alone is a tridiagonal system; it is
//! solved as the preconditioner, so that a single column takes one iteration.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, 11.5.

use crate::Error;
use crate::lattice::Lattice;

/// The equations: diagonal, and what couples a cell to the one before it along each axis.
pub(super) struct Rows {
    cells: [usize; 3],
    diagonal: Vec<f64>,
    before: [Vec<f64>; 3],
    /// Of the columns: inverse pivots.
    pivot: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    eased: Vec<f64>,
}

/// The residual at which pressure counts as solved, over what comes in.
const RESIDUAL: f64 = 1e-11;
const ITERATIONS: usize = 2000;

impl Rows {
    pub fn new(cells: [usize; 3]) -> Self {
        let count = cells.iter().product();
        let zeros = || vec![0.0; count];
        Self {
            cells,
            diagonal: zeros(),
            before: [zeros(), zeros(), zeros()],
            pivot: zeros(),
            residual: zeros(),
            direction: zeros(),
            image: zeros(),
            eased: zeros(),
        }
    }

    /// Lay out storage [m³/Pa] and what faces pass in a step for the gradient of pressure
    /// `yielding` [m/s/Pa].
    pub fn lay(&mut self, lattice: &Lattice, storage: &[f64], yielding: &[[f64; 3]], step: f64) {
        let nz = self.cells[2];
        let areas = super::areas(lattice);
        self.diagonal.copy_from_slice(storage);
        for cell in 0..storage.len() {
            let nodes = super::neighbours(lattice, cell);
            for (axis, (lower, upper)) in nodes.into_iter().enumerate() {
                // The only cell across is its own neighbour.
                if self.cells[axis] == 1 {
                    self.before[axis][cell] = 0.0;
                    continue;
                }
                let pass = |node: usize| step * areas[axis] * yielding[node][axis];
                self.diagonal[cell] += pass(lower) + pass(upper);
                let wall = axis == 2 && cell % nz == 0;
                self.before[axis][cell] = if wall { 0.0 } else { pass(lower) };
            }
        }
        for cell in 0..storage.len() {
            let above = match cell % nz {
                0 => 0.0,
                _ => self.before[2][cell].powi(2) * self.pivot[cell - 1],
            };
            self.pivot[cell] = 1.0 / (self.diagonal[cell] - above);
        }
    }

    fn apply(&self, p: &[f64], to: &mut [f64]) {
        let [nx, ny, nz] = self.cells;
        let plane = ny * nz;
        for cell in 0..p.len() {
            to[cell] = self.diagonal[cell] * p[cell];
        }
        let mut couple = |cell: usize, other: usize, by: f64| {
            to[cell] -= by * p[other];
            to[other] -= by * p[cell];
        };
        for i in 0..nx {
            for j in 0..ny {
                for k in 0..nz {
                    let cell = i * plane + j * nz + k;
                    let left = (if i > 0 { i } else { nx } - 1) * plane + j * nz + k;
                    let front = i * plane + (if j > 0 { j } else { ny } - 1) * nz + k;
                    couple(cell, left, self.before[0][cell]);
                    couple(cell, front, self.before[1][cell]);
                    if k > 0 {
                        couple(cell, cell - 1, self.before[2][cell]);
                    }
                }
            }
        }
    }

    /// Solve the columns alone for the residual.
    fn ease(&mut self) {
        let nz = self.cells[2];
        let columns = self.eased.chunks_exact_mut(nz);
        let columns = columns.zip(self.residual.chunks_exact(nz));
        let rows = self
            .pivot
            .chunks_exact(nz)
            .zip(self.before[2].chunks_exact(nz));
        for ((eased, residual), (pivot, before)) in columns.zip(rows) {
            eased[0] = residual[0];
            for k in 1..nz {
                eased[k] = residual[k] + before[k] * pivot[k - 1] * eased[k - 1];
            }
            eased[nz - 1] *= pivot[nz - 1];
            for k in (0..nz - 1).rev() {
                eased[k] = pivot[k] * (eased[k] + before[k + 1] * eased[k + 1]);
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Solve for the pressure, which comes as a guess.
pub(super) fn solve(rows: &mut Rows, right: &[f64], pressure: &mut [f64]) -> Result<(), Error> {
    let mut image = std::mem::take(&mut rows.image);
    let mut direction = std::mem::take(&mut rows.direction);
    rows.apply(pressure, &mut image);
    let mut scale = 0.0;
    for cell in 0..right.len() {
        rows.residual[cell] = right[cell] - image[cell];
        let held = rows.diagonal[cell] * pressure[cell];
        scale += right[cell].powi(2) + held * held;
    }
    let enough = RESIDUAL * RESIDUAL * scale;
    rows.ease();
    direction.copy_from_slice(&rows.eased);
    let mut size = dot(&rows.residual, &rows.eased);
    let mut left = dot(&rows.residual, &rows.residual);
    let mut made = 0;
    while left > enough && made < ITERATIONS {
        rows.apply(&direction, &mut image);
        let along = size / dot(&direction, &image);
        for cell in 0..right.len() {
            pressure[cell] += along * direction[cell];
            rows.residual[cell] -= along * image[cell];
        }
        rows.ease();
        let new = dot(&rows.residual, &rows.eased);
        for cell in 0..right.len() {
            direction[cell] = rows.eased[cell] + new / size * direction[cell];
        }
        size = new;
        left = dot(&rows.residual, &rows.residual);
        made += 1;
    }
    rows.image = image;
    rows.direction = direction;
    // Not a number is no solution either.
    if left <= enough {
        return Ok(());
    }
    Err(Error::Invalid(format!(
        "the pressure of the water was not found in {ITERATIONS} iterations: the numbers run away; \
         give a shorter step"
    )))
}
