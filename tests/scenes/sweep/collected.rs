//! One file with all points: dimensions, coordinates, units.

use super::super::SMALL;
use super::{all, grid, planned, texts, values};
use experiments::sweep::{Design, Folder, Plan, collect};
use std::path::Path;

fn collected(design: Design, out: &Path) -> Plan {
    let plan = planned(SMALL, design, out);
    all(&plan, out);
    let folder = Folder {
        path: out,
        plan: &plan,
    };
    assert!(collect(folder).unwrap().iter().all(Option::is_none));
    plan
}

/// Dimensions of a variable of the collected file.
fn dims(out: &Path, name: &str) -> Vec<String> {
    let file = experiments::output::netcdf::open(&out.join("sweep.nc")).unwrap();
    let variable = file.variable(name);
    let variable = variable.unwrap_or_else(|| panic!("no {name}"));
    variable.dimensions().iter().map(|dim| dim.name()).collect()
}

#[test]
fn a_grid_has_what_is_varied_as_its_dimensions() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let vary = [
        "phase.shear.friction=0.3,none",
        "phase.shear.shear.strain_rate=5,10,20 1/s",
    ];
    collected(grid(&vary), out);
    // `friction` is a variable of the series.
    assert_eq!(
        dims(out, "friction_late"),
        ["shear_friction", "strain_rate"]
    );
    assert_eq!(
        dims(out, "dilation"),
        ["shear_friction", "strain_rate", "row"]
    );
    assert_eq!(
        values(&out.join("sweep.nc"), "strain_rate"),
        [5.0, 10.0, 20.0]
    );
    let file = experiments::output::netcdf::open(&out.join("sweep.nc")).unwrap();
    let words = file.variable("shear_friction").unwrap();
    assert_eq!(words.get_string([1]).unwrap(), "none");
    let slid = values(&out.join("sweep.nc"), "dissipated_friction_final");
    assert!(slid[..3].iter().all(|&work| work > 0.0), "{slid:?}");
    assert_eq!(slid[3..], [0.0; 3]);
}

#[test]
fn lists_and_hypercubes_lie_along_points() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("points.csv");
    let text = "phase.shear.shear.strain_rate,phase.shear.friction\n5 1/s,0.3\n10 1/s,0.4\n";
    std::fs::write(&table, text).unwrap();
    let cube = texts(&[
        "phase.shear.shear.strain_rate=5..20 1/s log",
        "phase.shear.friction=0.2..0.6",
    ]);
    for (k, design) in [
        Design::list(&table).unwrap(),
        Design::hypercube(&cube, 3, 1).unwrap(),
    ]
    .into_iter()
    .enumerate()
    {
        let out = folder.path().join(k.to_string());
        let plan = collected(design, &out);
        // One bed for all.
        assert_eq!(plan.runs.len(), 2 + plan.ends.len());
        for name in ["strain_rate", "shear_friction", "friction_late", "point"] {
            assert_eq!(dims(&out, name), ["point"], "{name}");
        }
        assert_eq!(dims(&out, "dilation"), ["point", "row"]);
        let rates = values(&out.join("sweep.nc"), "strain_rate");
        assert!(
            rates.iter().all(|rate| (5.0..=20.0).contains(rate)),
            "{rates:?}"
        );
        // Strain rates tell how long a strain takes.
        let (time, phase) = (
            values(&out.join("sweep.nc"), "time_final"),
            values(&out.join("sweep.nc"), "strain_final"),
        );
        for ((time, rate), strain) in time.iter().zip(&rates).zip(&phase) {
            let shear = time - 4e-3;
            assert!(
                (shear * rate / strain - 1.0).abs() < 1e-2,
                "{time} {rate} {strain}"
            );
        }
    }
}
