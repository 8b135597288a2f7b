//! Grains and water together through the program: the balances of stress and of volume in its
//! files, going on from a state, and dry phases that know nothing of water.

use super::{AREA, after, go, series, text_after, values, wet};
use crate::read;
use experiments::backend::Machine;
use experiments::engine::Engine;
use experiments::output::{FileKind, state};
use experiments::protocol::prepare;
use experiments::scene::Scene;

/// A sealed bed keeps its water, and shares a load as Skempton says; what drains is what the wall
/// sinks by.
#[test]
fn water_is_neither_made_nor_lost() {
    let folder = tempfile::tempdir().unwrap();
    let mut sealed = after(&["water.sides.top=tight"]);
    sealed.phases.truncate(1);
    go(&sealed, folder.path(), 1);
    let volume = series(folder.path(), "water_volume");
    let first = volume[0];
    let most = volume
        .iter()
        .map(|v| (v / first - 1.0).abs())
        .fold(0.0, f64::max);
    assert!(most < 1e-12, "{most:e}");
    let pressure = series(folder.path(), "pore_pressure_mean");
    let late = &pressure[pressure.len() / 2..];
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    let m = state::load(&folder.path().join("state.h5")).unwrap();
    let m = m.past.water.unwrap().stiffness.unwrap();
    assert!(m > 1e6 && m < 1e8, "{m:e} Pa");
    // S M is about a thousandth: the water takes all of the 2 kPa that are new.
    assert!((mean / 2e3 - 1.0).abs() < 0.05, "{mean} Pa");

    let mut drained = after(&["water.bed.permeability=5e-12 m^2"]);
    drained.phases.truncate(1);
    go(&drained, folder.path(), 1);
    let volume = series(folder.path(), "water_volume");
    let height = series(folder.path(), "wall_height");
    let last = volume.len() - 1;
    let (left, sunk) = (volume[0] - volume[last], AREA * (height[0] - height[last]));
    assert!(left > 1e-12, "{left:e} m3");
    assert!((left / sunk - 1.0).abs() < 0.02, "{left:e} {sunk:e} m3");
    let through = series(folder.path(), "water_left_top");
    let through = through[last] - through[0];
    assert!((through / left - 1.0).abs() < 1e-3, "{through:e} {left:e}");
    let bottom = series(folder.path(), "water_left_bottom");
    assert!(bottom.iter().all(|&left| left == 0.0));
    let pressure = series(folder.path(), "pore_pressure_base");
    assert!(pressure[last] < 0.5 * pressure[last / 4], "{pressure:?}");
}

/// The wall carries its load and its own inertia, which a mean over its oscillation takes out.
#[test]
fn grains_and_water_carry_the_load_together() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = after(&[]);
    scene.phases.truncate(1);
    go(&scene, folder.path(), 1);
    let of = |name: &str| series(folder.path(), name);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    for end in ["top", "bottom"] {
        let total = mean(&of(&format!("total_stress_{end}")));
        assert!((total / 12e3 - 1.0).abs() < 0.02, "{end}: {total} Pa");
        let effective = mean(&of(&format!("effective_stress_{end}")));
        // At the drained top the grains carry all of it at last; below the water does for long.
        assert!(effective < total, "{end}: {effective} Pa");
    }
    assert_eq!(of("effective_stress_top"), of("normal_stress_top"));
    let (rows, cells) = (
        values(&folder.path().join("fluid.nc"), "time").len(),
        2 * 2 * 5,
    );
    let porosity = values(&folder.path().join("fluid.nc"), "porosity");
    assert_eq!(porosity.len(), rows * cells);
    assert!(
        porosity.iter().all(|&p| p > 0.2 && p < 0.7),
        "{:?}",
        &porosity[..cells]
    );
}

