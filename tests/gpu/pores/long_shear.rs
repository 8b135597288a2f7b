//! Shear that goes on: how far a GPU parts from the CPU because it renews weights by steps alone, where
//! the CPU renews them with each search of neighbours too.

use super::bed::{AREA, sheared, water};
use crate::lab::Suite;
use coupling::Coupled;
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.long("wet_beds_are_sheared_for_long_as_on_the_cpu", shear);
}

const STEPS: u64 = 4000;
const EVERY: u64 = 40;

/// Mean pressure [Pa] and shear stress [Pa] at some instants.
type Course = Vec<[f64; 2]>;

fn on_cpu(skin: f64) -> Course {
    let (mut grains, state) = sheared();
    grains.skin = Some(skin);
    let mut bed = Coupled::<3>::new(grains, state, water(1e-11), None, 1).unwrap();
    let course = (0..STEPS / EVERY).map(|_| {
        bed.advance(EVERY).unwrap();
        let (water, grains) = (bed.snapshot(), bed.grains().snapshot());
        [mean(&water.pressure), -grains.driven_force / AREA]
    });
    course.collect()
}

fn on_gpu(device: &Device) -> Course {
    let (grains, state) = sheared();
    let mut bed =
        coupling::gpu::Coupled::<3>::new(device, grains, state, water(1e-11), None).unwrap();
    let course = (0..STEPS / EVERY).map(|_| {
        bed.advance(EVERY).unwrap();
        let (water, grains) = (bed.snapshot().unwrap(), bed.grains().snapshot().unwrap());
        [mean(&water.pressure), -grains.driven_force / AREA]
    });
    course.collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Means over the course, and root of the mean square of the difference of two.
fn apart(a: &Course, b: &Course) -> [f64; 2] {
    [0, 1].map(|k| {
        let squares = a.iter().zip(b).map(|(a, b)| (a[k] - b[k]).powi(2));
        (squares.sum::<f64>() / a.len() as f64).sqrt()
    })
}

/// With other skins the CPU renews weights at other steps, and parts from itself: the GPU parts from it no
/// more than twice as far as the farther of two.
fn shear(device: &Device) {
    let seldom = on_cpu(4e-3);
    let others = [1e-3, 4e-4].map(on_cpu);
    let gpu = on_gpu(device);
    let size = apart(&seldom, &vec![[0.0; 2]; seldom.len()]);
    let own = others.map(|other| apart(&seldom, &other));
    let off = apart(&seldom, &gpu);
    println!("of {size:.0?} Pa the CPU parts by {own:.1?} with other skins, the GPU by {off:.1?}");
    for k in 0..2 {
        let allowed = own[0][k].max(own[1][k]);
        assert!(off[k] < 2.0 * allowed + 1e-4 * size[k], "{off:?} {own:?}");
    }
}
