//! The hot loops of the exchange, chosen once by processor, as in `dem`.

use crate::exchange::Exchange;
use crate::gather::{Drawn, Given, drag, push, read};
use crate::nodes::{Plane, Scratch};
use crate::scatter::scatter;
use crate::terms::{Moments, Sheets};
use dem::Row;
use dem::lanes::Portable;
use std::ops::Range;

pub(crate) type Scatter = unsafe fn(&Exchange, Range<usize>, &[Row], &[Row], &mut [Moments]);
type Drag = unsafe fn(Given, Drawn, Range<usize>, &mut [Row], &mut [Row]);

/// The loops. They are unsafe because some need features of the processor, which the constructor
/// has asked for, and because those that read ways trust in one for each grain.
#[derive(Clone, Copy)]
pub(crate) struct Kernels<const N: usize> {
    /// Moments of some groups from what grains count and their ways.
    pub scatter: Scatter,
    /// The same, were all ways 1, whatever is given.
    pub sum: Scatter,
    /// The nodes of a plane take moments, with scratch.
    pub take: unsafe fn(&Plane<N>, &[Moments], Scratch, &mut [Row]),
    /// The nodes of a plane, on the lines of the scratch, give sheets.
    pub give: unsafe fn(&Plane<N>, Scratch, &mut [Sheets]),
    /// Push own grains; and drag them, with what each is dragged by.
    pub push: unsafe fn(Given, Range<usize>, &mut [Row]),
    pub drag: Drag,
    /// What each grain finds.
    pub read: unsafe fn(Given, &mut [[Row; 3]]),
}

impl<const N: usize> Kernels<N> {
    /// Those of the processor.
    pub fn choose() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            return avx2::kernels();
        }
        Self::portable()
    }

    /// Those that run everywhere.
    pub fn portable() -> Self {
        Self {
            scatter: scatter::<Portable, true>,
            sum: scatter::<Portable, false>,
            take: Plane::<N>::take::<Portable>,
            give: Plane::<N>::give::<Portable>,
            push: push::<Portable, N>,
            drag: drag::<Portable, N>,
            read: read::<Portable, N>,
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::*;
    use dem::lanes::Avx2;

    pub(super) fn kernels<const N: usize>() -> Kernels<N> {
        Kernels {
            scatter: scatter_avx2,
            sum: sum_avx2,
            take: take_avx2,
            give: give_avx2,
            push: push_avx2::<N>,
            drag: drag_avx2::<N>,
            read: read_avx2::<N>,
        }
    }

    #[target_feature(enable = "avx2,fma")]
    unsafe fn scatter_avx2(
        exchange: &Exchange,
        range: Range<usize>,
        counts: &[Row],
        way: &[Row],
        moments: &mut [Moments],
    ) {
        // SAFETY: the caller's promise.
        unsafe { scatter::<Avx2, true>(exchange, range, counts, way, moments) }
    }

    #[target_feature(enable = "avx2,fma")]
    unsafe fn sum_avx2(
        exchange: &Exchange,
        range: Range<usize>,
        counts: &[Row],
        way: &[Row],
        moments: &mut [Moments],
    ) {
        // SAFETY: it reads no way.
        unsafe { scatter::<Avx2, false>(exchange, range, counts, way, moments) }
    }

    #[target_feature(enable = "avx2,fma")]
    fn take_avx2<const N: usize>(
        plane: &Plane<N>,
        moments: &[Moments],
        scratch: Scratch,
        nodes: &mut [Row],
    ) {
        plane.take::<Avx2>(moments, scratch, nodes);
    }

    #[target_feature(enable = "avx2,fma")]
    fn give_avx2<const N: usize>(plane: &Plane<N>, scratch: Scratch, sheets: &mut [Sheets]) {
        plane.give::<Avx2>(scratch, sheets);
    }

    #[target_feature(enable = "avx2,fma")]
    fn push_avx2<const N: usize>(given: Given, own: Range<usize>, force: &mut [Row]) {
        push::<Avx2, N>(given, own, force);
    }

    #[target_feature(enable = "avx2,fma")]
    unsafe fn drag_avx2<const N: usize>(
        given: Given,
        drawn: Drawn,
        own: Range<usize>,
        force: &mut [Row],
        dragged: &mut [Row],
    ) {
        // SAFETY: the caller's promise.
        unsafe { drag::<Avx2, N>(given, drawn, own, force, dragged) }
    }

    #[target_feature(enable = "avx2,fma")]
    fn read_avx2<const N: usize>(given: Given, to: &mut [[Row; 3]]) {
        read::<Avx2, N>(given, to);
    }
}
