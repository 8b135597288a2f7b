//! What a scene says of the water between its grains is what the coupling gets.

use super::wet;
use crate::read;
use coupling::{NormalStress, Permeability, Resistance};
use experiments::scene::water::pores::{Reach, Stiffness};
use lbm::{Fluid, Side, Signal};

fn drained() -> Side {
    Side::Pressure(Signal::Steady(0.0))
}

#[test]
fn silence_is_cold_water_between_tight_walls_in_cells_of_two_diameters() {
    let silent = super::WET.replace("sides.top        = \"drained\"\n", "");
    let silent = silent.replace("water    = \"none\"\n", "");
    let scene = read(&silent, &["phase.press.end={ duration = \"1 ms\" }"]).unwrap();
    let water = scene.water.unwrap();
    assert_eq!(water.fluid, Fluid::COLD_WATER);
    // 200 grains of half a cubic millimetre at a solid fraction of 0.6: 11 mm.
    assert_eq!(water.cells, [2, 2, 6]);
    assert!((water.spacing / 2e-3 - 1.0).abs() < 1e-6);
    assert_eq!(water.reach, Reach::Three);
    assert_eq!((water.interval, water.cavitation), (None, None));
    assert_eq!(water.stiffness, Stiffness::Measured);
    assert_eq!(scene.phases.len(), 3);
    for phase in &scene.phases {
        let edges = phase.water.as_ref().unwrap();
        assert_eq!(edges.sides, [Side::FreeSlip, Side::FreeSlip]);
        assert_eq!(edges.normal_stress, NormalStress::Total);
    }
}

#[test]
fn phases_are_dry_or_have_walls_of_their_own() {
    let scene = wet(&[
        "phase.shear.water={ bottom = { pressure = \"2 kPa\" }, normal_stress = \"effective\" }",
        "water.interval=4",
        "water.stiffness=30 MPa",
        "water.cavitation=-90 kPa",
    ]);
    let water = scene.water.as_ref().unwrap();
    assert!(scene.phases[0].water.is_none());
    let press = scene.phases[1].water.as_ref().unwrap();
    assert_eq!(press.sides, [Side::FreeSlip, drained()]);
    let shear = scene.phases[2].water.as_ref().unwrap();
    assert_eq!(
        shear.sides,
        [Side::Pressure(Signal::Steady(2e3)), drained()]
    );
    assert_eq!(shear.normal_stress, NormalStress::Effective);
    assert_eq!(water.stiffness, Stiffness::Given(3e7));
    let model = water.model(shear, Some(1.0));
    assert_eq!(model.sides, shear.sides);
    assert_eq!((model.interval, model.stiffness), (Some(4), Some(1.0)));
    assert_eq!(model.cavitation.unwrap().pressure, -9e4);
}

#[test]
fn the_bed_resists_as_it_is_told() {
    let of = |sets: &[&str]| wet(sets).water.unwrap().resistance;
    let constant = Permeability::constant(2e-13);
    assert_eq!(of(&[]), Resistance::Darcy(constant));
    let by_size = Permeability::kozeny_carman(1e-3);
    let named = of(&["water.bed={ permeability = \"kozeny-carman\", grain_size = \"1 mm\" }"]);
    let (Resistance::Darcy(named), water) = (named, Fluid::COLD_WATER) else {
        panic!("Kozeny and Carman are linear")
    };
    approx::assert_relative_eq!(named.at(0.4), by_size.at(0.4), max_relative = 1e-12);
    let free = of(&["water.bed.permeability={ prefactor = \"1e-12 m^2\" }"]);
    assert_eq!(free, Resistance::Darcy(Permeability::prefactor(1e-12)));
    let bounded = of(&["water.bed.within=[\"1e-14 m^2\", \"1e-13 m^2\"]"]);
    assert_eq!(bounded, Resistance::Darcy(constant.within([1e-14, 1e-13])));
    let sets = "water.bed={ drag = \"ergun\", grain_size = \"2 mm\" }";
    let ergun = of(&[sets]);
    assert_eq!(ergun, Resistance::Ergun { diameter: 2e-3 });
    assert!(ergun.at(&water, 0.4, 1.0) > ergun.at(&water, 0.4, 0.0));
}

#[test]
fn cells_are_square_whatever_the_box() {
    let cells = |size: &str, sets: &[&str]| {
        let size = format!("box.size={size}");
        let water = wet(&[&[size.as_str()], sets].concat()).water.unwrap();
        (water.cells, water.reach)
    };
    // Two diameters of 1 mm.
    let (of_box, reach) = cells("[\"8 mm\", \"6 mm\"]", &[]);
    assert_eq!((of_box[0], of_box[1], reach), (4, 3, Reach::Three));
    let (of_box, reach) = cells("[\"8 mm\", \"6 mm\"]", &["water.spacing=1 mm"]);
    assert_eq!((of_box[0], of_box[1], reach), (8, 6, Reach::Five));
    let (of_box, _) = cells("[\"8 mm\", \"6 mm\"]", &["water.layers=9"]);
    assert_eq!(of_box[2], 9);
}

#[test]
fn the_resolved_scene_is_the_same_scene() {
    let changes: &[&[&str]] = &[
        &[],
        &["water.bed.permeability=kozeny-carman"],
        &[
            "water.bed={ drag = \"di-felice\" }",
            "water.stiffness=unknown",
        ],
        &["phase.shear.water={ top = { pressure = { amplitude = \"1 kPa\", period = \"1 s\" } } }"],
        &["box.size=[\"8 mm\", \"6 mm\"]", "water.cavitation=-100 kPa"],
    ];
    for sets in changes {
        let scene = wet(sets);
        let again = read(&scene.text, &[]).unwrap_or_else(|e| panic!("{e}\n{}", scene.text));
        assert_eq!(scene.text, again.text);
        assert!(scene == again, "not the same scene:\n{}", scene.text);
        for key in [
            "layers",
            "spacing",
            "interval",
            "cavitation",
            "normal_stress",
            "bottom",
        ] {
            assert!(
                scene.text.contains(&format!("{key} = ")),
                "{key}:\n{}",
                scene.text
            );
        }
    }
}
