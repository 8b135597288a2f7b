//! The text that a result carries says what was chosen, and is a scene that gives the same run.

use super::{SMALL, read};
use experiments::backend::Backend;
use experiments::run::{Options, run};
use experiments::scene::tree::Step;
use experiments::scene::{Document, Scene};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The scene of `scene`'s text must be the same, and its text too: nothing is left to choose.
fn again(scene: &Scene) -> Scene {
    let again = read(&scene.text, &[]).unwrap_or_else(|e| panic!("{e}\n{}", scene.text));
    assert_eq!(scene.text, again.text);
    assert!(*scene == again, "not the same scene:\n{}", scene.text);
    again
}

/// The value at `path`, keys by name and list items by number.
fn said(text: &str, path: &str) -> Option<String> {
    let document = Document::new("scene.toml", Path::new("."), text, &[]).unwrap();
    let steps = path.split('.').map(|word| {
        word.parse()
            .map_or_else(|_| Step::Key(word.into()), Step::Item)
    });
    let node = steps
        .into_iter()
        .try_fold(&document.root, |node, step| node.down(&step))?;
    Some(format!("{:?}", node.value))
}

const SILENT: &str = r#"
title = "Says as little as it may"
box.size = ["6 mm", "6 mm"]

[grains]
count   = 60
radius  = { law = "log-normal", median = "0.5 mm", spread = 0.1 }
density = "2600 kg/m^3"

[contact]
normal     = { stiffness = "1e5 N/m", restitution = 0.5 }
tangential = { friction = 0.5 }                        # no rolling

[[phase]]
name = "consolidate"
top  = { normal_stress = "10 kPa" }
end  = { duration = "4 ms" }

[[phase]]
name  = "shear"
top   = { normal_stress = "10 kPa" }
shear = { strain_rate = "5 1/s" }
end   = { strain = 0.01 }

[[phase]]
name = "rest"
end  = { duration = "1 ms" }
"#;

#[test]
fn everything_that_was_chosen_is_said() {
    let scene = read(SILENT, &[]).unwrap();
    let dashpot = scene.phases[0].law.normal_damping();
    let keys = [
        "seed",
        "box.size.2",
        "box.gravity",
        "box.sides.x",
        "box.sides.y",
        "wall.top.surface",
        "wall.bottom.surface",
        "grains.radius.min",
        "grains.radius.max",
        "grains.solid_fraction",
        "contact.law",
        "contact.tension",
        "contact.normal.damping",
        "contact.tangential.stiffness",
        "contact.tangential.damping",
        "contact.rolling",
        "contact.twisting",
        "time.step",
        "search.skin",
        "phase.0.start",
        "phase.0.top.mass",
        "phase.0.top.damping",
        "phase.1.top.mass",
        "phase.1.top.damping",
        "phase.1.layer",
        "phase.1.start",
        "phase.2.top",
        "output.series.every",
        "output.series.variables",
        "output.profiles.every",
        "output.profiles.variables",
        "output.profiles.layer",
        "output.grains.every",
        "output.grains.variables",
        "output.contacts",
    ];
    for key in keys {
        assert_eq!(said(SILENT, key), None, "{key} was there before");
        assert!(
            said(&scene.text, key).is_some(),
            "{key} is not in:\n{}",
            scene.text
        );
    }
    let damping = format!("Text(\"{dashpot:?} N s/m\")");
    assert_eq!(said(&scene.text, "contact.normal.damping"), Some(damping));
    assert_eq!(said(&scene.text, "contact.normal.restitution"), None);
    assert!(scene.text.contains("# no rolling"), "{}", scene.text);
}

#[test]
fn the_resolved_scene_is_the_same_scene() {
    for experiment in super::of_grains() {
        again(&read(experiment.scene(), &["grains.count=500"]).unwrap());
    }
    again(&read(SMALL, &[]).unwrap());
    let changes: &[&[&str]] = &[
        &[],
        &["seed=7", "search.skin=0.1 mm", "time.step=0.1 us"],
        &["contact.law=linear-lammps"],
        &["contact.tangential=none"],
        &["contact.rolling={ stiffness = \"1e4 N/m\", friction = 0.1 }"],
        &["box.tilt=20 degrees", "box.sides.y=walls"],
        &[
            "box.gravity=[\"1 m/s^2\", \"0 m/s^2\", \"-9 m/s^2\"]",
            "wall.top.surface=full",
        ],
        &["grains.radius={ law = \"listed\", values = [\"0.5 mm\", \"0.6 mm\"] }"],
        &[
            "phase.shear.top={ velocity = \"1 mm/s\" }",
            "phase.rest.friction=none",
        ],
        &[
            "phase.shear.shear={ shear_stress = \"1 kPa\" }",
            "phase.shear.end={ duration = \"1 ms\" }",
        ],
        &[
            "output.contacts.every=1 ms",
            "output.profiles=none",
            "output.series.every=1 us",
        ],
    ];
    for sets in changes {
        again(&read(SILENT, sets).unwrap_or_else(|e| panic!("{sets:?}: {e}")));
    }
}

/// Runs `scene`; the bytes of what its files say, without the machine's part in them.
fn results(scene: &Scene, out: &Path) -> Vec<Vec<u64>> {
    let options = Options {
        out: out.to_path_buf(),
        backend: Backend::Cpu,
        threads: 1,
        force: false,
        quiet: true,
    };
    run(scene, &options, &AtomicBool::new(false)).unwrap();
    let file = experiments::output::netcdf::open(&out.join("series.nc")).unwrap();
    let bits = |variable: netcdf::Variable| {
        let values: Vec<f64> = variable.get_values(..).unwrap();
        values.into_iter().map(f64::to_bits).collect()
    };
    file.variables().map(bits).collect()
}

/// From a loose start, from a bed, from a state, each read from the text in the results and in
/// another folder than the scene's own.
#[test]
fn the_resolved_scene_gives_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let twice = |scene: &Scene, name: &str| {
        let first = results(scene, &at(name));
        let kept = experiments::output::netcdf::open(&at(name).join("series.nc")).unwrap();
        let kept: String = kept
            .attribute("scene")
            .unwrap()
            .value()
            .unwrap()
            .try_into()
            .unwrap();
        assert_eq!(kept, scene.text);
        let second = results(&again(scene), &at(&format!("{name}-again")));
        assert!(first.len() > 20 && first[0].len() > 20);
        assert!(first == second, "{name}: the bits differ");
    };
    let loose = read(SILENT, &[]).unwrap();
    twice(&loose, "loose");

    let mut bed = String::from("x,y,z,radius\n");
    let grains = &loose.start.grains;
    for (p, r) in grains.position.iter().zip(&grains.radius) {
        bed += &format!("{:?},{:?},{:?},{r:?}\n", p.x, p.y, p.z);
    }
    fs::write(at("bed.csv"), bed).unwrap();
    let grains =
        "count   = 60\nradius  = { law = \"log-normal\", median = \"0.5 mm\", spread = 0.1 }\n";
    let from_here = |text: &str| {
        let document = Document::new("scene.toml", folder.path(), text, &[]).unwrap();
        Scene::read(&document).unwrap()
    };
    let text = SILENT.replace(grains, "bed = \"bed.csv\"\n");
    twice(&from_here(&text), "bed");

    let text = SILENT
        .replace(grains, "state = \"loose/state.h5\"\n")
        .replace("density = \"2600 kg/m^3\"\n", "")
        .replace("box.size = [\"6 mm\", \"6 mm\"]\n", "");
    twice(&from_here(&text), "state");
}
