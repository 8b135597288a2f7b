//! Points share what is the same in their resolved scenes, and get the same bits.

use super::super::{SMALL, pores};
use super::{WATER, all, alone, go, grid, planned, source, values};
use experiments::output::{state, water_state};
use experiments::sweep::{Design, Ended, Folder, Outcome, Plan, collect, run};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Number of runs of each phase.
fn runs(text: &str, vary: &[&str]) -> Vec<usize> {
    let (plan, _) = Plan::new(&source(text), grid(vary)).unwrap();
    let of = |phase| plan.runs.iter().filter(|run| run.phase == phase).count();
    (0..plan.phases.len()).map(of).collect()
}

#[test]
fn what_is_the_same_in_the_resolved_scenes_is_run_once() {
    let stress = "phase.consolidate.top.normal_stress,phase.shear.top.normal_stress=10, 20 kPa";
    for (vary, expected) in [
        (&["phase.shear.shear.strain_rate=5,10 1/s"][..], [1, 1, 2]),
        (&[stress, "phase.shear.friction=0.3,0.4"], [1, 2, 4]),
        // The same stress, written otherwise.
        (
            &["phase.consolidate.top.normal_stress=10 kPa,10000 Pa"],
            [1, 1, 2],
        ),
        // It acts in no phase that is shared, but the bed is laid with it.
        (&["contact.tangential.friction=0.5,0.4"], [2, 2, 2]),
        (&["seed=1,2,3"], [3, 3, 3]),
        // The step follows from the stiffest spring of any phase.
        (&["time.step=1e-7,2e-7 s"], [2, 2, 2]),
        // Rows do not change the bed.
        (&["output.series.every=1,2 ms"], [1, 1, 2]),
        // Without the ledger the energies of the series are not summed.
        (
            &["output.series.variables=['friction'],['work_walls']"],
            [2, 2, 2],
        ),
    ] {
        assert_eq!(runs(SMALL, vary), expected, "{vary:?}");
    }
    // Dry beds know nothing of the water that comes later.
    let wet = &["water.bed.permeability=1e-13,1e-12 m^2"];
    assert_eq!(runs(pores::WET, wet), [1, 2, 2]);
    // The wall of the dry phase does not feel what the later phases press.
    assert_eq!(
        runs(pores::WET, &["phase.load.top.normal_stress=11,12 kPa"]),
        [1, 2, 2]
    );
}

/// State and series of every point are those of the point by itself.
fn same_bits(text: &str, design: Design, shared: usize) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let plan = planned(text, design, &out);
    let phases = plan.phases.len();
    assert_eq!(plan.runs.len(), plan.ends.len() * phases - shared);
    all(&plan, &out);
    let sweep = Folder {
        path: &out,
        plan: &plan,
    };
    assert!(collect(sweep).unwrap().iter().all(Option::is_none));
    for point in 0..plan.ends.len() {
        let own = folder.path().join(format!("alone-{point}"));
        alone(text, &plan.design.sets(point), &own);
        let load = |path: &Path| state::load(&path.join("state.h5")).unwrap();
        let of_sweep = load(&sweep.of(plan.ends[point]));
        assert!(load(&own) == of_sweep, "the bits of point {point} differ");
        for name in [
            "time",
            "phase",
            "strain",
            "dilation",
            "friction",
            "normal_stress_top_mean",
        ] {
            let single = values(&own.join("series.nc"), name);
            let rows = values(&out.join("sweep.nc"), name);
            let longest = rows.len() / plan.ends.len();
            let (rows, rest) = rows[point * longest..][..longest].split_at(single.len());
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(rows), bits(&single), "{name} of point {point}");
            let pad = |v: &f64| v.is_nan() || name == "phase" && *v == -1.0;
            assert!(rest.iter().all(pad), "{name} of point {point}: {rest:?}");
        }
    }
}

