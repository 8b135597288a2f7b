//! What a scene says is what the solver gets.

use super::{SMALL, read};
use dem::contact::{Linear, Sliding, Tension};
use dem::{ContactLaw, WallMotion};
use experiments::output::FileKind;
use experiments::ready;
use experiments::scene::{Motion, Shear};
use glam::DVec3;

#[test]
fn the_posters_numbers_arrive_in_si() {
    let scene = read(ready::find("poster-shear").unwrap().scene(), &[]).unwrap();
    let law = ContactLaw::Linear(Linear {
        normal_stiffness: 1e9,
        normal_damping: 780.0,
        tension: Tension::Clip,
        sliding: Some(Sliding {
            stiffness: 1e8,
            damping: 780.0,
            friction_static: 0.58,
            friction_dynamic: 0.47,
        }),
        rolling: None,
        twisting: None,
    });
    assert!(scene.phases.iter().all(|phase| phase.law == law));
    assert_eq!(scene.step, 6.60e-7);
    assert!(scene.step < scene.stable_step());
    let grains = &scene.start.grains;
    assert_eq!(grains.len(), 10_000);
    approx::assert_relative_eq!(grains.mean_radius(), 1e-2, max_relative = 1e-3);
    assert_eq!(scene.phases[2].shear, Some(Shear::StrainRate(0.25)));
    assert_eq!(scene.phases[2].end.strain, Some(1.0));
    assert_eq!(scene.phases[2].start, Motion::Profile);
    let WallMotion::Stress(load) = scene.phases[2].top else {
        panic!("the wall carries a stress");
    };
    assert_eq!(load.mean, 1e5);
    approx::assert_relative_eq!(load.mass, grains.mass.iter().sum::<f64>());
    let damping = 10.0 * load.area * (1e5 * 3600.0f64).sqrt();
    approx::assert_relative_eq!(load.damping, damping, max_relative = 1e-12);
}

#[test]
fn a_restitution_becomes_the_damping_that_gives_it() {
    let set = "contact.normal={ stiffness = \"1e5 N/m\", restitution = 0.4 }";
    for (tension, clipped) in [("clip", true), ("keep", false)] {
        let scene = read(SMALL, &[set, &format!("contact.tension={tension}")]).unwrap();
        let damping = scene.phases[0].law.normal_damping();
        let m = 0.5 * scene.start.grains.mass[0];
        let back = dem::stability::restitution(1e5, damping, m, clipped);
        approx::assert_relative_eq!(back, 0.4, max_relative = 1e-9);
    }
}

#[test]
fn gravity_is_a_magnitude_a_tilt_or_a_vector() {
    let of = |sets: &[&str]| read(SMALL, sets).unwrap().phases[0].gravity;
    assert_eq!(of(&[]), DVec3::new(0.0, 0.0, -9.81));
    assert_eq!(of(&["box.gravity=none"]), DVec3::ZERO);
    let tilted = of(&["box.tilt=30 degrees"]);
    approx::assert_relative_eq!(tilted.x, 4.905, max_relative = 1e-12);
    let vector = of(&["box.gravity=[\"1 m/s^2\", \"2 m/s^2\", \"-3 m/s^2\"]"]);
    assert_eq!(vector, DVec3::new(1.0, 2.0, -3.0));
    let scene = read(SMALL, &["phase.shear.gravity=none"]).unwrap();
    assert_eq!(scene.phases[0].gravity.z, -9.81);
    assert_eq!(scene.phases[2].gravity, DVec3::ZERO);
}

#[test]
fn a_phase_may_have_its_own_friction() {
    let scene = read(
        SMALL,
        &[
            "phase.settle.friction=none",
            "phase.consolidate.friction=0.1",
        ],
    );
    let friction = |law: ContactLaw| match law {
        ContactLaw::Linear(law) => law.sliding.map(|s| s.friction_static),
        ContactLaw::LinearLammps(_) => None,
    };
    let phases = scene.unwrap().phases;
    let all: Vec<_> = phases.iter().map(|phase| friction(phase.law)).collect();
    assert_eq!(all, [None, Some(0.1), Some(0.5)]);
}

