//! A million drifts, against sums of whole numbers.

use crate::lab::{Suite, kernel, map};
use bytemuck::{Pod, Zeroable};
use dem::gpu::wide::Wide;
use shaders::{Device, Flags};

pub fn list(suite: &mut Suite) {
    suite.gpu("a_million_drifts_add_up_exactly", million);
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Start {
    hi: [i32; 3],
    seed: u32,
    lo: [u32; 3],
    scale: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct End {
    hi: [i32; 3],
    unused: u32,
    lo: [u32; 3],
    seed: u32,
    image: [i32; 3],
    scale: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Plan {
    length: [i32; 3],
    steps: u32,
}

const STEPS: u32 = 1_000_000;
/// Added to ways between -2^23 and 2^23, so that grains get on.
const FORWARD: i32 = 1 << 22;
/// Steps of one dispatch: longer ones look to some drivers like a hung device.
const AT_ONCE: u32 = 20_000;

/// Ways of 2^-31 to 2^8 units and both signs, in a box small enough to be left thousands of
/// times. Ways of which f32's last digit is at least a part, 2^-32 unit, add up exactly; those
/// below may lose half a part each.
fn million(device: &Device) {
    let plan = Plan {
        length: [4099, 1021, 0],
        steps: AT_ONCE,
    };
    let exponents = [
        -54, -50, -45, -40, -36, -33, -32, -31, -30, -27, -24, -20, -18, -16,
    ];
    let starts = Vec::from_iter(exponents.iter().enumerate().map(|(k, &exponent)| Start {
        hi: [17, 1020, -3],
        seed: 1 + k as u32,
        lo: [1, 0xFFFF_FFFF, 0],
        scale: 2f32.powi(exponent),
    }));
    let kernel = kernel(
        device,
        "drift.wgsl",
        include_str!("drift.wgsl"),
        &Flags::new(),
    );
    let uniform = device.array_of("plan", &[plan]).unwrap();
    let (mut at, mut images) = (starts.clone(), vec![[0i32; 3]; starts.len()]);
    for _ in 0..STEPS / AT_ONCE {
        let ends: Vec<End> = map(device, &kernel, &at, &[("plan", &uniform)]);
        for ((at, image), end) in at.iter_mut().zip(&mut images).zip(&ends) {
            (at.hi, at.lo, at.seed) = (end.hi, end.lo, end.seed);
            *image = std::array::from_fn(|axis| image[axis] + end.image[axis]);
        }
    }

    let mut left = 0;
    for (k, &exponent) in exponents.iter().enumerate() {
        // The same ways in parts of 2^-32 unit; finer than that, in 2^-64 unit.
        let mut sum = [0i128; 3];
        let mut seed = starts[k].seed;
        for _ in 0..STEPS {
            for sum in &mut sum {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                *sum += i128::from((seed as i32 >> 8) + FORWARD) << (exponent + 64);
            }
        }
        assert_eq!(seed, at[k].seed);
        for axis in 0..3 {
            let parts = |hi, lo| i128::from(Wide { hi, lo }.parts());
            let start = parts(starts[k].hi[axis], starts[k].lo[axis]);
            let end = parts(at[k].hi[axis], at[k].lo[axis]);
            let length = i128::from(plan.length[axis]) << 32;
            let travelled = end - start + i128::from(images[k][axis]) * length;
            let fault = ((travelled << 32) - sum[axis]) as f64 / 2f64.powi(32);
            if length > 0 {
                assert!((0..length).contains(&end), "outside of the box");
                left += images[k][axis].unsigned_abs();
            } else {
                assert_eq!(images[k][axis], 0);
            }
            if exponent >= -32 {
                assert_eq!(fault, 0.0, "scale 2^{exponent}, axis {axis}: {fault} parts");
            } else {
                // Independent roundings of half a part at most: 0.29 sqrt(1e6) = 290 parts.
                println!("scale 2^{exponent}, axis {axis}: off by {fault:.1} parts of 2^-32 unit");
                assert!(
                    fault.abs() < 5.0 * 290.0,
                    "scale 2^{exponent}: {fault} parts"
                );
            }
        }
    }
    println!("the box was left {left} times, net");
    assert!(left > 1000);
}
