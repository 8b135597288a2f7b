//! The order of one step, as every thread of a solver walks through it.

use crate::clock::Clock;
use crate::collide::Coefficients;
use crate::grid::Grid;
use crate::kernels::Kernels;
use crate::lanes::Real;
use crate::links::{Given, Links};
use crate::populations::{Populations, Span};
use crate::{Ends, Model, Scaling, Side};
use std::ops::Range;
use std::sync::Barrier;

/// What the threads of one call share.
pub(crate) struct Crew<'a, T> {
    pub kernels: Kernels<T>,
    pub populations: &'a Populations<T>,
    pub coefficients: &'a Coefficients<T>,
    pub shares: &'a [Vec<Span>],
    pub links: &'a Links,
    pub model: &'a Model,
    pub scaling: &'a Scaling,
    pub stretch: f64,
    /// When steps happen.
    pub clock: Clock,
    pub barrier: &'a Barrier,
}

impl<T: Real> Crew<'_, T> {
    /// Make these steps.
    pub fn walk(&self, thread: usize, steps: Range<u64>) {
        for step in steps {
            let odd = step % 2 == 1;
            // SAFETY: shares hold cells of the lattice, each in one share only, and the slots
            // of a cell are no other cell's; between the barriers nobody else uses them.
            unsafe {
                (self.kernels.sweep)(
                    self.coefficients,
                    self.populations,
                    odd,
                    &self.shares[thread],
                )
            };
            self.meet();
            // What is emitted passes a side half a step later.
            let time = self.clock.after(step as f64 + 0.5);
            let given =
                |axis, upper| given(self.model, self.scaling, self.stretch, (axis, upper), time);
            // SAFETY: all have emitted, and go on after the next barrier.
            unsafe {
                self.links
                    .answer(self.populations, !odd, &given, thread, self.shares.len());
            }
            self.meet();
        }
    }

    /// Wait for the others.
    fn meet(&self) {
        if self.shares.len() > 1 {
            self.barrier.wait();
        }
    }
}

/// What a side of the box gives at `time` [s], lattice units of cells `stretch` spacings high.
pub(crate) fn given(
    model: &Model,
    scaling: &Scaling,
    stretch: f64,
    (axis, upper): (usize, bool),
    time: f64,
) -> Given {
    let side = match &model.ends[axis] {
        Ends::Walls(_, side) if upper => side,
        Ends::Walls(side, _) => side,
        // No link ends there.
        Ends::Periodic => &Side::FreeSlip,
    };
    let unit = scaling.flux_unit(stretch);
    match side {
        Side::FreeSlip => Given::Flux([0.0; 3]),
        Side::NoSlip(velocity) => Given::Flux([0, 1, 2].map(|a| velocity[a] / unit[a])),
        Side::Pressure(signal) => Given::Pressure(signal.at(time) / scaling.pressure_unit()),
        Side::Flux(signal) => {
            let inward = if upper { -1.0 } else { 1.0 };
            let mut j = [0.0; 3];
            j[axis] = inward * signal.at(time) / unit[axis];
            Given::Flux(j)
        }
    }
}

/// Fluid cells side by side, in the order of rows.
pub(crate) fn spans(grid: &Grid, fluid: &[bool]) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for (cell, [x, y, z]) in grid.all().enumerate() {
        if !fluid[cell] {
            continue;
        }
        let [x, y, z] = [x, y, z].map(|i| u32::try_from(i).expect("places are counted in u32"));
        match spans.last_mut() {
            Some(span) if span.y == y && span.z == z && span.end == x => span.end = x + 1,
            _ => spans.push(Span {
                y,
                z,
                begin: x,
                end: x + 1,
            }),
        }
    }
    spans
}

/// Spans for each thread, with about the same number of cells.
pub(crate) fn shares(spans: &[Span], threads: usize) -> Vec<Vec<Span>> {
    let count = |span: &Span| (span.end - span.begin) as usize;
    let total: usize = spans.iter().map(count).sum();
    let mut shares = vec![Vec::new(); threads];
    let mut before = 0;
    for span in spans {
        shares[before * threads / total].push(*span);
        before += count(span);
    }
    shares
}
