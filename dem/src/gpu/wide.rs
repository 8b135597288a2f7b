//! Numbers of two words, hi whole units and lo parts of 2^-32 unit: coordinates and running
//! sums on the GPU.
//!
//! Twin: shaders/dem/wide.wgsl

use bytemuck::{Pod, Zeroable};

/// hi + 2^-32 lo, in units that the user of the number knows.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Wide {
    /// Whole units, rounded down.
    pub hi: i32,
    /// The rest, in parts of 2^-32 unit.
    pub lo: u32,
}

/// Parts of a unit.
const PARTS: f64 = 4_294_967_296.0;

impl Wide {
    /// Numbers of this size [units] and more count as overflowing.
    pub const MOST: f64 = 1_073_741_824.0;

    /// The number of `parts`.
    pub fn of_parts(parts: i64) -> Self {
        Self {
            hi: (parts >> 32) as i32,
            lo: parts as u32,
        }
    }

    /// All of it in parts of 2^-32 unit.
    pub fn parts(self) -> i64 {
        i64::from(self.hi) << 32 | i64::from(self.lo)
    }

    /// `x` units, to the nearest part, ties to even; none if |x| is not below [`Wide::MOST`].
    pub fn widen(x: f64) -> Option<Self> {
        // Both the product and its rounding are exact but for parts of a part.
        (x.abs() < Self::MOST).then(|| Self::of_parts((x * PARTS).round_ties_even() as i64))
    }

    /// Units, rounded to f64.
    pub fn units(self) -> f64 {
        self.parts() as f64 / PARTS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_carry_the_sign_of_the_whole() {
        let w = Wide::widen(-0.25).unwrap();
        assert_eq!((w.hi, w.lo), (-1, 0xC000_0000));
        assert_eq!(w.units(), -0.25);
        assert_eq!(Wide::widen(-7.0).unwrap(), Wide { hi: -7, lo: 0 });
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(Wide::widen(Wide::MOST), None);
        assert_eq!(Wide::widen(f64::NAN), None);
        assert!(Wide::widen(-Wide::MOST + 1.0).is_some());
    }
}
