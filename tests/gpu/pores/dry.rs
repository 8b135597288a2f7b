//! Dry grains know nothing of water: neither compiled nor allocated.

use super::bed::{STRESS, model, pressed};
use crate::lab::Suite;
use dem::gpu::Solver;
use shaders::naga::Module;
use shaders::{Device, compose, files};

pub fn list(suite: &mut Suite) {
    suite.plain("wet_files_are_no_import_of_dry_ones", imports);
    suite.gpu("wet_arrays_are_not_there_in_dry_beds", arrays);
}

fn imports() {
    for (path, text) in files() {
        if !path.starts_with("coupling/") {
            assert!(!text.contains("coupling::"), "{path} imports the coupling");
        }
        if path.starts_with("dem/") {
            assert!(!text.contains("lbm::"), "{path} imports the water");
        }
    }
}

fn names(module: &Module) -> Vec<String> {
    let all = module.global_variables.iter();
    let names = all.filter_map(|(_, variable)| variable.name.clone());
    names
        .map(|name| match name.split_once("X_naga") {
            Some((plain, _)) => plain.to_string(),
            None => name,
        })
        .collect()
}

/// What only beds with a companion have.
const WET: [&str; 4] = ["companions", "reliefs", "loads", "kept"];

fn arrays(device: &Device) {
    let dry = Solver::new(device, model(STRESS), pressed()).unwrap();
    let wet = Solver::with_companion(device, model(STRESS), pressed(), 3).unwrap();
    let of = |solver: &Solver| names(&compose("dem/step.wgsl", solver.flags()).unwrap());
    assert!(
        WET[..2]
            .iter()
            .all(|name| of(&wet).contains(&(*name).to_string()))
    );
    assert!(of(&dry).iter().all(|name| !WET.contains(&name.as_str())));
    let named = |solver: &Solver| -> Vec<&str> {
        solver.arrays().into_iter().map(|(name, _)| name).collect()
    };
    assert!(WET.iter().all(|name| named(&wet).contains(name)));
    assert!(WET.iter().all(|name| !named(&dry).contains(name)));
    // A force of four words and three rows of four for each of the 300 grains, and their loads.
    assert!(wet.memory() > dry.memory() + 300 * (64 + 4));
}
