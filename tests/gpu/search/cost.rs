//! What a search costs, on whatever device there is.

use super::bed::{Bed, World};
use super::*;
use std::time::Instant;

pub fn list(suite: &mut Suite) {
    suite.long("a_search_takes", a_search_takes);
}

fn a_search_takes(device: &Device) {
    println!("{}", device.adapter.describe());
    for along in [22, 46, 80] {
        let bed = Bed::lattice(along);
        let n = bed.len();
        let world = World::new(device, &bed, 0, 6 * n);
        world.search();
        device.wait().unwrap();
        let start = Instant::now();
        for _ in 0..5 {
            world.search();
        }
        device.wait().unwrap();
        let search = 1e3 * start.elapsed().as_secs_f64() / 5.0;

        // Checks that find nothing to do, as most do.
        let start = Instant::now();
        let mut recording = device.record();
        for _ in 0..20 {
            world.search.record(&mut recording);
        }
        recording.submit().unwrap();
        device.wait().unwrap();
        let check = 1e3 * start.elapsed().as_secs_f64() / 20.0;

        let control = world.control();
        // The sides along z are open.
        let entries = 6 * n - 2 * (along * along) as usize;
        assert_eq!((control.flags, control.entries as usize), (0, entries));
        let bytes = world.search.bytes() / n as u64;
        println!(
            "{n} grains: search {search:.2} ms, check {check:.3} ms, \
             scratch {bytes} B a grain"
        );
    }
}
