//! Bytes that cross between host and device while a coupled bed goes on.

use super::bed::{LOADED, model, pressed, sheared, water};
use crate::lab::Suite;
use coupling::gpu::Coupled;
use shaders::{Device, Traffic};

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_steps_leave_fields_and_grains_on_the_device", traffic);
    suite.gpu("wet_steps_between_exchanges_are_dry_ones", dispatches);
}

/// Bytes of 130 steps with two renewals, for a lattice of so many cells.
fn of<const N: usize>(device: &Device, cells: [usize; 3]) -> Traffic {
    let mut water = water(1e-12);
    water.cells = cells;
    water.interval = Some(16);
    let mut bed = Coupled::<N>::new(device, model(LOADED), pressed(), water, None).unwrap();
    let before = device.traffic();
    bed.advance(130).unwrap();
    let after = device.traffic();
    // A reading is seen.
    bed.snapshot().unwrap();
    let fields = device.traffic().read - after.read;
    let count = cells.iter().product::<usize>() as u64;
    assert!(fields >= 40 * count, "{fields} bytes for {count} cells");
    Traffic {
        written: after.written - before.written,
        read: after.read - before.read,
        dispatches: after.dispatches - before.dispatches,
    }
}

/// How far the device is comes back after each group of steps, and the extremes of the bed at a
/// renewal; the ends of groups, numbers of the lattice and what sides give go there. None of it
/// grows with grains or cells: an array of a word for each of the 300 grains is 1200 bytes, one for
/// each of 252 cells 1008, and a group brings 164 at most.
fn traffic(device: &Device) {
    // A device of its own: other tests write to the one that they share.
    let device = &Device::open_adapter((*device.adapter).clone()).unwrap();
    let coarse = of::<3>(device, [3, 3, 3]);
    println!("{coarse:?}");
    // Groups: 0 to 64, 65, 128, 129, 130; searches and the end of `advance` ask once more.
    assert!(coarse.read <= 10 * 164, "{coarse:?}");
    assert!(coarse.written <= 10 * 1000, "{coarse:?}");
    let fine = of::<3>(device, [6, 6, 7]);
    println!("{fine:?}");
    assert_eq!(coarse.read, fine.read);
}

/// Dispatches: one a step, five an exchange with one more where loose grains are dragged, and for each fluid
/// step three and those of the lattice.
fn dispatches(device: &Device) {
    let device = &Device::open_adapter((*device.adapter).clone()).unwrap();
    let of = |every: u64| {
        let mut water = water(1e-12);
        water.interval = Some(16);
        water.exchange = Some(every);
        // None of it renews.
        water.renewal = Some(1 << 20);
        // So wide a skin that no group ends early.
        let (mut grains, state) = sheared();
        grains.step /= 4.0;
        let mut bed = Coupled::<3>::new(device, grains, state, water, None).unwrap();
        let made = |bed: &mut Coupled<3>, steps| {
            let before = device.traffic().dispatches;
            bed.advance(steps).unwrap();
            device.traffic().dispatches - before
        };
        // Lists are looked at after 64 steps: no group ends in between. What does not grow with the
        // steps is the order of the grains, searches, the end of a group.
        let whole = made(&mut bed, 64);
        whole - made(&mut bed, 16)
    };
    for (every, drags_every) in [(1, 4), (2, 4), (8, 8)] {
        let found = of(every);
        // In 48 more steps.
        let expected = 48 + 5 * 48 / every + 48 / drags_every + 3 * (3 + 1);
        println!("every {every}: {found} dispatches more in 48 steps");
        assert_eq!(found, expected, "every {every}");
    }
}
