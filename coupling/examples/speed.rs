//! What water costs: the dry step, the step with water, and where the difference goes.
//!
//! `cargo run --release -p coupling --example speed -- [TILES] [THREADS] [STEPS] [DIAMETERS]`
//!
//! A bed of 1000 grains, pressed here, is laid TILES x TILES times side by side. Dry and wet runs
//! take turns, and medians are printed. Cells are DIAMETERS grain diameters wide, 2 or 1.

#[path = "../tests/verification/bed.rs"]
#[allow(dead_code, reason = "tests need more of the bed")]
mod bed;

use bed::{DENSITY, SIDE, STRESS, WATER, drained, law, pressed, with_load};
use coupling::{Coupled, Model, Permeability, Resistance};
use dem::{Solver, State, StressLoad};
use glam::DVec3;
use std::time::Instant;

/// Cells of two diameters along a tile and upwards.
const CELLS: usize = 5;
const LAYERS: usize = 4;
const TURNS: usize = 5;

fn main() {
    let mut numbers = std::env::args().skip(1).map(|arg| {
        arg.parse::<usize>()
            .unwrap_or_else(|_| panic!("{arg} is not a whole number"))
    });
    let tiles = numbers.next().unwrap_or(1);
    let threads = numbers.next().unwrap_or(1);
    let steps = numbers.next().unwrap_or(2048) as u64;
    match numbers.next().unwrap_or(2) {
        2 => compare::<3>(tiles, threads, steps),
        1 => compare::<5>(tiles, threads, steps),
        other => panic!("cells of {other} diameters are none of 2 and 1"),
    }
}

/// Dry and wet steps in turns, in cells whose kernel reaches `N`.
fn compare<const N: usize>(tiles: usize, threads: usize, steps: u64) {
    let state = tile(&pressed(), tiles);
    let grains = state.grains.len();
    let model = model(tiles);
    println!("{grains} grains, {threads} threads, {steps} steps, medians of {TURNS} turns");

    let finer = N / 2;
    let cells = [CELLS * finer * tiles, CELLS * finer * tiles, LAYERS * finer];
    let water = |permeability: f64, interval: Option<u64>| {
        let law = Resistance::Darcy(Permeability::constant(permeability));
        let mut water = Model::new(cells, WATER, law);
        water.sides[1] = drained();
        water.interval = interval;
        let bed = Coupled::<N>::new(model.clone(), state.clone(), water, None, threads);
        bed.expect("the water is possible")
    };
    // Fluid steps so rare that they cost nothing, then every 16 steps, then every one.
    let mut dry = Solver::new(model.clone(), state.clone(), threads).expect("a bed is possible");
    let mut wet = [
        ("prediction alone", water(1e-18, Some(1 << 20))),
        ("n = 16", water(1e-12, Some(16))),
        ("n = 1", water(1e-12, Some(1))),
        ("n = 1, drained", water(1e-10, Some(1))),
    ];
    let mut times = vec![Vec::new(); 1 + wet.len()];
    for _ in 0..TURNS {
        let start = Instant::now();
        dry.advance(steps).expect("a stable step");
        times[0].push(start.elapsed().as_secs_f64());
        for (k, (_, bed)) in wet.iter_mut().enumerate() {
            let start = Instant::now();
            bed.advance(steps).expect("a stable step");
            times[k + 1].push(start.elapsed().as_secs_f64());
        }
    }
    let each = 1e9 / (steps as f64 * grains as f64);
    let medians: Vec<f64> = times
        .iter_mut()
        .map(|times| {
            times.sort_by(f64::total_cmp);
            times[TURNS / 2] * each
        })
        .collect();
    println!("{:>20} {:8.1} ns a grain and step", "dry", medians[0]);
    for ((name, bed), median) in wet.iter().zip(&medians[1..]) {
        let ratio = median / medians[0];
        let sub_steps = bed.report().sub_steps;
        println!("{name:>20} {median:8.1}  {ratio:.2} of dry, {sub_steps} sub-steps");
    }
}

/// The bed of that many tiles under its load.
fn model(tiles: usize) -> dem::Model {
    let many = (tiles * tiles) as f64;
    let one = bed::model(law(), STRESS);
    let mut model = with_load(&one, |load| StressLoad {
        area: many * load.area,
        mass: many * load.mass,
        ..load
    });
    model.domain.size = [SIDE * tiles as f64; 2];
    model
}

/// The bed many times side by side, its contacts new.
fn tile(one: &State, tiles: usize) -> State {
    let mut state = State {
        walls: one.walls.clone(),
        ..State::default()
    };
    for k in 0..tiles * tiles {
        let shift = DVec3::new((k % tiles) as f64, (k / tiles) as f64, 0.0) * SIDE;
        for (position, radius) in one.grains.position.iter().zip(&one.grains.radius) {
            state.grains.add_sphere(*position + shift, *radius, DENSITY);
        }
    }
    state
}
