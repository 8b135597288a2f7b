//! What a scene says of water is what the solver gets.

use super::{BED, PIPE, read, read_in};
use experiments::backend::Backend;
use experiments::scene::water::{Precision, kozeny_carman};
use lbm::{Ends, Field, Fluid, Regime, Side, Signal};

#[test]
fn silence_is_cold_water_at_rest_between_two_plates() {
    let water = read(PIPE, &[]).unwrap().water;
    let model = &water.model;
    assert_eq!(model.fluid, Fluid::COLD_WATER);
    assert_eq!((model.cells, model.spacing), ([1, 1, 8], 1e-3));
    let stuck = Side::NoSlip([0.0; 3]);
    assert_eq!(
        model.ends,
        [
            Ends::Periodic,
            Ends::Periodic,
            Ends::Walls(stuck.clone(), stuck)
        ]
    );
    assert_eq!(model.regime, Some(Regime::Incompressible));
    assert!(!model.inertia && model.bed.is_none() && model.solid.is_empty());
    assert_eq!((model.acceleration, model.speed), ([0.0; 3], 0.0));
    assert_eq!(water.precision, Precision::F64);
    assert_eq!(water.start, lbm::State::at_rest(model));
}

/// The scene that the README shows is one, and drains.
#[test]
fn the_scene_of_the_readme_is_right() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md");
    let page = std::fs::read_to_string(page).unwrap();
    let text = page
        .split("```toml")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    let scene = read(text, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.water.model.cells, [1, 1, 32]);
    assert_eq!(scene.water.warnings(scene.steps()), [""; 0]);
}

#[test]
fn a_bed_has_tight_sides_that_nothing_sticks_to() {
    let scene = read(BED, &[]).unwrap();
    let model = &scene.water.model;
    let drained = Side::Pressure(Signal::Steady(0.0));
    assert_eq!(model.ends[2], Ends::Walls(Side::FreeSlip, drained));
    assert_eq!(model.regime, Some(Regime::Diffusive));
    assert!(scene.water.start.pressure.iter().all(|&p| p == 1e3));
    assert_eq!(
        model.bed.as_ref().unwrap().permeability,
        Field::Uniform(1e-12)
    );
    assert_eq!(model.bed.as_ref().unwrap().forchheimer, None);
}

#[test]
fn sides_move_push_and_pump() {
    let of = |set: &str| {
        let set = format!("water.sides.top={set}");
        let Ends::Walls(_, top) = read(PIPE, &[&set]).unwrap().water.model.ends[2].clone() else {
            panic!("z has walls")
        };
        top
    };
    assert_eq!(of("free-slip"), Side::FreeSlip);
    let moving = of("{ velocity = [\"1 mm/s\", \"2 mm/s\", \"0 m/s\"] }");
    assert_eq!(moving, Side::NoSlip([1e-3, 2e-3, 0.0]));
    assert_eq!(
        of("{ pressure = \"2 kPa\" }"),
        Side::Pressure(Signal::Steady(2e3))
    );
    let Side::Flux(sine) = of("{ flux = { amplitude = \"1 mm/s\", period = \"4 s\" } }") else {
        panic!("it is a flux")
    };
    let sine_of = |mean| Signal::Sinusoidal {
        mean,
        amplitude: 1e-3,
        frequency: 0.25,
        phase: 0.0,
    };
    assert_eq!(sine, sine_of(0.0));
    let table = "{ pressure = { times = [\"0 s\", \"2 s\"], values = [\"0 Pa\", \"1 kPa\"] } }";
    assert_eq!(
        of(table),
        Side::Pressure(Signal::Table(vec![[0.0, 0.0], [2.0, 1e3]]))
    );
}

#[test]
fn a_table_may_come_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("p.csv"),
        "# melt\npressure, time\n5, 0\n7.5, 10\n",
    )
    .unwrap();
    let set = "water.sides.top={ pressure = { file = \"p.csv\" } }";
    let scene = read_in(folder.path(), PIPE, &[set]).unwrap();
    let table = Side::Pressure(Signal::Table(vec![[0.0, 5.0], [10.0, 7.5]]));
    assert!(matches!(&scene.water.model.ends[2], Ends::Walls(_, top) if *top == table));
    // The text in the results finds it from anywhere.
    assert_eq!(read(&scene.text, &[]).unwrap(), scene);
    std::fs::write(folder.path().join("p.csv"), "time,pressure\n0,5\n0,6\n").unwrap();
    let error = read_in(folder.path(), PIPE, &[set])
        .unwrap_err()
        .to_string();
    assert!(error.contains("line 3: times must increase"), "{error}");
}

