//! Grains that settle in clear water: one alone, and suspensions.

use crate::loose::*;
use coupling::Resistance;
use glam::DVec3;
use lbm::Fluid;

const LAW: Resistance = Resistance::DiFelice { diameter: DIAMETER };

/// Mean velocity of one grain over its way through two cells, over that of the law, in a box of
/// `across` cells of `cell` diameters along x and y.
fn alone(across: usize, cell: f64) -> f64 {
    let dx = cell * DIAMETER;
    let layers = (26.0 / cell).ceil() as usize + 4;
    let size = [across as f64 * dx, across as f64 * dx, layers as f64 * dx];
    let start = size[2] - 2.0 * dx;
    let place = DVec3::new(0.37 * dx, 0.21 * dx, start);
    let mut bed = closed(WATER, LAW, &[place], size, [across, across, layers]);
    // A way of 15 diameters to get to speed, 8 to measure.
    let height = |bed: &coupling::Coupled<3>| bed.grains().snapshot().state.grains.position[0].z;
    let mut steps = 0;
    while height(&bed) > start - 15.0 * DIAMETER {
        bed.advance(50).unwrap();
        steps += 1;
        assert!(steps < 4000, "it does not fall");
    }
    let (from, mut made) = (height(&bed), 0);
    while height(&bed) > from - 8.0 * DIAMETER {
        bed.advance(10).unwrap();
        made += 10;
    }
    let velocity = (from - height(&bed)) / (made as f64 * STEP);
    velocity / balance(LAW, 1e-9)
}

/// What a grain is off by that is not resolved: its own fraction of solid, and the water that it
/// drags along where there is room beside it. Cells of diameters: across, size.
#[test]
fn a_single_grain_settles_by_the_drag_law() {
    let cases = [
        (1, 2.5, 0.02),
        (1, 4.0, 0.005),
        (3, 4.0, 0.01),
        (4, 2.0, 0.04),
    ];
    for (across, cell, most) in cases {
        let ratio = alone(across, cell);
        println!("{across} x {across} cells of {cell} d: {ratio:.4}");
        assert!(
            (ratio - 1.0).abs() < most,
            "{across} cells of {cell} d: {ratio}"
        );
    }
}

/// Mean velocity of a suspension of this solid fraction in a closed box, half way up, the fraction
/// there, and convection of momentum, which is left out, over the drag.
fn together(fluid: Fluid, solid: f64, across: usize, cell: f64, seed: u64) -> [f64; 3] {
    let dx = cell * DIAMETER;
    let layers = (40.0 / cell).round() as usize;
    let size = [across as f64 * dx, across as f64 * dx, layers as f64 * dx];
    let places = scattered(size, solid, seed);
    let mut bed = closed(fluid, LAW, &places, size, [across, across, layers]);
    bed.advance(2500).unwrap();
    let (mut sum, mut count, mut times) = (0.0, 0, 0);
    for _ in 0..30 {
        bed.advance(60).unwrap();
        let state = bed.grains().snapshot().state;
        // Above what has come to lie, below what has become clear.
        let window = 0.35 * size[2]..0.65 * size[2];
        for k in 0..places.len() {
            if window.contains(&state.grains.position[k].z) {
                sum -= state.grains.velocity[k].z;
                count += 1;
            }
        }
        times += 1;
    }
    let volume = std::f64::consts::PI / 6.0 * DIAMETER.powi(3);
    let room = 0.3 * size[2] * size[0] * size[1] * times as f64;
    let left_out = bed.report().convection.expect("the water moves");
    [sum / count as f64, count as f64 * volume / room, left_out]
}

/// Slope of ln v against ln(1 - c).
fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs = points.iter().map(|(v, c)| ((1.0 - c).ln(), v.ln()));
    let logs: Vec<(f64, f64)> = logs.collect();
    let n = logs.len() as f64;
    let (x, y) = (
        logs.iter().map(|p| p.0).sum::<f64>() / n,
        logs.iter().map(|p| p.1).sum::<f64>() / n,
    );
    let up: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    up / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// Suspensions of two fractions, each against the law; the exponent that they give, the Reynolds
/// number of a single grain, and the most that convection would be of the drag.
fn suspensions(fluid: Fluid) -> [f64; 3] {
    let single = balance_in(fluid, LAW, 1e-9);
    let (mut points, mut left_out) = (Vec::new(), 0.0f64);
    for solid in [0.1, 0.3] {
        let [v, c, convection] = together(fluid, solid, 2, 3.0, 1);
        let law = balance_in(fluid, LAW, c);
        println!(
            "c {c:.4}: v/v_t {:.4}, by the law {:.4}, convection {convection:.1e} of drag",
            v / single,
            law / single
        );
        assert!((v / law - 1.0).abs() < 0.03, "{v} of {law} at {c}");
        points.push((v, c));
        left_out = left_out.max(convection);
    }
    let reynolds = fluid.density * single * DIAMETER / fluid.viscosity;
    [exponent(&points), reynolds, left_out]
}

/// Grains of 1 mm: a Reynolds number of 140, where the exponent is 4.45 Re^-0.1.
#[test]
fn suspensions_settle_as_richardson_and_zaki_say() {
    let [n, reynolds, left_out] = suspensions(WATER);
    assert!((1.0..500.0).contains(&reynolds), "{reynolds}");
    let theory = 4.45 * reynolds.powf(-0.1);
    println!("exponent {n} of {theory}");
    assert!((n / theory - 1.0).abs() < 0.1, "{n} of {theory}");
    assert!((1e-3..0.1).contains(&left_out), "{left_out}");
}

/// Below a Reynolds number of 0.2 the exponent is 4.65 by Richardson and Zaki; later measurements are
/// up to 5.
#[test]
fn in_the_range_of_stokes_too() {
    let [n, reynolds, left_out] = suspensions(SYRUP);
    println!("exponent {n} at Re {reynolds}");
    assert!(reynolds < 0.2, "{reynolds}");
    assert!((n / 4.65 - 1.0).abs() < 0.02, "{n}");
    assert!(left_out < 1e-3, "{left_out}");
}

/// The water stands at a tight lid, and drags what falls from there as it does elsewhere: in high
/// cells, most of it is in the half cell below the lid at first.
#[test]
fn a_grain_that_starts_at_the_lid_is_dragged_too() {
    let size = [4e-3, 4e-3, 28e-3];
    let place = DVec3::new(1.5e-3, 0.8e-3, size[2] - 0.6 * DIAMETER);
    let mut bed = closed(WATER, LAW, &[place], size, [1, 1, 7]);
    let mut fastest = 0.0f64;
    for _ in 0..100 {
        bed.advance(50).unwrap();
        let velocity = bed.grains().snapshot().state.grains.velocity[0];
        fastest = fastest.max(-velocity.z);
    }
    let ratio = fastest / balance(LAW, 1e-9);
    println!("at most {ratio:.4} of its terminal velocity");
    assert!((0.98..1.01).contains(&ratio), "{ratio}");
}
