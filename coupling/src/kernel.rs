//! The smooth compact kernel through which a grain meets the lattice, along one axis.
//!
//! In units of the cell, a grain at ξ is spread as a hat of half width m:
//!
//! > K(x) = (1 - |x|/m)/m for |x| < m
//!
//! Cell k, from k to k + 1, gets c_k = ∫K over it: for m = 1 the quadratic B-spline. The face
//! at k gets K(k - ξ). Both belong together: as the grain moves,
//!
//! > dc_k/dt = [K(k - ξ) - K(k + 1 - ξ)] dξ/dt,
//!
//! so that the solid volume in a cell and the flux of solid through its faces are one statement.
//! At walls the grain has mirror images, whose volume counts and whose flux is opposite: what
//! falls on a cell or face behind a wall is folded back. Then the weights of all cells sum to one
//! and nothing passes a wall at rest.
//!
//! In three dimensions weights are products: a face of normal x has K along x and c along y, z.
//! Where the lattice is stretched, the kernel is stretched with it.

use dem::Row;

/// Half width in cells of a kernel that reaches `N` of them.
pub(crate) const fn half_width(n: usize) -> usize {
    (n - 1) / 2
}

/// Coefficients of 1, t, t² of the share of cell `k` of `n`, and of the weight of its lower face;
/// t is how far into the middle cell the grain is, from 0 to 1.
const fn coefficients(n: usize, k: usize) -> [[f64; 3]; 2] {
    match (n, k) {
        (3, 0) => [[0.5, -1.0, 0.5], [0.0, 0.0, 0.0]],
        (3, 1) => [[0.5, 1.0, -1.0], [1.0, -1.0, 0.0]],
        (3, 2) => [[0.0, 0.0, 0.5], [0.0, 1.0, 0.0]],
        (5, 0) => [[0.125, -0.25, 0.125], [0.0, 0.0, 0.0]],
        (5, 1) => [[0.375, -0.25, 0.0], [0.25, -0.25, 0.0]],
        (5, 2) => [[0.375, 0.25, -0.25], [0.5, -0.25, 0.0]],
        (5, 3) => [[0.125, 0.25, 0.0], [0.25, 0.25, 0.0]],
        (5, 4) => [[0.0, 0.0, 0.125], [0.0, 0.25, 0.0]],
        _ => panic!("a kernel reaches three cells or five"),
    }
}

/// The same weights as sums of s, t, and of 1, s², t², where s = 1 - t: of terms that are never
/// negative, such that sums of weights lose no digits however small they are. What is subtracted is
/// never more than half of what it is subtracted from.
pub(crate) struct Kernel<const N: usize>;

impl<const N: usize> Kernel<N> {
    /// Coefficients of 1, s², t² in the share of each cell.
    pub const CELLS: [[f64; N]; 3] = {
        let mut of = [[0.0; N]; 3];
        let mut k = 0;
        while k < N {
            let [a, b, c] = coefficients(N, k)[0];
            // t = (1 - s² + t²)/2
            (of[0][k], of[1][k], of[2][k]) = (a + 0.5 * b, -0.5 * b, 0.5 * b + c);
            k += 1;
        }
        of
    };

    /// Coefficients of s, t in the weight of each lower face.
    pub const FACES: [[f64; N]; 2] = {
        let mut of = [[0.0; N]; 2];
        let mut k = 0;
        while k < N {
            let [a, b, _] = coefficients(N, k)[1];
            (of[0][k], of[1][k]) = (a, a + b);
            k += 1;
        }
        of
    };

    /// The same along z, side by side for the faces of normal x, y and z.
    pub const ALONG_Z: [[Row; N]; 3] = {
        let mut of = [[Row::ZERO; N]; 3];
        let mut term = 0;
        while term < 3 {
            let mut k = 0;
            while k < N {
                let cell = Self::CELLS[term][k];
                let face = if term < 2 { Self::FACES[term][k] } else { 0.0 };
                of[term][k] = Row([cell, cell, face, 0.0]);
                k += 1;
            }
            term += 1;
        }
        of
    };
}