#[test]
fn layers_lie_on_each_other() {
    let layers = r#"
[[water.bed.layer]]
top = "3 cm"
porosity = 0.3
permeability = "kozeny-carman"
grain_size = "1 mm"
forchheimer = "ergun"

[[water.bed.layer]]
porosity = 0.5
permeability = "1e-9 m^2"
"#;
    let text = BED.replace("porosity = 0.4\npermeability = \"1e-12 m^2\"\n", layers);
    let text = text.replace("[water.bed]\n", "");
    let scene = read(&text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let bed = scene.water.model.bed.as_ref().unwrap();
    let low = kozeny_carman(0.3, 1e-3);
    let expected = |a: f64, b: f64| Field::Cells([vec![a; 3], vec![b; 5]].concat());
    assert_eq!(bed.porosity, expected(0.3, 0.5));
    assert_eq!(bed.permeability, expected(low, 1e-9));
    let Some(Field::Cells(drag)) = &bed.forchheimer else {
        panic!("one layer has a drag beyond Darcy's")
    };
    // 1.75 (1 - φ) / φ³ d
    approx::assert_relative_eq!(drag[0], 45370.37, max_relative = 1e-6);
    assert_eq!((drag[2], drag[3]), (drag[0], 0.0));
    // d² φ³ / 180 (1 - φ)² = 1e-6 · 0.027 / (180 · 0.49)
    approx::assert_relative_eq!(low, 3.0612e-10, max_relative = 1e-4);
}

#[test]
fn what_no_water_can_cross_is_called_undrained() {
    let told = |sets: &[&str]| {
        let scene = read(BED, sets).unwrap();
        let warnings = scene.water.warnings(scene.steps());
        warnings.iter().any(|warning| warning.contains("undrained"))
    };
    // D = 2.7 m²/s: over a cell of 1 cm in 40 us.
    assert!(!told(&[]));
    assert!(!told(&["end.duration=20 us"]));
    assert!(told(&["water.bed.permeability=1e-17 m^2"]));
}

#[test]
fn a_chosen_step_is_no_longer_than_what_the_scene_asks_for() {
    let step = |sets: &[&str]| read(BED, sets).unwrap().water.scaling.step;
    let tight = "water.bed.permeability=1e-16 m^2";
    approx::assert_relative_eq!(step(&[tight, "end.duration=3 ms"]), 3e-3);
    let rows = "output.series.every=1 ms";
    approx::assert_relative_eq!(step(&[tight, "end.duration=3 ms", rows]), 1e-3);
    // Permeable beds have shorter ones of their own.
    assert!(step(&["end.duration=1 s"]) < 1e-4);
}

#[test]
fn double_precision_is_never_computed_in_single() {
    let refused = Backend::Gpu
        .choose_for_water(1000, Precision::F64, 1)
        .unwrap_err();
    assert!(
        refused.to_string().contains("water.precision=f32"),
        "{refused}"
    );
    let chosen = Backend::Auto
        .choose_for_water(1_000_000_000, Precision::F64, 1)
        .unwrap();
    assert_eq!(chosen.machine.backend(), "cpu");
}

#[test]
fn what_a_lattice_refuses_stands_at_the_key_that_mends_it() {
    let wrong = |text: &str, sets: &[&str]| read(text, sets).unwrap_err().to_string();
    let error = wrong(PIPE, &["water.step=10 s"]);
    assert!(
        error.contains("water.step: cannot be right: relaxation time"),
        "{error}"
    );
    // Pressure that changes by less than rounding.
    let error = wrong(BED, &["water.precision=f32", "water.step=1e-15 s"]);
    assert!(error.contains("write") || error.contains("give"), "{error}");
    assert!(
        error.contains("water.precision") || error.contains("water.step"),
        "{error}"
    );
}

#[test]
fn a_bed_that_nothing_resists_in_is_not_undrained() {
    let scene = read(BED, &["water.bed.permeability=infinite"]).unwrap();
    assert_eq!(scene.water.diffusivity(), f64::INFINITY);
    assert_eq!(scene.water.warnings(scene.steps()), [""; 0]);
    let facts = scene.water.facts(scene.steps());
    assert!(
        facts.iter().all(|(what, _)| *what != "diffusivity"),
        "{facts:?}"
    );
}

#[test]
fn a_run_has_no_more_steps_than_can_be_made() {
    let sets = ["water.step=4 us", "end.duration=1e30 s"];
    let says = read(BED, &sets).unwrap_err().to_string();
    assert!(says.contains("end.duration: is 2.5e35 steps"), "{says}");
}
