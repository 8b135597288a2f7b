//! Four doubles at a time: the arithmetic of the hot loops, written once.
//!
//! [`Avx2`] uses the processor's vectors where they exist, [`Portable`] plain arrays.
//! Both do the same operations in the same order; only the rounding of fused
//! multiplications differs. Everything here is `inline(always)` and free of closures:
//! a closure would not inherit the vector features of the kernel that it is inlined into.
//!
//! Public for what goes along with the grains (`coupling`), which chooses its loops in the same
//! way; nobody else should use it.

use std::ops::{Add, Div, Mul, Sub};

/// One row of memory: three components and one more number, aligned for one vector load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Row(pub [f64; 4]);

impl Row {
    /// Four zeros.
    pub const ZERO: Self = Self([0.0; 4]);

    /// Three components and one more number.
    pub fn new(v: glam::DVec3, w: f64) -> Self {
        Self([v.x, v.y, v.z, w])
    }

    /// The three components.
    pub fn xyz(&self) -> glam::DVec3 {
        glam::DVec3::new(self.0[0], self.0[1], self.0[2])
    }

    /// The fourth number.
    pub fn w(&self) -> f64 {
        self.0[3]
    }
}

/// Where a row stands: its distance from the first one in bytes. The hot loops look up
/// tens of rows for each contact; so they need not multiply for each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place(u32);

impl Place {
    /// The most rows that can be told apart.
    pub const MOST: usize = u32::MAX as usize / size_of::<Row>();

    pub fn of(index: usize) -> Self {
        assert!(index < Self::MOST, "the solver refuses beds of more grains");
        Self((index * size_of::<Row>()) as u32)
    }

    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize / size_of::<Row>()
    }
}

/// The row at `place`, without a check.
///
/// # Safety
/// `place` lies in `rows`. The neighbour search makes places from the rows that there are.
#[inline(always)]
pub(crate) unsafe fn row(rows: &[Row], place: Place) -> &Row {
    debug_assert!(place.index() < rows.len());
    // SAFETY: the caller's promise; checked in builds with debug assertions.
    unsafe { &*rows.as_ptr().byte_add(place.0 as usize) }
}

/// As [`row`], for writing.
///
/// # Safety
/// As for [`row`].
#[inline(always)]
pub(crate) unsafe fn row_mut(rows: &mut [Row], place: Place) -> &mut Row {
    debug_assert!(place.index() < rows.len());
    // SAFETY: as in `row`.
    unsafe { &mut *rows.as_mut_ptr().byte_add(place.0 as usize) }
}

/// Four doubles.
pub trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// One truth value a lane.
    type Mask: Copy;

    /// `x` in each lane.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(row: &Row) -> Self;
    /// To memory.
    fn store(self, row: &mut Row);
    /// `self * b + c`
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// `c - self * b`
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The greater of each two.
    fn max(self, other: Self) -> Self;
    /// Without signs.
    fn abs(self) -> Self;
    /// To the nearest whole number, halves to even ones.
    fn round(self) -> Self;
    /// Is it greater?
    fn greater(self, other: Self) -> Self::Mask;
    /// `a` where the mask is set, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// `self` where the mask is set, else 0.
    fn keep(self, mask: Self::Mask) -> Self;
    /// Bit k is lane k.
    fn bits(mask: Self::Mask) -> u32;
    /// The last lane taken from `other`.
    fn with_last(self, other: Self) -> Self;
    /// Rows to columns.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
}

/// Three components of four vectors.
#[derive(Clone, Copy)]
pub(crate) struct V3<V>(pub V, pub V, pub V);

