//! The same bits, however many steps are asked for at a time, and from a second run.

use super::bed::{Bed, sheared, water};
use crate::lab::Suite;
use coupling::gpu::Coupled;
use coupling::{Snapshot, State};
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_runs_repeat_to_the_bit", repeat);
}

fn go(device: &Device, parts: &[u64]) -> (Snapshot, State, dem::Snapshot) {
    let (grains, state) = sheared();
    let bed = Bed {
        grains,
        state,
        water: water(1e-11),
    };
    let mut coupled = Coupled::<3>::new(device, bed.grains, bed.state, bed.water, None).unwrap();
    for &steps in parts {
        coupled.advance(steps).unwrap();
    }
    let now = coupled.grains().snapshot().unwrap();
    (coupled.snapshot().unwrap(), coupled.state().unwrap(), now)
}

fn repeat(device: &Device) {
    let whole = go(device, &[200]);
    for parts in [&[200][..], &[1, 63, 1, 2, 60, 3, 70]] {
        let again = go(device, parts);
        assert!(whole.0 == again.0, "the water of {parts:?} is another one");
        assert!(whole.1 == again.1, "loads of {parts:?} are others");
        assert!(
            whole.2.state == again.2.state,
            "grains of {parts:?} lie elsewhere"
        );
    }
}