#[test]
fn a_dry_run_from_a_shared_bed_has_the_bits_of_the_point_alone() {
    let vary = [
        "phase.consolidate.top.normal_stress,phase.shear.top.normal_stress=10, 20 kPa",
        "phase.shear.shear.strain_rate=5, 10 1/s",
    ];
    // How often rows are written is chosen from the durations, unless it is said.
    let text = format!("{SMALL}\n[output]\nseries.every = \"20 us\"\n");
    same_bits(&text, grid(&vary), 3 + 2);
}

#[test]
fn a_wet_run_from_a_shared_bed_has_the_bits_of_the_point_alone() {
    let short = pores::WET
        .replace("duration = \"2 ms\"", "duration = \"0.5 ms\"")
        .replace(
            "at_rest = 1e-4, max_duration = \"0.2 s\"",
            "duration = \"5 ms\"",
        );
    same_bits(&short, grid(&["water.bed.permeability=2e-13,1e-12 m^2"]), 1);
}

#[test]
fn water_alone_is_swept_too() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let plan = planned(
        WATER,
        grid(&["water.bed.permeability=1e-12,4e-12 m^2"]),
        &out,
    );
    all(&plan, &out);
    let sweep = Folder {
        path: &out,
        plan: &plan,
    };
    collect(sweep).unwrap();
    for point in 0..2 {
        let own = folder.path().join(format!("alone-{point}"));
        alone(WATER, &plan.design.sets(point), &own);
        let load = |path: &Path| water_state::load(&path.join("state.h5")).unwrap();
        assert!(
            load(&own) == load(&sweep.of(plan.ends[point])),
            "the bits differ"
        );
    }
    let flux = values(&out.join("sweep.nc"), "flux_z_late");
    // Darcy: so many times the permeability, so many times the flux.
    approx::assert_relative_eq!(flux[1] / flux[0], 4.0, max_relative = 1e-6);
}

/// As commands that `--print` prints: in any order in which a bed comes before what starts from it.
#[test]
fn runs_can_be_started_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let plan = planned(
        SMALL,
        grid(&["phase.shear.shear.strain_rate=5,10 1/s"]),
        out,
    );
    let sweep = Folder {
        path: out,
        plan: &plan,
    };
    let go_on = AtomicBool::new(false);
    let one = |name: &str| {
        let number = plan.find(name).unwrap();
        run(sweep, number, experiments::backend::Backend::Cpu, 1, &go_on)
    };
    let error = one("shear-1").unwrap_err().to_string();
    assert!(
        error.contains("consolidate-0, which is not done"),
        "{error}"
    );
    for name in ["settle-0", "consolidate-0", "shear-1"] {
        assert!(matches!(one(name).unwrap(), Ended::Done(_)));
    }
    // What is done is not run again.
    let before = std::fs::metadata(out.join("shear-1/state.h5")).unwrap();
    assert!(matches!(one("shear-1").unwrap(), Ended::Done(_)));
    let after = std::fs::metadata(out.join("shear-1/state.h5")).unwrap();
    assert_eq!(before.modified().unwrap(), after.modified().unwrap());
    let error = plan.find("sheer-1").unwrap_err().to_string();
    assert!(error.contains("did you mean shear-1?"), "{error}");
    // The rest, by the whole sweep.
    assert_eq!(sweep.outcome(plan.find("shear-0").unwrap()).unwrap(), None);
    assert_eq!(go(&plan, out, &go_on).done, 2);
    let outcome = sweep.outcome(plan.find("shear-0").unwrap()).unwrap();
    assert!(matches!(outcome, Some(Outcome::Done { .. })));
    let printed = experiments::sweep::commands(&plan, out, 3);
    let lines: Vec<&str> = printed
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    assert_eq!(lines.len(), plan.runs.len() + 1);
    let names = ["settle-0", "consolidate-0", "shear-0", "shear-1"];
    for (line, name) in lines.iter().zip(names) {
        assert!(
            line.contains(&format!("--only {name} --threads 3")),
            "{line}"
        );
    }
    let script = experiments::sweep::slurm(&plan, out, 3);
    for part in [
        "--array=0-0",
        "--array=0-1",
        "(shear-0 shear-1)",
        "--cpus-per-task=3",
        "--collect",
    ] {
        assert!(script.contains(part), "{part}: {script}");
    }
}
