//! The ready-made experiments of water meet their exact solutions, through the program and its
//! files. Shorter forms of them where they take seconds.

use super::{go, last, ready, values};
use experiments::scene::water::kozeny_carman;
use experiments::water::Outcome;
use std::f64::consts::PI;
use std::path::Path;

/// Kinematic viscosity of cold water [m²/s].
const NU: f64 = 1.792e-3 / 999.8;

/// √(Σ(a - b)² / Σb²)
fn relative_error(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (difference / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// Velocity along x of a column of 32 cells at the end of a run.
fn profile(name: &str, out: &Path) -> Vec<f64> {
    let summary = go(&ready(name, &[]), out);
    assert_eq!(summary.outcome, Outcome::Steady);
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    last(out, "velocity", 3 * 32)
        .chunks(3)
        .map(|u| u[0])
        .collect()
}

/// `fluid.nc` keeps seven digits.
const DIGITS: f64 = 1.2e-7;

#[test]
fn poiseuille_is_the_parabola() {
    let folder = tempfile::tempdir().unwrap();
    let found = profile("poiseuille", folder.path());
    let exact: Vec<f64> = (0..32)
        .map(|k| (f64::from(k) + 0.5) / 32.0 * 1e-3)
        .map(|z| 0.01 / (2.0 * NU) * z * (1e-3 - z))
        .collect();
    assert!(relative_error(&found, &exact) < DIGITS);
    let series = values(&folder.path().join("series.nc"), "flux_x");
    // Half-way walls: the mean of the cells is off by H²/(2n²) of the parabola's, a 2048th.
    let mean = 0.01 * 1e-6 / (12.0 * NU) * (1.0 + 1.0 / 2048.0);
    assert!((series.last().unwrap() / mean - 1.0).abs() < 1e-9);
}

#[test]
fn couette_is_the_straight_line() {
    let folder = tempfile::tempdir().unwrap();
    let found = profile("couette", folder.path());
    let exact: Vec<f64> = (0..32)
        .map(|k| 1e-3 * (f64::from(k) + 0.5) / 32.0)
        .collect();
    assert!(relative_error(&found, &exact) < DIGITS);
}

/// At 32 cells a wave and four times the step viscosity is right to 0.5 %; the scene's own 64
/// cells have a quarter of that error.
#[test]
fn taylor_green_decays_with_the_viscosity_of_water() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = [
        "water.spacing=312.5 um",
        "box.size=[\"10 mm\", \"312.5 um\", \"10 mm\"]",
        "water.step=2 ms",
    ];
    go(&ready("taylor-green", &coarse), folder.path());
    let file = folder.path().join("series.nc");
    let (time, energy) = (values(&file, "time"), values(&file, "kinetic_energy"));
    let (first, last) = (time.len() / 10, time.len() - 1);
    let rate = (energy[first] / energy[last]).ln() / (time[last] - time[first]);
    let exact = 4.0 * NU * (2.0 * PI / 0.01).powi(2);
    assert!((rate / exact - 1.0).abs() < 5e-3, "{rate} {exact}");
}

/// Re 100 on 40 cells: the extremes of Marchi et al. (2009) to 2 %; the scene's own 64 cells are
/// 0.4 % off.
#[test]
fn the_lid_drives_the_vortex_of_the_tables() {
    let folder = tempfile::tempdir().unwrap();
    let n = 40;
    let coarse = [
        "water.spacing=250 um",
        "box.size=[\"10 mm\", \"250 um\", \"10 mm\"]",
        "end.steady=1e-4",
    ];
    let summary = go(&ready("cavity", &coarse), folder.path());
    assert_eq!(summary.outcome, Outcome::Steady);
    let flow = last(folder.path(), "velocity", 3 * n * n);
    let lid = 17.9236e-3;
    let at = |x: usize, z: usize, axis: usize| flow[3 * (z * n + x) + axis] / lid;
    let u = (0..n).map(|z| 0.5 * (at(n / 2 - 1, z, 0) + at(n / 2, z, 0)));
    let w: Vec<f64> = (0..n)
        .map(|x| 0.5 * (at(x, n / 2 - 1, 2) + at(x, n / 2, 2)))
        .collect();
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::min);
    let found = [
        least(&mut u.clone()),
        least(&mut w.iter().copied()),
        -least(&mut w.iter().map(|w| -w)),
    ];
    for (found, known) in found.iter().zip([-0.21404, -0.25380, 0.17957]) {
        assert!((found / known - 1.0).abs() < 2e-2, "{found} {known}");
    }
}

