//! A load that drains: Terzaghi's theory, and the CPU.
//!
//! p/p0 = Σ 2/m sin(m (1 - z/H)) exp(-m² T), m = π/2, 3π/2, ...
//! Source: Terzaghi (1943), Theoretical Soil Mechanics; `coupling/tests/verification/consolidation.rs`
//! has the same for the CPU, on beds of 1000 grains.

use super::bed::{LOADED, STEP, STRESS, model, pressed, water};
use crate::lab::Suite;
use coupling::{Coupled, skeleton_stiffness};
use dem::{StressLoad, WallMotion};
use shaders::Device;
use std::f64::consts::PI;

pub fn list(suite: &mut Suite) {
    suite.gpu("wet_loaded_bed_consolidates_as_terzaghi_says", consolidates);
}

/// Pressure in a bed over that at first, at the height `z` over that of the bed.
fn terzaghi(z: f64, time: f64) -> f64 {
    let terms = (0..200).map(|k| {
        let m = PI * (k as f64 + 0.5);
        2.0 / m * (m * (1.0 - z)).sin() * (-m * m * time).exp()
    });
    terms.sum()
}

/// Pressure in the lowest cells, means over a wave of the wall on its bed, at T = 0.2 and 0.4: as on
/// the CPU within 5e-4 of it, since that renews weights at searches too, and Terzaghi's within 3 %.
fn consolidates(device: &Device) {
    let (dry, state) = (model(STRESS), pressed());
    let more = LOADED - STRESS;
    let m = skeleton_stiffness(&dry, &state, more, 0.02).unwrap();
    let mut loaded = model(LOADED);
    let WallMotion::Stress(load) = &mut loaded.walls[1].motion else {
        unreachable!("a stress pushes the top");
    };
    *load = StressLoad { mass: 0.5, ..*load };
    let mut pores = water(PERMEABILITY);
    pores.cells = [3, 3, 4];
    pores.stiffness = Some(m);
    let mut gpu =
        coupling::gpu::Coupled::<3>::new(device, loaded, state.clone(), pores.clone(), None)
            .unwrap();
    let mut cpu = Coupled::<3>::new(gpu.grains().model().clone(), state, pores, None, 1).unwrap();
    let report = cpu.report();
    let (storage, height) = (report.storage, report.height);
    let diffusivity = report.permeability / 1.8e-3 / (storage + 1.0 / m);
    let unit = height * height / diffusivity / STEP;
    let first = more / (1.0 + storage * m);
    println!("M {m:.3e} Pa, p0 {first:.0} Pa, {unit:.0} steps for T = 1\n{report}");
    let mut done = 0;
    for time in [0.2, 0.4] {
        let middle = (time * unit) as u64;
        let (mut sums, mut theory) = ([0.0; 2], 0.0);
        for step in (middle - 100..=middle + 100).step_by(25) {
            cpu.advance(step - done).unwrap();
            gpu.advance(step - done).unwrap();
            done = step;
            let base = |pressure: &[f64]| pressure[..9].iter().sum::<f64>() / 9.0;
            sums[0] += base(&cpu.snapshot().pressure);
            sums[1] += base(&gpu.snapshot().unwrap().pressure);
            theory += first * terzaghi(0.125, step as f64 / unit);
        }
        let [cpu, gpu] = sums.map(|sum| sum / theory - 1.0);
        println!(
            "T {time}: {:.0} Pa, CPU {cpu:+.3}, GPU {gpu:+.3}",
            theory / 9.0
        );
        assert!((cpu - gpu).abs() < 5e-4, "T {time}: {cpu} and {gpu}");
        assert!(gpu.abs() < 0.03, "T {time}: {gpu}");
    }
}

const PERMEABILITY: f64 = 1e-11;