#[test]
fn walls_stand_where_sides_are_not_periodic() {
    let scene = read(SMALL, &["box.sides.y=walls", "box.sides.x=periodic"]).unwrap();
    let model = experiments::protocol::model(&scene, &scene.phases[0], 1.0);
    let names: Vec<&str> = model.walls.iter().map(|wall| wall.name.as_str()).collect();
    assert_eq!(names, ["bottom", "top", "front", "back"]);
    for (wall, state) in model.walls.iter().zip(&scene.start.walls) {
        for (p, r) in scene
            .start
            .grains
            .position
            .iter()
            .zip(&scene.start.grains.radius)
        {
            assert!(
                wall.normal.dot(*p) - state.offset >= r - 1e-12,
                "{}",
                wall.name
            );
        }
    }
}

#[test]
fn the_series_holds_the_friction_of_the_walls_that_have_some() {
    let names = |sets: &[&str]| {
        let output = read(SMALL, sets).unwrap().output;
        let series = output.files[FileKind::Series].clone().unwrap();
        let mut names = series.variables;
        names.retain(|name| name.starts_with("wall_shear_stress"));
        names
    };
    assert!(names(&[]).is_empty());
    let top = ["wall_shear_stress_top_x", "wall_shear_stress_top_y"];
    assert_eq!(names(&["wall.top.surface=full"]), top);
    assert_eq!(
        names(&["wall.top.surface=full", "wall.bottom.surface=full"]).len(),
        4
    );
    let asked = "output.series.variables=[\"wall_shear_stress_bottom_x\"]";
    assert_eq!(names(&[asked]), ["wall_shear_stress_bottom_x"]);
}

#[test]
fn the_ledger_is_kept_only_where_an_output_needs_it() {
    let ledger = |set: &str| {
        let scene = read(SMALL, &[set]).unwrap();
        experiments::protocol::model(&scene, &scene.phases[0], 1.0).ledger
    };
    assert!(ledger("seed=1"));
    assert!(!ledger(
        "output.series.variables=[\"wall_height\", \"kinetic_energy\"]"
    ));
    assert!(ledger("output.series.variables=[\"work_drive\"]"));
    assert!(!ledger("output.series=none"));
}

/// The catalogue gives NaN for what needs sums that are not kept.
#[test]
fn the_ledger_is_kept_for_every_variable_that_needs_it() {
    for scalar in dem::output::SERIES {
        let name = scalar.variable.name;
        let set = format!("output.series.variables=[{name:?}]");
        let scene = read(SMALL, &[&set]).unwrap();
        let mut model = experiments::protocol::model(&scene, &scene.phases[1], 1.0);
        let kept = model.ledger;
        let value = |model: &dem::Model| {
            let mut solver = dem::Solver::new(model.clone(), scene.start.clone(), 1).unwrap();
            solver.advance(2).unwrap();
            let before = dem::Sums::default();
            solver.snapshot().read(scalar, model, &before).is_nan()
        };
        model.ledger = true;
        let ever = value(&model);
        model.ledger = false;
        assert_eq!(value(&model) && !ever, kept, "{name}");
    }
}

#[test]
fn layers_that_may_not_fit_are_warned_of() {
    let warnings = |sets: &[&str]| read(SMALL, sets).unwrap().warnings();
    assert_eq!(warnings(&["grains.count=240"]), [] as [&str; 0]);
    // The bed will be 1.45 mm high, at most 2.7 mm.
    let thick = warnings(&["phase.shear.layer=0.8 mm"]).concat();
    let expected = "0.0008 m each take 110 % of the bed, which will be about 0.0015 m high";
    assert!(
        thick.starts_with("phase shear: ") && thick.contains(expected),
        "{thick}"
    );
    let thin = warnings(&["grains.count=240", "phase.shear.layer=0.46 mm"]).concat();
    assert!(thin.contains("the largest radius is 5.0000e-4 m"), "{thin}");
}

#[test]
fn intervals_that_nobody_stated_are_never_shorter_than_a_step() {
    let end = "end={ duration = \"10 us\" }";
    let ends = ["settle", "consolidate", "shear"].map(|phase| format!("phase.{phase}.{end}"));
    let ends = ends.each_ref().map(String::as_str);
    let scene = read(SMALL, &ends).unwrap();
    let every = |kind| scene.output.files[kind].as_ref().unwrap().every;
    assert_eq!(every(FileKind::Series), scene.step);
    assert!(every(FileKind::Grains) > scene.step);
}
