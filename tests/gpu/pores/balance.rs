//! What must balance on the GPU by itself: forces, and the volume of water.

use super::bed::{AREA, LOADED, STRESS, model, pressed, sheared, water};
use crate::lab::Suite;
use coupling::gpu::Coupled;
use glam::DVec3;
use lbm::Side;
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_forces_on_grains_and_walls_balance", forces);
    suite.gpu("wet_sealed_beds_keep_their_water", sealed);
}

/// What the water pushes grains with, before contacts: all of it together is what it pushes the top by
/// more than the bottom, in steps that drag loose grains (10, 12) as in others. Weights of the
/// gather are those of the scatter to the last bit, so this holds to the rounding of some hundred
/// sums in f32; a gather that is off by 1e-5 is seen where no loose
/// grains are dragged. Contacts are left out: their rounding, of
/// forces a hundred times larger, would hide it.
fn forces(device: &Device) {
    balanced::<3>(device, [3, 3, 3]);
    balanced::<5>(device, [6, 6, 7]);
}

fn balanced<const N: usize>(device: &Device, cells: [usize; 3]) {
    let (mut grains, state) = sheared();
    grains.walls[1].motion = model(LOADED).walls[1].motion;
    let mut water = water(1e-11);
    water.cells = cells;
    let mut bed = Coupled::<N>::new(device, grains, state, water, None).unwrap();
    for steps in [10, 2, 63] {
        bed.advance(steps).unwrap();
        let each = bed.grains().pushes_of_companion().unwrap();
        let [bottom, top] = bed.on_walls().unwrap();
        let sum: DVec3 = each.iter().sum();
        let size: f64 = each.iter().map(|f| f.length()).sum();
        let off = sum + DVec3::new(0.0, 0.0, top - bottom);
        println!(
            "{N}: {:.3e} N up on grains, {bottom:.3e} and {top:.3e} on walls, off by {:.1e} of {size:.1e} N",
            sum.z,
            off.length()
        );
        assert!(sum.z.abs() > 1.0, "{N}: hardly a push");
        assert!(off.length() < 1e-6 * size, "{N}");
    }
}

fn height(bed: &Coupled<3>) -> f64 {
    let walls = bed.grains().snapshot().unwrap().state.walls;
    -walls[1].offset - walls[0].offset
}

/// Water in a sealed bed is squeezed by what the walls come together, and by no more: to the
/// rounding of what some hundred steps collect in f32.
fn sealed(device: &Device) {
    let mut water = water(1e-12);
    water.sides[1] = Side::FreeSlip;
    let mut bed = Coupled::<3>::new(device, model(1.5 * STRESS), pressed(), water, None).unwrap();
    let before = height(&bed);
    let mut sunk: f64 = 0.0;
    for steps in [50, 100, 150] {
        bed.advance(steps).unwrap();
        let content = bed.snapshot().unwrap().content;
        let squeezed = AREA * (before - height(&bed));
        println!("{content:.6e} of {squeezed:.6e} m3");
        sunk = sunk.max(squeezed.abs());
        assert!(
            (content - squeezed).abs() < 1e-5 * sunk,
            "{content:e} {squeezed:e}"
        );
    }
    assert!(sunk > 1e-9, "the walls came together by {sunk:e} m3");
}
