//! What a scene says of the water between its grains is what the coupling gets.

use super::wet;
use crate::read;
use coupling::{NormalStress, Permeability, Resistance};
use experiments::scene::water::pores::{Reach, Stiffness, Suction};
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
    assert_eq!((water.stiffness, water.loose), (Stiffness::Measured, 1.0));
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
        "water.loose=2",
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
    assert_eq!(model.loose, 2.0);
}

#[test]
fn water_may_be_pushed_in_through_a_wall() {
    let scene = wet(&["phase.load.water={ bottom = { flux = \"3 mm/s\" } }"]);
    let edges = scene.phases[1].water.as_ref().unwrap();
    let flux = Side::Flux(Signal::Steady(3e-3));
    assert_eq!(edges.sides, [flux, drained()]);
    let both = "phase.load.water={ bottom = { flux = \"3 mm/s\", pressure = \"1 Pa\" } }";
    let said = read(super::WET, &[both]).unwrap_err().to_string();
    assert!(said.contains("contradicts flux"), "{said}");
}

#[test]
fn a_suspension_fills_the_part_of_the_room_that_it_is_told() {
    let part = |scene: &experiments::scene::Scene| {
        let grains = &scene.start.grains;
        let volume: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
        let height = -scene.start.walls[1].offset;
        volume / (scene.domain.area() * height)
    };
    for (set, fraction) in [("seed=2", 0.25), ("grains.solid_fraction=0.05", 0.05)] {
        let found = part(&wet(&[set]));
        // A grain's height is added, and the highest grain may be lower than there is room.
        assert!((found / fraction - 1.0).abs() < 0.2, "{set}: {found}");
    }
    let dense = read(super::WET, &["grains.solid_fraction=0.5"]).unwrap_err();
    assert!(dense.to_string().contains("solid_fraction"), "{dense}");
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

/// Cells two millimetres wide, and as high as they can be told to be.
#[test]
fn layers_follow_from_the_room_that_the_water_finds() {
    let layers = |text: &str, sets: &[&str]| {
        let scene = read(text, sets).unwrap_or_else(|e| panic!("{e}"));
        scene.water.unwrap().cells[2]
    };
    // The first phase pushes the wall down onto the grains: 200 grains of 0.52 mm³ at 0.6 on 16 mm².
    assert_eq!(layers(super::WET, &["grains.solid_fraction=0.1"]), 6);
    let high = "box.size=[\"4 mm\", \"4 mm\", \"80 mm\"]";
    assert_eq!(layers(super::WET, &[high]), 6);
    // A suspension under a lid that stays: at 0.1, 65 mm, and the highest grain in it.
    let top = "top      = { normal_stress = \"10 kPa\", damping = \"0.05 N s/m\" }\n";
    let held = super::WET
        .replace(top, "")
        .replace("water    = \"none\"\n", "");
    let end = "phase.press.end={ duration = \"1 ms\" }";
    let of_suspension = layers(&held, &[end, "grains.solid_fraction=0.1"]);
    assert!((30..=34).contains(&of_suspension), "{of_suspension}");
    assert_eq!(layers(&held, &[end, high]), 40);
    // A lid that has come down by 30 mm when the water comes, or onto the bed.
    let moved = |end: &str| {
        let top = "phase.press.top={ velocity = \"1 m/s\" }";
        layers(super::WET, &[top, "phase.load.top=held", high, end])
    };
    assert_eq!(moved("phase.press.end={ duration = \"30 ms\" }"), 25);
    assert_eq!(moved("phase.press.end={ duration = \"90 ms\" }"), 6);
}

/// Dilation ψ of a bed of height h at the rate γ̇ sucks μ ψ γ̇ h²/2k, where water comes from one side.
#[test]
fn suction_follows_from_the_way_to_open_walls() {
    let suction = |sets: &[&str], height: f64| {
        let scene = wet(sets);
        let water = scene.water.as_ref().unwrap();
        let edges = scene.phases[2].water.as_ref().unwrap();
        water.suction(edges, 0.4, height, 5.0)
    };
    let one = suction(&[], 0.01);
    let theory = 1.8e-3 * 0.25 * 5.0 * 1e-4 / (2.0 * 2e-13);
    assert!(
        matches!(one, Suction::Steady(p) if (p / theory - 1.0).abs() < 0.01),
        "{one:?}"
    );
    // Half of the way from two sides, and twice the height.
    assert_eq!(suction(&["water.sides.bottom=drained"], 0.02), one);
    let sealed = suction(&["water.sides.top=tight", "water.stiffness=10 MPa"], 0.01);
    let theory = 0.25 * 1e7 / (1.0 + 0.4 * 5.1e-10 * 1e7);
    assert!(
        matches!(sealed, Suction::Grows(p) if (p / theory - 1.0).abs() < 0.01),
        "{sealed:?}"
    );
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
            "exchange",
            "interval",
            "cavitation",
            "loose",
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
