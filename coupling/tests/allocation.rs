//! Nothing is allocated in a coupled step, however many of them there are: between two renewals of
//! the weights water and grains meet in the memory where they live.

#[path = "verification/bed.rs"]
#[allow(
    dead_code,
    reason = "this test takes the bed and its water, the others more"
)]
mod bed;

use coupling::{Coupled, Model};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The allocator of the system, and how often it was asked.
struct Counting;

static ASKED: AtomicUsize = AtomicUsize::new(0);

// SAFETY: all is left to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ASKED.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise; so below.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ASKED.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of so many steps of a bed with a fluid step in each.
fn allocations<const N: usize>(threads: usize, mut water: Model) {
    let finer = N / 2;
    water.cells = water.cells.map(|cells| finer * cells);
    water.interval = Some(1);
    water.renewal = Some(1 << 30);
    let model = bed::model(bed::law(), bed::STRESS);
    let mut bed = Coupled::<N>::new(model, bed::pressed(), water, None, threads).unwrap();
    bed.advance(100).unwrap();
    let searches = bed.grains().searches();
    let mut of = |steps: u64| {
        let before = ASKED.load(Ordering::Relaxed);
        bed.advance(steps).unwrap();
        ASKED.load(Ordering::Relaxed) - before
    };
    // The threads begin and end.
    let (few, many) = (of(1), of(400));
    assert_eq!(
        bed.grains().searches(),
        searches,
        "neighbours were searched"
    );
    assert_eq!(
        few, many,
        "allocations in 1 and in 400 steps on {threads} threads"
    );
}

#[test]
fn coupled_steps_allocate_nothing() {
    for threads in [1, 2] {
        allocations::<3>(threads, bed::water(1e-12));
        allocations::<5>(threads, bed::water(1e-12));
        let through = Model {
            sides: [bed::drained(), bed::drained()],
            ..bed::water(1e-12)
        };
        allocations::<3>(threads, through);
    }
}
