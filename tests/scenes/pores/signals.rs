//! Pressures that vary at a drained wall, what a normal stress then is, water that flows through a
//! bed, and water that breaks: through the program, in its files.

use super::{AREA, after, go, series, values};
use experiments::output::state;
use std::f64::consts::TAU;
use std::path::Path;

/// Period of the signals [s].
const PERIOD: f64 = 8e-3;

/// The bed under a steady load, with `sets` more, for so many periods.
fn cycle(sets: &[&str], periods: f64, out: &Path) {
    let duration = format!(
        "phase.load.end={{ duration = \"{} ms\" }}",
        1e3 * PERIOD * periods
    );
    let load = "phase.load.top={ normal_stress = \"10 kPa\", damping = \"0.05 N s/m\" }";
    let mut scene = after(&[&[load, duration.as_str()], sets].concat());
    scene.phases.truncate(1);
    go(&scene, out, 1);
}

/// A sine at the top wall of this amplitude [Pa]; the pressed bed's time is what it is, so the
/// phase is that of the run.
fn sine(amplitude: f64) -> String {
    format!(
        "water.sides.top={{ pressure = {{ amplitude = \"{amplitude} Pa\", period = \"8 ms\" }} }}"
    )
}

/// Amplitude and phase [rad] of the part of `values` at `times` [s] that has the period of the
/// signals, over their last period.
fn at_period(times: &[f64], values: &[f64]) -> (f64, f64) {
    let last = times.len() - (PERIOD / (times[2] - times[1])).round() as usize;
    let each = times[last..].iter().zip(&values[last..]);
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (t, value) in each {
        let (s, c) = (TAU * t / PERIOD).sin_cos();
        sine += value * s;
        cosine += value * c;
    }
    let n = (times.len() - last) as f64;
    let (sine, cosine) = (2.0 * sine / n, 2.0 * cosine / n);
    (sine.hypot(cosine), cosine.atan2(sine))
}

/// p / p_top = cosh(κ z)/cosh(κ H) with κ² = iω/c_v, z from the tight base, where the total stress
/// stays: amplitude and phase [rad]. Of Terzaghi's equation, as in Damsgaard et al. (2020), Commun.
/// Earth Environ. 1, 66.
fn skin(diffusivity: f64, z: f64, height: f64) -> (f64, f64) {
    let kappa = (TAU / PERIOD / (2.0 * diffusivity)).sqrt();
    // cosh((1 + i) x)
    let cosh = |x: f64| (x.cosh() * x.cos(), x.sinh() * x.sin());
    let (a, b) = (cosh(kappa * z), cosh(kappa * height));
    let amplitude = a.0.hypot(a.1) / b.0.hypot(b.1);
    (amplitude, a.1.atan2(a.0) - b.1.atan2(b.0))
}

#[test]
fn a_pressure_that_varies_at_the_top_goes_down_as_the_skin_depth_says() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let sets = [&sine(200.0), "water.bed.permeability=2e-12 m^2"];
    cycle(&sets, 3.0, out);
    let water = state::load(&out.join("state.h5")).unwrap().past.water;
    let stiffness = water.unwrap().stiffness.unwrap();
    let height = *series(out, "wall_height").last().unwrap();
    let storage = 0.4 * 4.5e-10;
    let diffusivity = 2e-12 / 1.8e-3 / (storage + 1.0 / stiffness);
    let times = series(out, "time");
    let cells = 5.0;
    for (name, layer) in [("pore_pressure_base", 0.5), ("pore_pressure_top", 4.5)] {
        let (amplitude, phase) = at_period(&times, &series(out, name));
        let theory = skin(diffusivity, layer / cells * height, height);
        println!("{name}: {} {phase} of {theory:?}", amplitude / 200.0);
        assert!((amplitude / 200.0 / theory.0 - 1.0).abs() < 0.06, "{name}");
        assert!((phase - theory.1).abs() < 0.05, "{name}");
    }
}

