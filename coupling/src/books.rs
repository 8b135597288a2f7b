//! What threads book at each exchange for the ledger: works on cells and on loose grains.
//!
//! What is pushed with from one exchange to the next does its work on the ways in between, but for
//! half of the last step, which belongs to what comes after (`ledger.rs`).

use crate::faces::Pass;
use dem::{Moved, Row, Threads};
use glam::DVec3;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// What is summed over a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlaneBooks {
    /// Work on the cells [J].
    pub cells: f64,
    /// Work of reactions on the grains [J].
    pub given: f64,
}

/// The exchange at which loose grains were dragged last.
pub(crate) struct Dragged(AtomicU64);

impl Default for Dragged {
    fn default() -> Self {
        Self(AtomicU64::new(u64::MAX))
    }
}

impl Dragged {
    pub fn was_at(&self, step: u64) -> bool {
        self.0.load(Ordering::Relaxed) == step
    }
}

impl<const N: usize> Pass<'_, N> {
    /// Book the work on a plane's cells: of what they collect with the pressure until now, but for
    /// half of the last step, and of that step's other half before. Called with each cell, its
    /// pressure [Pa], steps, and the volume of each [m³].
    pub fn book_cells(&self, plane: usize) -> impl FnMut(usize, f64, f64, f64) {
        let range = self.lattice.cells_of(plane);
        // SAFETY: each plane is one thread's.
        let (brought, books) = unsafe {
            let range = match self.books_are_kept() {
                true => range,
                false => 0..0,
            };
            let books = &mut self.fields.books.write(plane..plane + 1)[0];
            (self.fields.brought.write(range), books)
        };
        move |own, pressure, passed, volume| {
            if let Some(before) = brought.get_mut(own) {
                let volumes = 0.5 * *before + (passed - 0.5) * volume;
                books.cells -= pressure * volumes;
                *before = volume;
            }
        }
    }

    fn books_are_kept(&self) -> bool {
        // SAFETY: its length does not change.
        unsafe { !self.fields.brought.read().is_empty() }
    }

    /// Book the work of the reactions since the last exchange, but for half of the last step.
    pub fn book_given(&self, plane: usize, moved: &Moved) {
        if self.fields.dragged_at.was_at(moved.step - moved.passed[0]) {
            self.book_power(plane, self.step * (moved.passed[0] as f64 - 0.5));
        }
    }

    /// Book the work of new reactions in half of the step before them.
    pub fn book_reactions(&self, plane: usize) {
        if self.books_are_kept() {
            self.book_power(plane, 0.5 * self.step);
        }
    }

    fn book_power(&self, plane: usize, time: f64) {
        let power = self.power_given(self.lattice.cells_of(plane), None);
        // SAFETY: each plane is one thread's.
        unsafe { self.fields.books.write(plane..plane + 1)[0].given += time * power };
    }

    /// Power of the reactions [W] at these or at the last mean velocities.
    pub fn power_given(&self, cells: Range<usize>, velocity: Option<&[Row]>) -> f64 {
        // SAFETY: each plane is one thread's.
        let (reaction, last) =
            unsafe { (self.fields.reaction.read(), self.fields.velocity.read()) };
        let velocity = velocity.unwrap_or(last);
        let each = reaction[cells.clone()].iter().zip(&velocity[cells]);
        each.map(|(r, v)| r.xyz().dot(v.xyz())).sum()
    }

    /// The drag on own grains, to be written, where there are books.
    ///
    /// # Safety
    /// Each grain is one thread's.
    #[allow(clippy::mut_from_ref, reason = "that is the point, as `Shared::write`")]
    pub unsafe fn dragged(&self, own: Range<usize>) -> &mut [Row] {
        let own = if self.books_are_kept() { own } else { 0..0 };
        // SAFETY: the caller's promise.
        unsafe { self.fields.dragged.write(own) }
    }

    /// Book the work of new drag in half of the step before it.
    pub fn book_drag(&self, moved: &Moved, own: Range<usize>) {
        if !self.books_are_kept() {
            return;
        }
        self.fields
            .dragged_at
            .0
            .store(moved.step, Ordering::Relaxed);
        self.book_lost(own, |k| 0.5 * self.step * moved.velocity[k].xyz());
    }

    /// Book the work of the drag since the last exchange, but for half of the last step.
    pub fn book_dragged(&self, moved: &Moved, threads: &Threads) {
        if self.books_are_kept() && self.fields.dragged_at.was_at(moved.step - moved.passed[0]) {
            self.book_lost(threads.share(self.exchange.count), |k| {
                moved.way[k].xyz() - 0.5 * self.step * moved.velocity[k].xyz()
            });
        }
    }

    fn book_lost(&self, grains: Range<usize>, way: impl Fn(usize) -> DVec3) {
        // SAFETY: each grain is one thread's.
        let (lost, dragged) = unsafe {
            let lost = self.fields.lost.write(grains.clone());
            (lost, &self.fields.dragged.read()[grains.clone()])
        };
        for ((lost, drag), k) in lost.iter_mut().zip(dragged).zip(grains) {
            *lost -= drag.xyz().dot(way(k));
        }
    }
}
