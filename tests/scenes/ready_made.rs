//! The ready-made experiments are scenes that run.

use super::read;
use experiments::backend::Backend;
use experiments::output::FileKind;
use experiments::ready;
use experiments::run::{Options, run};
use std::sync::atomic::AtomicBool;

#[test]
fn every_ready_made_experiment_of_grains_runs_a_few_steps_of_every_phase() {
    for experiment in super::of_grains() {
        let names = read(experiment.scene(), &[]).unwrap().phases;
        // Few grains need a smaller box.
        let mut sets = vec![
            "grains.count=100".into(),
            "box.size=[\"60 mm\", \"60 mm\"]".into(),
        ];
        if experiment.scene().contains("\nlayers ") {
            sets.push("water.layers=3".into());
        }
        for phase in &names {
            sets.push(format!(
                "phase.{}.end={{ duration = \"0.1 ms\" }}",
                phase.name
            ));
        }
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let scene = read(experiment.scene(), &sets).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let options = Options {
            out: folder.path().join("results"),
            backend: Backend::Cpu,
            threads: 2,
            force: false,
            quiet: true,
        };
        let summary = run(&scene, &options, &AtomicBool::new(false)).unwrap();
        assert_eq!(summary.phases.len(), names.len());
        let profiles = scene.output.files[FileKind::Profiles].is_some();
        for (file, asked) in [
            ("series.nc", true),
            ("profiles.nc", profiles),
            ("grains.nc", true),
            ("state.h5", true),
        ] {
            let there = options.out.join(file).is_file();
            assert_eq!(there, asked, "{file} of {}", experiment.name);
        }
        let again = run(&scene, &options, &AtomicBool::new(false)).unwrap_err();
        assert!(again.to_string().contains("--force"), "{again}");
        let forced = Options {
            force: true,
            ..options
        };
        run(&scene, &forced, &AtomicBool::new(false)).unwrap();
    }
}

/// What takes days is not run here, but it is a scene, and has the phases of its small one.
#[test]
fn full_scenes_are_scenes() {
    for name in ["wet-shear", "pressure-cycles"] {
        let full = ready::file(&format!("{name}/full.toml")).unwrap();
        let full = read(std::str::from_utf8(full).unwrap(), &[]).unwrap_or_else(|e| panic!("{e}"));
        let small = read(ready::find(name).unwrap().scene(), &[]).unwrap();
        let names = |scene: &experiments::scene::Scene| {
            let each = scene.phases.iter();
            each.map(|phase| phase.name.clone()).collect::<Vec<_>>()
        };
        assert_eq!(names(&full), names(&small));
        assert!(full.start.grains.len() > small.start.grains.len());
    }
}

/// Restitution, frictions, ratios of stiffness and damping, steps per contact.
#[test]
fn small_shear_has_the_posters_dimensionless_numbers() {
    let numbers = |name| {
        let scene = read(ready::find(name).unwrap().scene(), &[]).unwrap();
        let dem::ContactLaw::Linear(law) = scene.phases[2].law else {
            panic!("{name} has the linear law");
        };
        let sliding = law.sliding.unwrap();
        let mass = scene.start.grains.mass.iter().sum::<f64>() / scene.start.grains.len() as f64;
        [
            law.normal_damping / (law.normal_stiffness * mass).sqrt(),
            sliding.stiffness / law.normal_stiffness,
            sliding.damping / law.normal_damping,
            sliding.friction_static,
            sliding.friction_dynamic,
            scene.step / (mass / law.normal_stiffness).sqrt(),
        ]
    };
    let (poster, small) = (numbers("poster-shear"), numbers("small-shear"));
    for (a, b) in poster.iter().zip(small) {
        approx::assert_relative_eq!(*a, b, max_relative = 2e-3);
    }
}
