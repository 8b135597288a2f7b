//! A bed of open pores: at rest in water, and under water that rises until it floats.

use crate::loose::*;
use coupling::{Coupled, Model, Resistance};
use dem::State;
use glam::DVec3;
use lbm::{Side, Signal};
use std::sync::OnceLock;

const LAW: Resistance = Resistance::Ergun { diameter: DIAMETER };
const COUNT: usize = 860;
const WIDTH: f64 = 5.0 * DIAMETER;
/// Cells across, and layers of the height of a grain.
const ACROSS: usize = 2;
const LAYERS: usize = 48;
const LID: f64 = 48.0 * DIAMETER;

fn bed(sides: [Side; 2]) -> Coupled<3> {
    static BED: OnceLock<State> = OnceLock::new();
    let state = BED.get_or_init(|| laid(COUNT, WIDTH, LID)).clone();
    let mut water = Model::new([ACROSS, ACROSS, LAYERS], WATER, LAW);
    water.sides = sides;
    Coupled::new(model([WIDTH; 2]), state, water, None, 1).unwrap()
}

/// Buoyant weight of the bed [N].
fn weight(bed: &Coupled<3>) -> f64 {
    let grains = bed.grains().snapshot().state.grains;
    let volume: f64 = (0..COUNT).map(|k| grains.volume(k)).sum();
    volume * (DENSITY - WATER.density) * GRAVITY
}

#[test]
fn a_bed_at_rest_in_water_stays_at_rest_and_weighs_less_by_its_buoyancy() {
    let mut bed = bed([Side::FreeSlip, Side::FreeSlip]);
    let mut fastest = Vec::new();
    for _ in 0..5 {
        bed.advance(2000).unwrap();
        let grains = bed.grains().snapshot().state.grains;
        // Nothing holds the bed along its smooth bottom.
        let drift = grains.velocity.iter().sum::<DVec3>() / COUNT as f64;
        let each = grains.velocity.iter().map(|v| (v - drift).length());
        fastest.push(each.fold(0.0, f64::max));
    }
    let pressure = bed
        .water()
        .pressure()
        .iter()
        .fold(0.0, |m: f64, p| m.max(p.abs()));
    let ratio = bed.grains().snapshot().wall_force[0] / weight(&bed);
    println!("fastest {fastest:?} m/s, pressure {pressure:e} Pa, weight {ratio}");
    assert!(
        fastest[4] < 1e-5 && fastest[4] < 0.5 * fastest[0],
        "{fastest:?}"
    );
    assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
    assert!(pressure < 0.02, "{pressure}");
}

/// What a flux [m/s] upward takes: gradient of pressure [Pa/m] in the lower half of the bed, its
/// mean porosity there, and the height of the uppermost grain [m].
struct Reading {
    flux: f64,
    gradient: f64,
    porosity: f64,
    top: f64,
    /// Share of the weight that the bottom bears.
    borne: f64,
}

/// The layers between which pressure is read.
const LOW: usize = 4;
const HIGH: usize = 20;

fn read(bed: &Coupled<3>, flux: f64) -> Reading {
    let now = bed.snapshot();
    let layer = |k: usize, of: &[f64]| of[4 * k..4 * (k + 1)].iter().sum::<f64>() / 4.0;
    let drop = layer(LOW, &now.pressure) - layer(HIGH, &now.pressure);
    let pores = (LOW..HIGH).map(|k| 0.5 * (layer(k, &now.porosity) + layer(k + 1, &now.porosity)));
    let grains = bed.grains().snapshot().state.grains;
    Reading {
        flux,
        gradient: drop / ((HIGH - LOW) as f64 * now.height),
        porosity: pores.sum::<f64>() / (HIGH - LOW) as f64,
        borne: bed.grains().snapshot().wall_force[0] / weight(bed),
        top: grains.position.iter().fold(0.0, |m: f64, x| m.max(x.z)),
    }
}