#[test]
fn an_effective_stress_stays_on_the_grains_whatever_the_water_presses() {
    let folder = tempfile::tempdir().unwrap();
    let sets = [
        "water.normal_stress=effective",
        "phase.load.top={ normal_stress = \"10 kPa\" }",
        "water.sides.top={ pressure = \"5 kPa\" }",
        "water.bed.permeability=1e-11 m^2",
    ];
    let mut scene = after(&sets);
    scene.phases.truncate(1);
    go(&scene, folder.path(), 1);
    let late = |name| {
        let values = series(folder.path(), name);
        let late = &values[values.len() * 3 / 4..];
        late.iter().sum::<f64>() / late.len() as f64
    };
    let (effective, total) = (late("effective_stress_top"), late("total_stress_top"));
    assert!((effective / 10e3 - 1.0).abs() < 0.05, "{effective} Pa");
    assert!((total / 15e3 - 1.0).abs() < 0.05, "{total} Pa");
}

#[test]
fn going_on_from_a_state_gives_the_bits_of_not_having_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    go(&after(&[]), &at("whole"), 1);
    let mut first = after(&[]);
    first.phases.truncate(1);
    go(&first, &at("half"), 2);
    let rest = read(&text_after(&at("half"), "load"), &[]).unwrap();
    assert_eq!(rest.phases.len(), 1);
    go(&rest, &at("rest"), 2);
    let load = |name| state::load(&at(name).join("state.h5")).unwrap();
    let (whole, continued) = (load("whole"), load("rest"));
    assert!(whole.past.water.is_some());
    assert!(whole == continued, "the bits differ");
    // It began with the pressure that was left.
    let left = &rest.past.water.as_ref().unwrap().state.pressure;
    let engine = begun(&rest);
    let found = engine.water().unwrap().unwrap().now.pressure;
    let most = left.iter().copied().fold(0.0, f64::max);
    assert!(most > 500.0 && left.len() == found.len(), "{left:?}");
    let pairs = left.iter().zip(&found);
    assert!(
        pairs.clone().all(|(a, b)| (a - b).abs() < 1e-9 * most),
        "{left:?} {found:?}"
    );
    // With other cells it cannot.
    let error = read(&text_after(&at("half"), "load"), &["water.layers=6"]).unwrap_err();
    assert!(error.to_string().contains("water.layers"), "{error}");
}

/// The solver of the first phase of a scene.
pub fn begun(scene: &Scene) -> Engine {
    let phase = &scene.phases[0];
    let ready = prepare(scene, phase, scene.start.clone(), None).unwrap();
    let machine = Machine::Cpu { threads: 1 };
    let (model, state) = (ready.model, ready.state);
    Engine::of_phase(scene, phase, &machine, model, state, &scene.past, None).unwrap()
}

/// The solver of a dry phase is that of grains alone, and it makes the same bits as in a scene that
/// knows no water.
#[test]
fn dry_stays_dry() {
    let folder = tempfile::tempdir().unwrap();
    let table = "[water]\nbed.permeability = \"2e-13 m^2\"\nsides.top        = \"drained\"\n";
    let phase = super::WET.replace("water    = \"none\"\n", "");
    let dry = phase
        .replace(table, "")
        .replace("fluid.every  = \"0.5 ms\"\n", "");
    let mut dry = read(&dry, &["phase.press.end={ duration = \"2 ms\" }"]).unwrap();
    let mut of_wet = wet(&["phase.press.end={ duration = \"2 ms\" }"]);
    assert!(dry.water.is_none() && dry.phases.iter().all(|phase| phase.water.is_none()));
    for scene in [&mut dry, &mut of_wet] {
        scene.phases.truncate(1);
        assert!(matches!(begun(scene), Engine::Cpu(_)));
    }
    assert!(dry.output.files[FileKind::Fluid].is_none());
    go(&dry, &folder.path().join("dry"), 1);
    go(&of_wet, &folder.path().join("wet"), 1);
    let load = |name: &str| state::load(&folder.path().join(name).join("state.h5")).unwrap();
    assert!(load("dry") == load("wet"), "the bits differ");
    // A dry phase has no numbers of water.
    let pressure = values(&folder.path().join("wet/series.nc"), "pore_pressure_mean");
    assert!(pressure.iter().all(|p| p.is_nan()));
    assert!(values(&folder.path().join("wet/fluid.nc"), "time").is_empty());
}