/// Terzaghi (1943).
#[test]
fn the_column_drains_as_terzaghi_says() {
    let folder = tempfile::tempdir().unwrap();
    go(&ready("terzaghi-column", &[]), folder.path());
    let (out, n) = (folder.path(), 32);
    let time = *values(&out.join("fluid.nc"), "time").last().unwrap();
    let age = 1e-15 / (1.792e-3 * 0.4 * 5.09e-10) * time;
    let exact: Vec<f64> = (0..n)
        .map(|k| {
            let z = (f64::from(k) + 0.5) / f64::from(n);
            let term = |m: u32| {
                let m = PI * (2.0 * f64::from(m) + 1.0) / 2.0;
                2.0 / m * (m * (1.0 - z)).sin() * (-m * m * age).exp()
            };
            1e4 * (0..50).map(term).sum::<f64>()
        })
        .collect();
    let found = last(out, "pressure", n as usize);
    assert!(relative_error(&found, &exact) < 1e-3, "{found:?}");
    // What leaves at the top is missing in the box.
    let content = values(&out.join("series.nc"), "content");
    let pressure: f64 = found.iter().sum::<f64>() / f64::from(n);
    let held = pressure * 0.4 * 5.09e-10 * 0.03125f64.powi(2);
    assert!((content.last().unwrap() / held - 1.0).abs() < 1e-6);
}

/// Amplitude and phase of the last day at three depths, against cosh((1 + i) z/δ).
#[test]
fn the_wave_sinks_in_with_its_skin_depth() {
    let folder = tempfile::tempdir().unwrap();
    go(&ready("skin-depth", &[]), folder.path());
    let file = folder.path().join("fluid.nc");
    let (time, pressure) = (values(&file, "time"), values(&file, "pressure"));
    let (n, day) = (80, 86400.0);
    let skin = (1e-16 / (1.792e-3 * 0.3 * 5.09e-10) * day / PI).sqrt();
    let rows = time.len() - 24..time.len();
    for depth_in_cells in [2, 13, 26] {
        let cell = n - 1 - depth_in_cells;
        // Least squares for p = sine · sin ωt + cosine · cos ωt.
        let mut sums = [0.0; 5];
        for row in rows.clone() {
            let (p, phase) = (pressure[row * n + cell], 2.0 * PI * time[row] / day);
            let (s, c) = phase.sin_cos();
            for (sum, term) in sums.iter_mut().zip([s * s, c * c, s * c, p * s, p * c]) {
                *sum += term;
            }
        }
        let [ss, cc, sc, ps, pc] = sums;
        let sine = (ps * cc - pc * sc) / (ss * cc - sc * sc);
        let cosine = (pc * ss - ps * sc) / (ss * cc - sc * sc);
        let depth = (depth_in_cells as f64 + 0.5) * 0.25;
        // The base is six skin depths away: its echo is below 1e-4 here.
        let exact = 1e5 * (-depth / skin).exp();
        let amplitude = (sine * sine + cosine * cosine).sqrt();
        assert!(
            (amplitude - exact).abs() < 2e-3 * 1e5,
            "{depth} m: {amplitude} {exact}"
        );
        let lag = (cosine.atan2(sine) + depth / skin).abs();
        assert!(lag < 1e-2, "{depth} m: {lag} rad");
    }
}

/// At 8 cells a grain the packing is as permeable as Kozeny and Carman say to 15 %; the scene's
/// own 16 cells are within 3 %.
#[test]
fn the_packing_is_as_permeable_as_kozeny_carman_says() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = [
        "water.spacing=125 um",
        "end={ duration = \"0.15 s\" }",
        "output.fluid.every=0.15 s",
    ];
    let scene = ready("packing-permeability", &coarse);
    let solid = scene
        .water
        .model
        .solid
        .iter()
        .filter(|&&solid| solid)
        .count() as f64;
    let porosity = 1.0 - solid / scene.water.model.solid.len() as f64;
    assert!((porosity - 0.405).abs() < 3e-3, "{porosity}");
    go(&scene, folder.path());
    let found = values(&folder.path().join("series.nc"), "permeability_x");
    let known = kozeny_carman(porosity, 1e-3);
    assert!(
        (found.last().unwrap() / known - 1.0).abs() < 0.15,
        "{found:?} {known}"
    );
    let kept = values(&folder.path().join("fluid.nc"), "porosity");
    assert!((kept.iter().sum::<f64>() / kept.len() as f64 - porosity).abs() < 1e-12);
}

/// Layers in series: 1 / k is the mean of the layers' own, also where the layers are of different
/// height, and the drop of pressure is that between the sides.
#[test]
fn the_permeability_of_two_layers_is_that_of_a_series() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"
title = "Two layers"
box.size = ["1 cm", "1 cm", "8 cm"]
[water]
spacing = "1 cm"
sides = { bottom = { pressure = "10 kPa" }, top = { pressure = "0 Pa" } }
[[water.bed.layer]]
top = "2 cm"
porosity = 0.4
permeability = "1e-12 m^2"
[[water.bed.layer]]
porosity = 0.4
permeability = "2e-12 m^2"
[end]
duration = "30 ms"
"#;
    go(&super::read(text, &[]).unwrap(), folder.path());
    let of = |name| {
        *values(&folder.path().join("series.nc"), name)
            .last()
            .unwrap()
    };
    assert!((of("pressure_drop_z") / 1e4 - 1.0).abs() < 1e-12);
    let series = 0.08 / (0.02 / 1e-12 + 0.06 / 2e-12);
    let found = of("permeability_z");
    assert!((found / series - 1.0).abs() < 1e-6, "{found} {series}");
}
