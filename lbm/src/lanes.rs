//! Several cells at a time: the arithmetic of the collision, written once.
//!
//! Three kinds: one cell with plain operations, for processors without vectors; one cell with
//! fused ones, for the ends of rows; and a vector. The latter two round alike, so that a cell
//! gets the same bits wherever in a row it lies.

use std::fmt::{Debug, Display};
use std::ops::{Add, Div, Mul, Sub};

/// The number type of a lattice: `f32` or `f64`.
pub trait Real:
    Copy
    + Debug
    + Display
    + Default
    + PartialEq
    + Add<Output = Self>
    + Mul<Output = Self>
    + Send
    + Sync
    + private::Number
    + 'static
{
    /// Distance from 1 to the next number.
    const EPSILON: f64;
    /// The nearest number to `x`.
    fn of(x: f64) -> Self;
    /// As a double.
    fn double(self) -> f64;
}

/// What kernels need of a number; outside of this crate there are no more of them.
pub(crate) mod private {
    pub trait Number: Sized {
        type Plain: super::Lanes<Self>;
        #[cfg(target_arch = "x86_64")]
        type Fused: super::Lanes<Self>;
        #[cfg(target_arch = "x86_64")]
        type Avx2: super::Lanes<Self>;
    }
}

/// Some cells side by side.
pub trait Lanes<T>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Number of cells.
    const COUNT: usize;
    /// The same number in each cell.
    fn splat(x: T) -> Self;
    /// From `COUNT` numbers in a row.
    ///
    /// # Safety
    /// They must be readable.
    unsafe fn load(from: *const T) -> Self;
    /// To `COUNT` numbers in a row.
    ///
    /// # Safety
    /// They must be writable, and nobody else's.
    unsafe fn store(self, to: *mut T);
    /// `self * b + c`
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
}

macro_rules! single {
    ($name:ident, $t:ty, |$a:ident, $b:ident, $c:ident| $mul_add:expr) => {
        /// One cell.
        #[derive(Clone, Copy)]
        pub struct $name($t);
        single!($name Add add +, Sub sub -, Mul mul *, Div div /);
        impl Lanes<$t> for $name {
            const COUNT: usize = 1;
            #[inline(always)]
            fn splat(x: $t) -> Self {
                Self(x)
            }
            #[inline(always)]
            unsafe fn load(from: *const $t) -> Self {
                // SAFETY: the caller's promise.
                Self(unsafe { from.read() })
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut $t) {
                // SAFETY: the caller's promise.
                unsafe { to.write(self.0) }
            }
            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                let ($a, $b, $c) = (self.0, b.0, c.0);
                Self($mul_add)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
        }
    };
    ($name:ident $($trait:ident $method:ident $op:tt),*) => {$(
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                Self(self.0 $op b.0)
            }
        }
    )*};
}

// Not fused: without the instruction that would be a slow library call.
single!(Plain32, f32, |a, b, c| a * b + c);
single!(Plain64, f64, |a, b, c| a * b + c);

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::Lanes;
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Sub};

    // Only inside of functions with the feature `fma`, where this is one instruction.
    single!(Fused32, f32, |a, b, c| a.mul_add(b, c));
    single!(Fused64, f64, |a, b, c| a.mul_add(b, c));

    // One AVX register. Only code inside `#[target_feature(enable = "avx2,fma")]`, which runs
    // after the processor was asked, may use it: every `unsafe` below relies on that.
    macro_rules! vector {
        ($name:ident, $t:ty, $register:ty, $count:expr, $splat:ident, $load:ident, $store:ident,
         $fma:ident, $sqrt:ident, $($trait:ident $method:ident $intrinsic:ident),*) => {
            /// One AVX register of cells.
            #[derive(Clone, Copy)]
            pub struct $name($register);
            $(impl $trait for $name {
                type Output = Self;
                #[inline(always)]
                fn $method(self, b: Self) -> Self {
                    Self(unsafe { $intrinsic(self.0, b.0) })
                }
            })*
            impl Lanes<$t> for $name {
                const COUNT: usize = $count;
                #[inline(always)]
                fn splat(x: $t) -> Self {
                    Self(unsafe { $splat(x) })
                }
                #[inline(always)]
                unsafe fn load(from: *const $t) -> Self {
                    Self(unsafe { $load(from) })
                }
                #[inline(always)]
                unsafe fn store(self, to: *mut $t) {
                    unsafe { $store(to, self.0) }
                }
                #[inline(always)]
                fn mul_add(self, b: Self, c: Self) -> Self {
                    Self(unsafe { $fma(self.0, b.0, c.0) })
                }
                #[inline(always)]
                fn sqrt(self) -> Self {
                    Self(unsafe { $sqrt(self.0) })
                }
            }
        };
    }
    vector!(
        Avx32, f32, __m256, 8, _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps, _mm256_fmadd_ps,
        _mm256_sqrt_ps, Add add _mm256_add_ps, Sub sub _mm256_sub_ps, Mul mul _mm256_mul_ps,
        Div div _mm256_div_ps
    );
    vector!(
        Avx64, f64, __m256d, 4, _mm256_set1_pd, _mm256_loadu_pd, _mm256_storeu_pd, _mm256_fmadd_pd,
        _mm256_sqrt_pd, Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd,
        Div div _mm256_div_pd
    );
}

macro_rules! real {
    ($t:ty, $plain:ident, $fused:ident, $avx2:ident) => {
        impl private::Number for $t {
            type Plain = $plain;
            #[cfg(target_arch = "x86_64")]
            type Fused = x86::$fused;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = x86::$avx2;
        }
        impl Real for $t {
            const EPSILON: f64 = <$t>::EPSILON as f64;
            fn of(x: f64) -> Self {
                x as $t
            }
            fn double(self) -> f64 {
                self as f64
            }
        }
    };
}
real!(f32, Plain32, Fused32, Avx32);
real!(f64, Plain64, Fused64, Avx64);