#[test]
fn the_stress_that_is_meant_stays_while_the_pressure_at_the_top_varies() {
    for effective in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path();
        let mut sets = vec![sine(3e3), "water.bed.permeability=1e-11 m^2".into()];
        sets.extend(effective.then(|| "water.normal_stress=effective".into()));
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        cycle(&sets, 1.0, out);
        let times = series(out, "time");
        let of = |name| at_period(&times, &series(out, name)).0;
        let (grains, total) = (of("effective_stress_top"), of("total_stress_top"));
        let (stays, follows) = if effective {
            (grains, total)
        } else {
            (total, grains)
        };
        println!("{effective}: {stays} and {follows} Pa");
        assert!(stays < 150.0, "effective {effective}: {stays} Pa");
        assert!(
            (follows / 3e3 - 1.0).abs() < 0.05,
            "effective {effective}: {follows} Pa"
        );
    }
}

#[test]
fn water_flows_through_a_bed_from_the_higher_pressure() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let sets = [
        "water.sides={ bottom = { pressure = \"500 Pa\" }, top = \"drained\" }",
        "water.bed.permeability=5e-12 m^2",
        "output.profiles={ every = \"1 ms\", layer = \"0.5 mm\" }",
    ];
    cycle(&sets, 1.0, out);
    let (times, height) = (series(out, "time"), series(out, "wall_height"));
    let last = times.len() - 1;
    let flux = 5e-12 / 1.8e-3 * 500.0 / height[last];
    let rate = |name| {
        let left = series(out, name);
        (left[last] - left[last / 2]) / (times[last] - times[last / 2]) / AREA
    };
    let (bottom, top) = (rate("water_left_bottom"), rate("water_left_top"));
    println!("{bottom:e} {top:e} of {flux:e} m/s");
    assert!((top / flux - 1.0).abs() < 0.02, "{top:e} of {flux:e} m/s");
    assert!((bottom / flux + 1.0).abs() < 0.02, "{bottom:e} of {flux:e}");
    // A straight line from wall to wall, and none above.
    let file = out.join("profiles.nc");
    let z = values(&file, "z");
    for (name, at) in [("pore_pressure", 500.0), ("darcy_flux", flux)] {
        let all = values(&file, name);
        let row = &all[all.len() - z.len()..];
        for (&z, &value) in z.iter().zip(row) {
            let share = 1.0 - z / height[last];
            let theory = if name == "darcy_flux" { at } else { at * share };
            assert_eq!(value.is_nan(), share < 0.0, "{name} at {z}: {value}");
            assert!(
                share < 0.0 || (value - theory).abs() < 0.02 * at,
                "{name} at {z}: {value} of {theory}"
            );
        }
    }
}

#[test]
fn water_that_breaks_is_told_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let sets = [
        "water.sides.top=tight",
        "water.cavitation=-1 kPa",
        "phase.load.top={ normal_stress = \"10 kPa\" }",
        "phase.shear.top={ normal_stress = \"10 kPa\" }",
        "phase.shear.shear.strain_rate=20 1/s",
    ];
    let scene = after(&sets);
    let summary = go(&scene, folder.path(), 1);
    let water = summary.phases[1].water.as_ref().unwrap();
    let told = water.warnings.iter().any(|w| w.contains("the water broke"));
    assert!(told, "{:?}", water.warnings);
    let of = |name| series(folder.path(), name);
    let base = of("pore_pressure_base");
    let least = base.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(
        (-1000.0..-999.0).contains(&least),
        "the least pressure is {least} Pa"
    );
    let (vapour, volume) = (of("vapour_volume"), of("water_volume"));
    let most = vapour.iter().copied().fold(0.0, f64::max);
    assert!(most > 1e-5 * volume[0], "{most:e} m3 of vapour");
    let changes = volume.iter().map(|v| (v / volume[0] - 1.0).abs());
    let change = changes.fold(0.0, f64::max);
    assert!(change < 1e-12, "{change:e}");
}
