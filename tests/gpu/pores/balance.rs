//! What must balance on the GPU by itself: forces, and the volume of water.

use super::bed::{AREA, STRESS, model, pressed, sheared, water};
use crate::lab::Suite;
use coupling::gpu::Coupled;
use glam::DVec3;
use lbm::Side;
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_forces_on_grains_and_walls_balance", forces);
    suite.gpu("wet_sealed_beds_keep_their_water", sealed);
}

/// The water pushes grains by as much less on the bottom than on the top as they are pushed up, and
/// nowhere sideways; contacts push them as walls are pushed. With weights that are those of the
/// scatter to the last bit this holds to the rounding of the sums of some hundred f32.
fn forces(device: &Device) {
    balanced::<3>(device, [3, 3, 3]);
    balanced::<5>(device, [6, 6, 7]);
}

fn balanced<const N: usize>(device: &Device, cells: [usize; 3]) {
    let (grains, state) = sheared();
    let mut water = water(1e-11);
    water.cells = cells;
    let mut bed = Coupled::<N>::new(device, grains, state, water, None).unwrap();
    for steps in [10, 2, 63] {
        bed.advance(steps).unwrap();
        let now = bed.grains().snapshot().unwrap();
        let water = bed.on_walls().unwrap();
        let sum: DVec3 = now.force.iter().sum();
        let layers = now.held_force + now.driven_force;
        let up = now.wall_force[0] - now.wall_force[1] + water[0] - water[1];
        let size: f64 = now.force.iter().map(|f| f.length()).sum();
        let size = size + now.wall_force[1] + water[1].abs();
        println!(
            "{N}: {:.1e} {:.1e} of {size:.1e} N, water {:.1} N",
            sum.x + layers,
            sum.z - up,
            water[0] - water[1]
        );
        assert!((sum.x + layers).abs() < 1e-6 * size, "{N}: x");
        assert!((sum.z - up).abs() < 1e-6 * size, "{N}: z");
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