#[test]
fn a_bed_floats_at_the_flux_of_ergun() {
    let least = balance(LAW, 0.58);
    let (duration, from, to) = (0.4, 0.7 * least, 1.3 * least);
    let ramp = Signal::Table(vec![[0.0, 0.0], [0.05, from], [0.05 + duration, to]]);
    let mut bed = bed([
        Side::Flux(ramp.clone()),
        Side::Pressure(Signal::Steady(0.0)),
    ]);
    let mut readings = Vec::new();
    for k in 0..46 {
        bed.advance(500).unwrap();
        let time = (k + 1) as f64 * 500.0 * STEP;
        readings.push(read(&bed, ramp.at(time)));
    }
    let weight = |r: &Reading| (1.0 - r.porosity) * (DENSITY - WATER.density) * GRAVITY;
    let ergun = |r: &Reading| LAW.at(&WATER, r.porosity, r.flux) * r.flux;
    for r in &readings {
        println!(
            "q {:.5} gradient {:.1}, Ergun {:.1}, weight {:.1}; porosity {:.4} top {:.5} borne {:.4}",
            r.flux,
            r.gradient,
            ergun(r),
            weight(r),
            r.porosity,
            r.top,
            r.borne
        );
    }
    // Before: Ergun's law, once the water that was at rest has got to speed.
    for r in readings
        .iter()
        .filter(|r| (0.85..0.95).contains(&(r.flux / least)))
    {
        assert!(
            (r.gradient / ergun(r) - 1.0).abs() < 0.03,
            "{} of {}",
            r.gradient,
            ergun(r)
        );
    }
    // The flux at which pressure first bears the weight, and that of Ergun at this porosity.
    let at = readings
        .iter()
        .position(|r| r.gradient > weight(r))
        .unwrap();
    let [a, b] = [&readings[at - 1], &readings[at]];
    let [under, over] = [a, b].map(|r| r.gradient - weight(r));
    let onset = a.flux - under * (b.flux - a.flux) / (over - under);
    let theory = balance(LAW, 1.0 - b.porosity);
    println!("floats at {onset} of {theory} m/s");
    assert!((onset / theory - 1.0).abs() < 0.05, "{onset} of {theory}");
    // Afterwards pressure bears the bed and no more, and the bed expands.
    let last = readings.last().unwrap();
    assert!(
        (last.gradient / weight(last) - 1.0).abs() < 0.05,
        "{}",
        last.gradient
    );
    assert!(last.borne < 0.01, "{}", last.borne);
    assert!(
        last.porosity > readings[0].porosity + 0.005,
        "{}",
        last.porosity
    );
}

/// Without gravity: what moving grains lose the water gets.
#[test]
fn momentum_goes_from_grains_to_water_and_none_is_lost() {
    let size = [6.0 * DIAMETER, 6.0 * DIAMETER, 12.0 * DIAMETER];
    let mut state = grains(&scattered(size, 0.2, 3), size[2]);
    let mut random = crate::bed::random(9);
    for velocity in &mut state.grains.velocity {
        *velocity = DVec3::new(0.02 * random(), 0.01 * random(), 0.0);
    }
    let mut grains = model([size[0], size[1]]);
    grains.gravity = DVec3::ZERO;
    // No search, which would renew the weights too.
    grains.skin = Some(0.5 * DIAMETER);
    let law = Resistance::DiFelice { diameter: DIAMETER };
    let water = Model {
        // Porosities that change take momentum along, which is convection: not solved.
        renewal: Some(10_000),
        ..Model::new([3, 3, 6], WATER, law)
    };
    let mut bed = Coupled::<3>::new(grains, state, water, None, 1).unwrap();
    let of_grains = |bed: &Coupled<3>| {
        let grains = bed.grains().snapshot().state.grains;
        let each = grains.mass.iter().zip(&grains.velocity);
        each.map(|(mass, velocity)| *mass * *velocity)
            .sum::<DVec3>()
    };
    let first = of_grains(&bed);
    bed.advance(49).unwrap();
    // The last push is half in the grains' velocities, and whole in the water's.
    let before = DVec3::from(bed.water().momentum());
    bed.advance(1).unwrap();
    let water = 0.5 * (before + DVec3::from(bed.water().momentum()));
    let grains = of_grains(&bed);
    for axis in 0..2 {
        let ratio = (grains[axis] + water[axis]) / first[axis];
        assert!((ratio - 1.0).abs() < 1e-12, "{axis}: {ratio}");
        assert!(water[axis] > 0.02 * first[axis], "{water}");
    }
}
