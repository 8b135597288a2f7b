//! The ready-made experiments are scenes that run.

use super::read;
use experiments::backend::Backend;
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
        for file in ["series.nc", "profiles.nc", "grains.nc", "state.h5"] {
            assert!(
                options.out.join(file).is_file(),
                "{file} of {}",
                experiment.name
            );
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