impl<V: Lanes> V3<V> {
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = V::splat(0.0);
        Self(zero, zero, zero)
    }

    /// Three columns of memory.
    #[inline(always)]
    pub fn load([x, y, z]: [&Row; 3]) -> Self {
        Self(V::load(x), V::load(y), V::load(z))
    }

    #[inline(always)]
    pub fn store(self, [x, y, z]: [&mut Row; 3]) {
        self.0.store(x);
        self.1.store(y);
        self.2.store(z);
    }

    /// Store as four rows, `w` in their fourth places.
    #[inline(always)]
    pub fn store_rows(self, w: V, rows: &mut [Row; 4]) {
        let [a, b, c, d] = V::transpose([self.0, self.1, self.2, w]);
        a.store(&mut rows[0]);
        b.store(&mut rows[1]);
        c.store(&mut rows[2]);
        d.store(&mut rows[3]);
    }

    #[inline(always)]
    pub fn dot(self, b: Self) -> V {
        self.0.mul_add(b.0, self.1.mul_add(b.1, self.2 * b.2))
    }

    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self(
            self.2.neg_mul_add(b.1, self.1 * b.2),
            self.0.neg_mul_add(b.2, self.2 * b.0),
            self.1.neg_mul_add(b.0, self.0 * b.1),
        )
    }

    #[inline(always)]
    pub fn scale(self, s: V) -> Self {
        Self(self.0 * s, self.1 * s, self.2 * s)
    }

    /// `self + s b`
    #[inline(always)]
    pub fn plus(self, s: V, b: Self) -> Self {
        Self(
            s.mul_add(b.0, self.0),
            s.mul_add(b.1, self.1),
            s.mul_add(b.2, self.2),
        )
    }

    /// `self - s b`
    #[inline(always)]
    pub fn minus(self, s: V, b: Self) -> Self {
        Self(
            s.neg_mul_add(b.0, self.0),
            s.neg_mul_add(b.1, self.1),
            s.neg_mul_add(b.2, self.2),
        )
    }

    #[inline(always)]
    pub fn keep(self, mask: V::Mask) -> Self {
        Self(self.0.keep(mask), self.1.keep(mask), self.2.keep(mask))
    }

    #[inline(always)]
    pub fn select(mask: V::Mask, a: Self, b: Self) -> Self {
        Self(
            V::select(mask, a.0, b.0),
            V::select(mask, a.1, b.1),
            V::select(mask, a.2, b.2),
        )
    }
}

/// Plain arrays, for processors without AVX2.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub struct Portable([f64; 4]);

macro_rules! lanewise {
    ($($trait:ident $method:ident $op:tt),*) => {$(
        impl $trait for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                let (a, b) = (self.0, b.0);
                Self([a[0] $op b[0], a[1] $op b[1], a[2] $op b[2], a[3] $op b[3]])
            }
        }
    )*};
}
lanewise!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Lanes for Portable {
    type Mask = [bool; 4];

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn load(row: &Row) -> Self {
        Self(row.0)
    }
    #[inline(always)]
    fn store(self, row: &mut Row) {
        row.0 = self.0;
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // Not f64::mul_add: without the instruction it is a slow library call.
        self * b + c
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        c - self * b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let a = self.0;
        Self([a[0].sqrt(), a[1].sqrt(), a[2].sqrt(), a[3].sqrt()])
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.greater(other), self, other)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let a = self.0;
        Self([a[0].abs(), a[1].abs(), a[2].abs(), a[3].abs()])
    }
    #[inline(always)]
    fn round(self) -> Self {
        // Adding and subtracting 1.5 × 2^52 rounds to even, as the vector instruction does.
        let big = Self::splat(6_755_399_441_055_744.0);
        self + big - big
    }
    #[inline(always)]
    fn greater(self, other: Self) -> [bool; 4] {
        let (a, b) = (self.0, other.0);
        [a[0] > b[0], a[1] > b[1], a[2] > b[2], a[3] > b[3]]
    }
    #[inline(always)]
    fn select(m: [bool; 4], a: Self, b: Self) -> Self {
        let (a, b) = (a.0, b.0);
        Self([
            if m[0] { a[0] } else { b[0] },
            if m[1] { a[1] } else { b[1] },
            if m[2] { a[2] } else { b[2] },
            if m[3] { a[3] } else { b[3] },
        ])
    }
    #[inline(always)]
    fn keep(self, mask: [bool; 4]) -> Self {
        Self::select(mask, self, Self::splat(0.0))
    }
    #[inline(always)]
    fn bits(m: [bool; 4]) -> u32 {
        m[0] as u32 | (m[1] as u32) << 1 | (m[2] as u32) << 2 | (m[3] as u32) << 3
    }
    #[inline(always)]
    fn with_last(self, other: Self) -> Self {
        Self([self.0[0], self.0[1], self.0[2], other.0[3]])
    }
    #[inline(always)]
    fn transpose(r: [Self; 4]) -> [Self; 4] {
        let [a, b, c, d] = [r[0].0, r[1].0, r[2].0, r[3].0];
        [
            Self([a[0], b[0], c[0], d[0]]),
            Self([a[1], b[1], c[1], d[1]]),
            Self([a[2], b[2], c[2], d[2]]),
            Self([a[3], b[3], c[3], d[3]]),
        ]
    }
}

