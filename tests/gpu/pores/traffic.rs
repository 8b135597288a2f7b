//! Bytes that cross between host and device while a coupled bed goes on.

use super::bed::{LOADED, model, pressed, water};
use crate::lab::Suite;
use coupling::gpu::Coupled;
use shaders::{Device, Traffic};

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_steps_leave_fields_and_grains_on_the_device", traffic);
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
