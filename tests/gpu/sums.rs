//! Running sums of two words: whatever the order, the same bits, and those of 128 bits.

use crate::lab::{Suite, kernel, map};
use dem::contact::Tension;
use dem::gpu::wide::Wide;
use dem::{Error, Surface, gpu};
use glam::DVec3;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::{Device, Flags};
use tests::bed::Bed;
use tests::{RADIUS, floor, mass, model, smooth, state};

pub fn list(suite: &mut Suite) {
    suite.gpu("sums_of_all_threads_have_the_same_bits_in_any_order", order);
    suite.gpu("numbers_go_to_two_words_and_back", there_and_back);
    suite.gpu("sums_that_overflow_say_so", overflow);
    suite.gpu("sums_of_wide_beds_do_not_fill", wide);
    suite.gpu("impacts_beyond_the_sums_are_a_clear_error", impacts);
}

const ADD: &str = "
    #import dem::wide::{widen, add_to_sum}
    @group(0) @binding(0) var<storage, read> inputs: array<f32>;
    @group(0) @binding(1) var<storage, read_write> outputs: array<u32>;
    @compute @workgroup_size(64)
    fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        if id.x < arrayLength(&inputs) {
            outputs[id.x] = u32(add_to_sum(id.x % 3u, widen(inputs[id.x])));
        }
    }";

/// Numbers of 2^-40 to 2^12 units and both signs; the three sums take every third of them.
fn numbers() -> Vec<f32> {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let mut number = || {
        let size = f32::exp2(random.random_range(-40.0..12.0));
        if random.random() { size } else { -size }
    };
    (0..300_000).map(|_| number()).collect()
}

/// The sums after each of `rounds`.
fn add_up(device: &Device, rounds: &[Vec<f32>]) -> (Vec<Wide>, Vec<u32>) {
    let kernel = kernel(device, "sums.wgsl", ADD, &Flags::new());
    let sums = device.array::<Wide>("sums", 3).unwrap();
    let mut fits = Vec::new();
    for round in rounds {
        fits.extend(map::<_, u32>(device, &kernel, round, &[("sums", &sums)]));
    }
    (device.read(&sums).unwrap(), fits)
}

fn order(device: &Device) {
    let mut numbers = numbers();
    let mut exact = [0i128; 3];
    for (k, &x) in numbers.iter().enumerate() {
        exact[k % 3] += i128::from(Wide::widen(f64::from(x)).unwrap().parts());
    }
    let first = add_up(device, &[numbers.clone()]);
    assert!(first.1.iter().all(|&fits| fits == 1));
    for (sum, exact) in first.0.iter().zip(exact) {
        assert_eq!(i128::from(sum.parts()), exact);
    }
    // Shuffled within each of the three, and in pieces.
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut each: [Vec<f32>; 3] = Default::default();
    for (k, x) in numbers.drain(..).enumerate() {
        each[k % 3].push(x);
    }
    each.iter_mut().for_each(|sum| sum.shuffle(&mut random));
    let mixed = Vec::from_iter((0..300_000).map(|k| each[k % 3][k / 3]));
    let pieces = mixed.chunks(3 * 17_321).map(<[f32]>::to_vec);
    assert_eq!(add_up(device, &Vec::from_iter(pieces)).0, first.0);
}