/// Shares of the `N` cells that a grain reaches along an axis, and weights of their lower faces;
/// `t`: how far into the middle one it is.
pub(crate) fn shares<const N: usize>(t: f64) -> ([f64; N], [f64; N]) {
    let (mut cells, mut faces) = ([0.0; N], [0.0; N]);
    for k in 0..N {
        let [cell, face] = coefficients(N, k).map(|[a, b, c]| a + t * (b + t * c));
        (cells[k], faces[k]) = (cell, face);
    }
    (cells, faces)
}

/// The cell that stands for cell `k` of an axis with walls before cell 0 and behind the last of
/// `count`.
pub(crate) fn folded_cell(k: i64, count: usize) -> usize {
    let count = count as i64;
    let folded = if k < 0 {
        -1 - k
    } else {
        k.min(2 * count - 1 - k)
    };
    folded as usize
}

/// The face that stands for face `k`, and the wall behind which `k` lies (0 the lower, 1 the
/// upper one), if it does. Faces at the walls are their own.
pub(crate) fn folded_face(k: i64, count: usize) -> (usize, Option<usize>) {
    let count = count as i64;
    match k {
        k if k < 0 => (-k as usize, Some(0)),
        k if k > count => ((2 * count - k) as usize, Some(1)),
        k => (k as usize, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hat(x: f64, m: f64) -> f64 {
        (1.0 - x.abs() / m).max(0.0) / m
    }

    /// Shares along one axis at `at` cells, folded between walls 10 cells apart: cells, and the
    /// flux that a grain of unit velocity brings through the lower face of each.
    fn folded<const N: usize>(at: f64) -> ([f64; 10], [f64; 11]) {
        let (cells, faces) = shares::<N>(at.fract());
        let (mut cell, mut flux) = ([0.0; 10], [0.0; 11]);
        for k in 0..N {
            let place = at.floor() as i64 + k as i64 - half_width(N) as i64;
            cell[folded_cell(place, 10)] += cells[k];
            let (face, behind) = folded_face(place, 10);
            if face > 0 && face < 10 {
                flux[face] += faces[k] * if behind.is_some() { -1.0 } else { 1.0 };
            }
        }
        (cell, flux)
    }

    fn checks<const N: usize>() {
        let m = half_width(N) as f64;
        for step in 0..1000 {
            let t = step as f64 * 1e-3;
            let (cells, faces) = shares::<N>(t);
            assert!((cells.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!((faces.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let s = 1.0 - t;
            for k in 0..N {
                let face = hat(k as f64 - m - t, m);
                assert!((faces[k] - face).abs() < 1e-15, "face {k} at {t}");
                assert!(cells[k] >= 0.0);
                let [a, b, c] = Kernel::<N>::CELLS.map(|of| of[k]);
                let cell = a + b * s * s + c * t * t;
                assert!((cells[k] - cell).abs() < 1e-15, "cell {k} at {t}");
                let [a, b] = Kernel::<N>::FACES.map(|of| of[k]);
                assert!((faces[k] - a * s - b * t).abs() < 1e-15, "face {k} at {t}");
                assert!(a >= 0.0 && b >= 0.0);
            }
        }
        // dc_k/dξ = K_k - K_(k+1): what is in a cell changes by what passes its faces, at
        // walls too. Shares are of second order: central differences are exact.
        let e = 1e-3;
        for at in [0.1, 0.45, 0.7, 1.3, 5.25, 8.6, 9.15, 9.8] {
            let (_, flux) = folded::<N>(at);
            let (after, before) = (folded::<N>(at + e).0, folded::<N>(at - e).0);
            for k in 0..10 {
                let slope = (after[k] - before[k]) / (2.0 * e);
                assert!(
                    (slope - (flux[k] - flux[k + 1])).abs() < 1e-12,
                    "cell {k} at {at}"
                );
            }
            assert!((after.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn shares_sum_to_one_and_change_by_the_flux_through_faces() {
        checks::<3>();
        checks::<5>();
    }
}
