//! A barrier for steps of tens of microseconds.
//!
//! Waking a sleeping thread costs as much as a step of a thousand grains, so threads spin
//! for a while before they give way, and sleep where cores are so busy that even that does
//! not bring the others. A thread that panics breaks the barrier, so that the
//! others stop too instead of waiting for it.

use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{sleep, yield_now};
use std::time::Duration;

pub(crate) struct Barrier {
    threads: usize,
    arrived: AtomicUsize,
    generation: AtomicUsize,
    broken: AtomicBool,
}

/// Turns of the waiting loop before giving way; about ten microseconds.
const SPINS: u32 = 4000;
/// Turns before sleeping: by then a thread that we wait for has no core.
const YIELDS: u32 = SPINS + 200;
/// How long to sleep; a scheduler's turn takes longer than this.
const NAP: Duration = Duration::from_micros(50);

impl Barrier {
    pub fn new(threads: usize) -> Self {
        Self {
            threads,
            arrived: AtomicUsize::new(0),
            generation: AtomicUsize::new(0),
            broken: AtomicBool::new(false),
        }
    }

    /// Return when all threads have called this. What each wrote before is visible to all
    /// afterwards.
    pub fn wait(&self) {
        if self.threads == 1 {
            return;
        }
        let generation = self.generation.load(Ordering::Acquire);
        if self.arrived.fetch_add(1, Ordering::AcqRel) + 1 == self.threads {
            self.arrived.store(0, Ordering::Relaxed);
            self.generation
                .store(generation.wrapping_add(1), Ordering::Release);
            return;
        }
        let mut spins = 0;
        while self.generation.load(Ordering::Acquire) == generation {
            assert!(
                !self.broken.load(Ordering::Relaxed),
                "another thread of the solver panicked"
            );
            spins += 1;
            match spins {
                ..SPINS => spin_loop(),
                SPINS..YIELDS => yield_now(),
                YIELDS.. => sleep(NAP),
            }
        }
    }

    /// Breaks the barrier if the thread that holds it unwinds.
    pub fn guard(&self) -> Guard<'_> {
        Guard(self)
    }
}

pub(crate) struct Guard<'a>(&'a Barrier);

impl Drop for Guard<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.broken.store(true, Ordering::Relaxed);
        }
    }
}
