//! A cube of water driven by its lid, at Reynolds number 1000.
//!
//! Source: Albensoeder and Kuhlmann (2005), J. Comput. Phys. 206, 536, tables 5 and 6 (a spectral
//! solution), as transcribed in the tests of PICT (github.com/tum-pbs/PICT).

use crate::common::{free, no_slip};
use lbm::{Ends, Model, Real, Side, Solver, State};

/// Velocity along the lid's over height below the lid, both from the middle: (x, v) of table 5.
const ALONG: [[f64; 2]; 15] = [
    [-0.4766, 0.58964],
    [-0.4688, 0.48443],
    [-0.4609, 0.39821],
    [-0.4531, 0.33171],
    [-0.3516, 0.12183],
    [-0.2344, 0.07334],
    [-0.1172, 0.03905],
    [0.0, 0.00802],
    [0.0469, -0.00612],
    [0.2187, -0.10999],
    [0.3281, -0.25160],
    [0.3984, -0.27293],
    [0.4297, -0.23696],
    [0.4375, -0.22283],
    [0.4453, -0.20623],
];

/// Velocity away from the lid over the length along it: (y, u) of table 6.
const AWAY: [[f64; 2]; 15] = [
    [-0.4375, -0.21738],
    [-0.4297, -0.22746],
    [-0.4219, -0.23503],
    [-0.4062, -0.24407],
    [-0.3437, -0.22924],
    [-0.2734, -0.17580],
    [-0.2656, -0.16987],
    [0.0, -0.03674],
    [0.3047, 0.15223],
    [0.3594, 0.31117],
    [0.4063, 0.43423],
    [0.4453, 0.33511],
    [0.4531, 0.29032],
    [0.4609, 0.24095],
    [0.4688, 0.18864],
];

/// How far a run is from the tables.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// √(Σ(u - v)² / Σv²) over both tables.
    pub mean: f64,
    /// Of the three values at the extremes of the profiles, the greatest deviation of one.
    pub extremes: f64,
    /// What the profiles still changed in the last tenth of the time, in the norm of `mean`.
    pub drift: f64,
}

/// `n` cells along the lid, which moves by `speed` cells a step for `time` times its length.
/// Only one half is computed: flow is symmetric about the middle plane.
pub fn cavity<T: Real>(n: usize, speed: f64, time: f64, threads: usize) -> Deviation {
    let lid = Side::NoSlip([speed, 0.0, 0.0]);
    let model = Model {
        ends: [
            no_slip(),
            Ends::Walls(Side::NoSlip([0.0; 3]), Side::FreeSlip),
            Ends::Walls(Side::NoSlip([0.0; 3]), lid),
        ],
        inertia: true,
        speed,
        step: Some(1.0),
        ..free([n, n / 2, n], speed * n as f64 / 1000.0)
    };
    let mut solver = Solver::<T>::new(model.clone(), State::at_rest(&model), threads).unwrap();
    let steps = (time * n as f64 / speed) as u64;
    solver.advance(steps - steps / 10).unwrap();
    let before = profiles(&solver.snapshot().flux, n, speed);
    solver.advance(steps / 10).unwrap();
    let found = profiles(&solver.snapshot().flux, n, speed);

    let exact: Vec<f64> = ALONG.iter().chain(&AWAY).map(|row| row[1]).collect();
    let distance = |a: &[f64], b: &[f64]| {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        (square / exact.iter().map(|v| v * v).sum::<f64>()).sqrt()
    };
    // Rows 11 of the first table, 3 and 10 of the second one.
    let extremes = [11, 15 + 3, 15 + 10].map(|row| (found[row] / exact[row] - 1.0).abs());
    Deviation {
        mean: distance(&found, &exact),
        extremes: extremes.into_iter().fold(0.0, f64::max),
        drift: distance(&found, &before),
    }
}

/// What the tables hold, over the lid's speed.
fn profiles(flux: &[[f64; 3]], n: usize, speed: f64) -> Vec<f64> {
    // On the middle plane, by symmetry, and between the two cells beside the middle line.
    let value = |x: usize, z: usize, axis: usize| {
        let at = |y: usize| flux[(z * (n / 2) + y) * n + x][axis];
        (9.0 * at(n / 2 - 1) - at(n / 2 - 2)) / 8.0 / speed
    };
    let upward = |k: usize| (value(n / 2 - 1, k, 0) + value(n / 2, k, 0)) / 2.0;
    let forward = |k: usize| (value(k, n / 2 - 1, 2) + value(k, n / 2, 2)) / 2.0;
    let u: Vec<f64> = (0..n).map(upward).collect();
    let w: Vec<f64> = (0..n).map(forward).collect();
    let along = ALONG.iter().map(|[x, _]| between(&u, 0.0, 1.0, 0.5 - x));
    let away = AWAY.iter().map(|[y, _]| -between(&w, 0.0, 0.0, y + 0.5));
    along.chain(away).collect()
}

/// The cubic through the four nodes around `x` of values at the centres of cells of a unit
/// length and at its two ends.
fn between(values: &[f64], lower: f64, upper: f64, x: f64) -> f64 {
    let n = values.len();
    let node = |i: usize| match i {
        0 => [0.0, lower],
        i if i > n => [1.0, upper],
        i => [(i as f64 - 0.5) / n as f64, values[i - 1]],
    };
    let right = (1..n + 1).find(|&i| node(i)[0] > x).unwrap_or(n + 1);
    let first = right.saturating_sub(2).min(n - 2);
    let nodes = [0, 1, 2, 3].map(|i| node(first + i));
    let weight = |i: usize| -> f64 {
        let others = (0..4).filter(|&j| j != i);
        others
            .map(|j| (x - nodes[j][0]) / (nodes[i][0] - nodes[j][0]))
            .product()
    };
    (0..4).map(|i| weight(i) * nodes[i][1]).sum()
}

/// Second order: from 48 cells to 96 the deviation falls to less than a quarter. At 48 it is
/// below the 8 % that a quarter of is the 2 % asked for at 96; the three extremes, of which the
/// greatest lies within two cells of the lid, below 9 %.
#[test]
fn a_lid_drives_a_cube() {
    let found = cavity::<f32>(48, 0.15, 40.0, 1);
    assert!(found.mean < 8e-2 && found.extremes < 9e-2, "{found:?}");
    assert!(found.drift < 2e-3, "{found:?}");
}

/// To 2 % at 96 cells along an edge.
#[test]
#[ignore = "two to ten minutes"]
fn a_lid_drives_a_cube_of_96_cells() {
    let found = cavity::<f32>(96, 0.15, 60.0, 2);
    assert!(found.mean < 2e-2 && found.extremes < 2e-2, "{found:?}");
    assert!(found.drift < 1e-3, "{found:?}");
}