#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Lanes, Row};
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Sub};

    /// One AVX register. Only code inside `#[target_feature(enable = "avx2,fma")]`, which
    /// runs after the processor was asked, may use it: that is what every `unsafe` below
    /// relies on.
    #[derive(Clone, Copy)]
    pub struct Avx2(__m256d);

    macro_rules! lanewise {
        ($($trait:ident $method:ident $intrinsic:ident),*) => {$(
            impl $trait for Avx2 {
                type Output = Self;
                #[inline(always)]
                fn $method(self, b: Self) -> Self {
                    Self(unsafe { $intrinsic(self.0, b.0) })
                }
            }
        )*};
    }
    lanewise!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);

    impl Lanes for Avx2 {
        type Mask = __m256d;

        #[inline(always)]
        fn splat(x: f64) -> Self {
            Self(unsafe { _mm256_set1_pd(x) })
        }
        #[inline(always)]
        fn load(row: &Row) -> Self {
            Self(unsafe { _mm256_load_pd(row.0.as_ptr()) })
        }
        #[inline(always)]
        fn store(self, row: &mut Row) {
            unsafe { _mm256_store_pd(row.0.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        fn mul_add(self, b: Self, c: Self) -> Self {
            Self(unsafe { _mm256_fmadd_pd(self.0, b.0, c.0) })
        }
        #[inline(always)]
        fn neg_mul_add(self, b: Self, c: Self) -> Self {
            Self(unsafe { _mm256_fnmadd_pd(self.0, b.0, c.0) })
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(unsafe { _mm256_sqrt_pd(self.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Self(unsafe { _mm256_max_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn abs(self) -> Self {
            Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
        }
        #[inline(always)]
        fn round(self) -> Self {
            const TO_NEAREST: i32 = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
            Self(unsafe { _mm256_round_pd::<TO_NEAREST>(self.0) })
        }
        #[inline(always)]
        fn greater(self, other: Self) -> __m256d {
            unsafe { _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, other.0) }
        }
        #[inline(always)]
        fn select(mask: __m256d, a: Self, b: Self) -> Self {
            Self(unsafe { _mm256_blendv_pd(b.0, a.0, mask) })
        }
        #[inline(always)]
        fn keep(self, mask: __m256d) -> Self {
            Self(unsafe { _mm256_and_pd(self.0, mask) })
        }
        #[inline(always)]
        fn bits(mask: __m256d) -> u32 {
            unsafe { _mm256_movemask_pd(mask) as u32 }
        }
        #[inline(always)]
        fn with_last(self, other: Self) -> Self {
            Self(unsafe { _mm256_blend_pd::<0b1000>(self.0, other.0) })
        }
        #[inline(always)]
        fn transpose(r: [Self; 4]) -> [Self; 4] {
            unsafe {
                let ab_even = _mm256_unpacklo_pd(r[0].0, r[1].0);
                let ab_odd = _mm256_unpackhi_pd(r[0].0, r[1].0);
                let cd_even = _mm256_unpacklo_pd(r[2].0, r[3].0);
                let cd_odd = _mm256_unpackhi_pd(r[2].0, r[3].0);
                [
                    Self(_mm256_permute2f128_pd::<0x20>(ab_even, cd_even)),
                    Self(_mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd)),
                    Self(_mm256_permute2f128_pd::<0x31>(ab_even, cd_even)),
                    Self(_mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd)),
                ]
            }
        }
    }
}
