//! What the contact kernels read of the grains, four pairs at a time.

use crate::Domain;
use crate::contact::ContactLaw;
use crate::lanes::{Lanes, Place, Row, V3, row};

/// What the contact kernels read. Rows are in sorted order, followed by the dummies.
pub(crate) struct View<'a> {
    pub law: &'a ContactLaw,
    pub domain: Domain,
    /// Centre, radius.
    pub position: &'a [Row],
    /// Velocity half a step ago, 0.
    pub velocity: &'a [Row],
    /// Angular velocity half a step ago, radius; empty where grains do not spin.
    pub spin: &'a [Row],
    /// Time over which springs grow [s]; zero in the first evaluation.
    pub step: f64,
}

/// Dummies behind the grains: a pair that never touches, and a grain that touches no wall.
pub(crate) const DUMMIES: [Row; 3] = [
    Row([0.0, 0.0, 0.0, 0.0]),
    Row([0.0, 0.0, 1.0, 0.0]),
    Row([0.0, 0.0, 0.0, -1e30]),
];

/// Turns x_i - x_j into the difference of centres and the sum of radii.
const SUM_OF_RADII: Row = Row([1.0, 1.0, 1.0, -1.0]);

/// Where the grains of four pairs are to each other.
#[derive(Clone, Copy)]
pub(crate) struct Apart<V: Lanes> {
    /// From centre j to centre i [m], and its square.
    pub d: V3<V>,
    pub squared: V,
    /// Sum of radii [m].
    pub radii: V,
    pub touches: V::Mask,
}

impl<V: Lanes> Apart<V> {
    #[inline(always)]
    pub fn none() -> Self {
        let zero = V::splat(0.0);
        Self {
            d: V3::zero(),
            squared: zero,
            radii: zero,
            touches: zero.greater(zero),
        }
    }
}

/// Shortest image along periodic sides: the box, or nothing where it is open.
pub(crate) struct Wrap<V> {
    length: [V; 2],
    inverse: [V; 2],
}

impl<V: Lanes> Wrap<V> {
    #[inline(always)]
    pub fn new(domain: Domain) -> Self {
        let inverse = |axis: usize| {
            let periodic = domain.periodic[axis];
            V::splat(if periodic {
                1.0 / domain.size[axis]
            } else {
                0.0
            })
        };
        Self {
            length: [V::splat(domain.size[0]), V::splat(domain.size[1])],
            inverse: [inverse(0), inverse(1)],
        }
    }

    #[inline(always)]
    fn nearest(&self, d: V, axis: usize) -> V {
        (d * self.inverse[axis])
            .round()
            .neg_mul_add(self.length[axis], d)
    }
}

impl View<'_> {
    /// Where the grains of four pairs are to each other.
    ///
    /// # Safety
    /// The places lie in the rows.
    #[inline(always)]
    pub unsafe fn apart<V: Lanes>(&self, wrap: &Wrap<V>, pairs: &[[Place; 2]; 4]) -> Apart<V> {
        let signs = V::load(&SUM_OF_RADII);
        // SAFETY: the caller's promise.
        let [x, y, z, radii] = unsafe {
            V::transpose([
                difference(self.position, signs, pairs[0]),
                difference(self.position, signs, pairs[1]),
                difference(self.position, signs, pairs[2]),
                difference(self.position, signs, pairs[3]),
            ])
        };
        let d = V3(wrap.nearest(x, 0), wrap.nearest(y, 1), z);
        let squared = d.dot(d);
        Apart {
            d,
            squared,
            radii,
            touches: (radii * radii).greater(squared),
        }
    }

    /// Velocities of i against j of four pairs.
    ///
    /// # Safety
    /// The places lie in the rows.
    #[inline(always)]
    pub unsafe fn relative_velocity<V: Lanes>(&self, pairs: &[[Place; 2]; 4]) -> V3<V> {
        let one = V::splat(1.0);
        // SAFETY: the caller's promise.
        let [x, y, z, _] = unsafe {
            V::transpose([
                difference(self.velocity, one, pairs[0]),
                difference(self.velocity, one, pairs[1]),
                difference(self.velocity, one, pairs[2]),
                difference(self.velocity, one, pairs[3]),
            ])
        };
        V3(x, y, z)
    }

    /// Spins and radii of the grains `side` (0: i, 1: j) of four pairs.
    ///
    /// # Safety
    /// The places lie in the rows, and grains spin.
    #[inline(always)]
    pub unsafe fn spins<V: Lanes>(&self, pairs: &[[Place; 2]; 4], side: usize) -> (V3<V>, V) {
        // SAFETY: the caller's promise.
        unsafe {
            columns([
                row(self.spin, pairs[0][side]),
                row(self.spin, pairs[1][side]),
                row(self.spin, pairs[2][side]),
                row(self.spin, pairs[3][side]),
            ])
        }
    }
}

/// The row of i minus that of j times `signs`.
///
/// # Safety
/// The places lie in `rows`.
#[inline(always)]
unsafe fn difference<V: Lanes>(rows: &[Row], signs: V, [i, j]: [Place; 2]) -> V {
    // SAFETY: the caller's promise.
    unsafe { V::load(row(rows, j)).neg_mul_add(signs, V::load(row(rows, i))) }
}

/// Four rows as columns.
#[inline(always)]
pub(crate) fn columns<V: Lanes>([a, b, c, d]: [&Row; 4]) -> (V3<V>, V) {
    let [x, y, z, w] = V::transpose([V::load(a), V::load(b), V::load(c), V::load(d)]);
    (V3(x, y, z), w)
}
