//! The terms of the weights inside a cell: how many, in which order.
//!
//! A weight of the faces of normal x is a sum over s_x, t_x times 1, s_y², t_y² times 1, s_z², t_z²
//! (`kernel.rs`); those of y and z alike. The order of the 18 terms of each
//! is that in which one axis after the other is summed: along x first, then y, then z.

use dem::Row;
use dem::lanes::Lanes;

/// Terms of all three faces, after summing along x, and after summing along x and y.
pub(crate) const TERMS: usize = 54;
pub(crate) const SHEETS: usize = 21;
pub(crate) const COLUMNS: usize = 8;

/// One row a term, one lane a cell of a group: moments, or coefficients of polynomials.
pub(crate) type Moments = [Row; TERMS];
/// The same, summed along the other axes.
pub(crate) type Sheets = [Row; SHEETS];

/// Terms along an axis of the faces of this normal.
pub(crate) const fn along(normal: usize, axis: usize) -> usize {
    if normal == axis { 2 } else { 3 }
}

/// Place of a term of the faces of normal x, y, z: powers along the axes.
#[inline(always)]
pub(crate) const fn term(normal: usize, [a, b, c]: [usize; 3]) -> usize {
    18 * normal + (a * along(normal, 1) + b) * along(normal, 2) + c
}

/// The same after summing along x.
#[inline(always)]
pub(crate) const fn sheet(normal: usize, [b, c]: [usize; 2]) -> usize {
    [0, 9, 15][normal] + b * along(normal, 2) + c
}

/// The same after summing along x and y.
#[inline(always)]
pub(crate) const fn column(normal: usize, c: usize) -> usize {
    3 * normal + c
}

/// A sum with weights that the compiler knows: it leaves away those that are zero.
#[derive(Clone, Copy)]
pub(crate) struct Sum<V>(Option<V>);

impl<V: Lanes> Sum<V> {
    #[inline(always)]
    pub const fn new() -> Self {
        Self(None)
    }

    #[inline(always)]
    pub fn add(self, weight: f64, value: &Row) -> Self {
        if weight == 0.0 {
            return self;
        }
        let value = V::load(value);
        Self(Some(match self.0 {
            None if weight == 1.0 => value,
            None => V::splat(weight) * value,
            Some(sum) => V::splat(weight).mul_add(value, sum),
        }))
    }

    #[inline(always)]
    pub fn total(self) -> V {
        match self.0 {
            Some(sum) => sum,
            None => V::splat(0.0),
        }
    }
}