fn there_and_back(device: &Device) {
    let text = "
        #import dem::wide::{Wide, widen, narrow, fits}
        struct Back { wide: Wide, narrow: f32, fits: u32 }
        @group(0) @binding(0) var<storage, read> inputs: array<f32>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<Back>;
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            if id.x < arrayLength(&inputs) {
                let w = widen(inputs[id.x]);
                outputs[id.x] = Back(w, narrow(w), u32(fits(inputs[id.x])));
            }
        }";
    #[repr(C)]
    #[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
    struct Back {
        wide: Wide,
        narrow: f32,
        fits: u32,
    }
    let kernel = kernel(device, "back.wgsl", text, &Flags::new());
    let mut inputs = numbers();
    let most = Wide::MOST as f32;
    let largest = f32::from_bits(most.to_bits() - 1);
    inputs.extend([
        0.0,
        -0.0,
        1.0,
        -1.0,
        largest,
        -largest,
        0.99999994,
        -0.99999994,
    ]);
    inputs.extend([1e-30, -1e-30, 3.0 * 2f32.powi(-33), 16_777_215.0]);
    let backs: Vec<Back> = map(device, &kernel, &inputs, &[]);
    for (x, back) in inputs.iter().zip(&backs) {
        let twin = Wide::widen(f64::from(*x)).unwrap();
        assert_eq!(back.wide, twin, "{x:e}");
        let fault = (f64::from(back.narrow) - back.wide.units()).abs();
        assert!(
            fault <= 1.5 * f64::from(f32::EPSILON) * back.wide.units().abs(),
            "{x:e}"
        );
        assert_eq!(back.fits, 1);
    }
    let nowhere = map::<_, Back>(device, &kernel, &[f32::NAN, -f32::NAN], &[]);
    assert!(nowhere.iter().all(|back| back.fits == 0));
    let beyond = [most, -most, 2.0 * most, -f32::MAX];
    for back in map::<_, Back>(device, &kernel, &beyond, &[]) {
        assert_eq!(back.fits, 0);
        assert_eq!(back.narrow.abs(), most, "does not saturate");
    }
}

fn overflow(device: &Device) {
    // Three sums: up, down, and one that stays within.
    let numbers = Vec::from_iter((0..64 * 3).map(|k| [4e7, -4e7, 1e7][k % 3]));
    let fits = add_up(device, &[numbers]).1;
    let refused: [usize; 3] =
        std::array::from_fn(|slot| (0..64).filter(|k| fits[3 * k + slot] == 0).count());
    // 2^30 / 4e7 = 26.8: the 27th and all that follow.
    assert_eq!(refused, [38, 38, 0]);
}

/// Four thousand grains beside each other press a floor with a hundredth of k_n R each: what one wall
/// feels in 300 steps is three times what a sum in units of k_n R alone would hold.
fn wide(device: &Device) {
    const ALONG: usize = 64;
    const STEPS: u64 = 300;
    let stiffness = 1e6;
    let weight = 0.01 * stiffness * RADIUS;
    let spacing = 2.4 * RADIUS;
    let place = |k: usize| {
        let (x, y) = ((k % ALONG) as f64 + 0.5, (k / ALONG) as f64 + 0.5);
        let z = RADIUS - weight / stiffness;
        (DVec3::new(x * spacing, y * spacing, z), RADIUS)
    };
    let grains = Vec::from_iter((0..ALONG * ALONG).map(place));
    let state = state(&grains, 1);
    let mut model = model(smooth(stiffness, 0.0, Tension::Clip), &state.grains);
    model.domain.size = [spacing * ALONG as f64; 2];
    model.walls = vec![floor(Surface::Frictionless)];
    model.gravity = DVec3::NEG_Z * weight / mass(RADIUS);
    let mut solver = gpu::Solver::new(device, model, state).unwrap();
    solver.advance(STEPS).unwrap();
    let mean = solver.snapshot().unwrap().sums.wall_force[0] / STEPS as f64;
    let expected = weight * (ALONG * ALONG) as f64;
    // Forces are rounded to f32, the same way in all of them.
    assert!(
        (mean / expected - 1.0).abs() < 1e-6,
        "{mean} of {expected} N"
    );
}

/// Grains that cross a fifth of their radius in a step lose more than any sum holds.
fn impacts(device: &Device) {
    let bed = Bed::new(2000, 12.0, 0.5, 3);
    let mut state = bed.loose();
    let model = bed.model(&state);
    let speed = 0.2 * 0.5 / model.step;
    for velocity in &mut state.grains.velocity {
        *velocity = speed * velocity.normalize();
    }
    let mut solver = gpu::Solver::new(device, model, state).unwrap();
    let error = solver.advance(4000).unwrap_err();
    let Error::Unstable { what, .. } = &error else {
        panic!("{error}");
    };
    assert!(what.contains("a running sum is full"), "{error}");
}
