//! What is wrong is told before anything runs.

use super::super::SMALL;
use super::{grid, planned, source};
use experiments::sweep::{Design, Plan};

fn error(vary: &[&str]) -> String {
    let error = Plan::new(&source(SMALL), grid(vary)).unwrap_err();
    format!("{error:#}")
}

#[test]
fn wrong_paths_and_values_are_named_with_the_nearest_right_one() {
    for (vary, place, remedy) in [
        (
            "phase.shear.top.normal_stres=10 kPa",
            "--vary phase.shear.top.normal_stres=10 kPa: phase.shear.top.normal_stres: is not known",
            "did you mean `normal_stress`?",
        ),
        (
            "phse.shear.friction=0.3",
            "--vary phse.shear.friction=0.3: phse: is not known",
            "did you mean `phase`?",
        ),
        (
            "phase.sheer.friction=0.3",
            "--vary phase.sheer.friction=0.3: there is no phase \"sheer\"",
            "there are: settle, consolidate, shear",
        ),
        (
            "phase.shear.top.normal_stress=10 N",
            "--vary phase.shear.top.normal_stress=10 N: phase.shear.top.normal_stress: \"10 N\" is a force",
            "write e.g. normal_stress = \"100 kPa\"",
        ),
        (
            "grains.count=-1",
            "--vary grains.count=-1: grains.count:",
            "write",
        ),
    ] {
        let error = error(&[vary]);
        for part in [place, remedy, "nothing was run", "point 0"] {
            assert!(error.contains(part), "{part:?} is not in {error}");
        }
    }
    // A point in the middle that is wrong stops all of them.
    let error = error(&["phase.shear.friction=0.3,0.4,-1", "seed=1,2"]);
    assert!(
        error.contains("point 4") && error.contains("--vary phase.shear.friction=-1"),
        "{error}"
    );
    // A sweep needs the series.
    let scene = format!("{SMALL}\n[output]\nseries = \"none\"\n");
    let error = Plan::new(&source(&scene), grid(&["seed=1,2"])).unwrap_err();
    assert!(error.to_string().contains("output.series"), "{error}");
    let error = Design::grid(&[]).unwrap_err().to_string();
    assert!(error.contains("nothing is varied"), "{error}");
}

#[test]
fn a_folder_with_another_sweep_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let first = planned(SMALL, grid(&["seed=1,2"]), out);
    // The same again is the same sweep.
    assert_eq!(planned(SMALL, grid(&["seed=1,2"]), out), first);
    std::fs::write(out.join("mine.txt"), "").unwrap();
    let changed = SMALL.replace("count   = 60", "count   = 61");
    for (text, vary) in [(SMALL, "seed=1,3"), (&changed, "seed=1,2")] {
        let (plan, texts) = Plan::new(&source(text), grid(&[vary])).unwrap();
        let error = plan.store(&texts, out, false).unwrap_err().to_string();
        assert!(
            error.contains("another sweep") && error.contains("--force"),
            "{error}"
        );
        assert_eq!(Plan::load(out).unwrap(), first);
    }
    let (plan, texts) = Plan::new(&source(SMALL), grid(&["seed=3"])).unwrap();
    plan.store(&texts, out, true).unwrap();
    assert_eq!(Plan::load(out).unwrap(), plan);
    assert!(!out.join("settle-1").exists() && out.join("mine.txt").exists());
    let error = Plan::load(&out.join("nowhere")).unwrap_err();
    assert!(format!("{error:#}").contains("holds no sweep"), "{error:#}");
}
