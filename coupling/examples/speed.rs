//! What water costs: the dry step, the step with water, and where the difference goes.
//!
//! `cargo run --release -p coupling --example speed -- [TILES] [THREADS] [STEPS] [DIAMETERS]`
//!
//! A bed of 1000 grains, pressed here, is laid TILES x TILES times side by side. Dry and wet runs
//! take turns, and medians are printed. Cells are DIAMETERS grain diameters wide, 2 or 1.

use coupling::{Coupled, Model, Permeability, Resistance};
use dem::contact::{Linear, Sliding, Tension};
use dem::{ContactLaw, Domain, Solver, State, StressLoad, Surface, Wall, WallMotion, WallState};
use glam::DVec3;
use lbm::{Fluid, Side, Signal};
use std::time::Instant;

/// Side of one tile [m], and cells of two diameters along it and upwards.
const SIDE: f64 = 0.2;
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
    let model = model(tiles, 1e5, 78.0, 0.5, 0.0);
    println!("{grains} grains, {threads} threads, {steps} steps, medians of {TURNS} turns");

    let finer = N / 2;
    let cells = [CELLS * finer * tiles, CELLS * finer * tiles, LAYERS * finer];
    let water = |permeability: f64, interval: Option<u64>| {
        let law = Resistance::Darcy(Permeability::constant(permeability));
        let mut water = Model::new(cells, WATER, law);
        water.sides[1] = Side::Pressure(Signal::Steady(0.0));
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

const WATER: Fluid = Fluid {
    density: 1000.0,
    viscosity: 1.8e-3,
    compressibility: 4.5e-10,
};

fn model(tiles: usize, stress: f64, damping: f64, friction: f64, wall: f64) -> dem::Model {
    let side = SIDE * tiles as f64;
    let surface = |name: &str, normal, motion| Wall {
        name: name.into(),
        normal,
        surface: Surface::Frictionless,
        motion,
    };
    let load = StressLoad {
        mean: stress,
        amplitude: 0.0,
        frequency: 0.0,
        area: side * side,
        mass: 15.5 * (tiles * tiles) as f64,
        damping: wall * (tiles * tiles) as f64,
    };
    let law = Linear {
        normal_stiffness: 1e7,
        normal_damping: damping,
        tension: Tension::Clip,
        sliding: Some(Sliding {
            stiffness: 1e6,
            damping: 78.0,
            friction_static: friction,
            friction_dynamic: friction,
        }),
        rolling: None,
        twisting: None,
    };
    dem::Model {
        domain: Domain {
            size: [side; 2],
            periodic: [true, true],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::Linear(law),
        walls: vec![
            surface("bottom", DVec3::Z, WallMotion::Held),
            surface("top", -DVec3::Z, WallMotion::Stress(load)),
        ],
        drive: None,
        step: 6.6e-6,
        skin: None,
        ledger: true,
    }
}

/// A thousand grains that carry the wall.
fn pressed() -> State {
    let mut state = State::default();
    let mut x = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    for k in 0..1000 {
        let site = [k % 8, k / 8 % 8, k / 64];
        let place = site.map(|s| (s as f64 + 0.5 + 0.1 * (random() - 0.5)) * SIDE / 8.0);
        let radius = 1e-2 * (0.9 + 0.2 * random());
        let id = state.grains.add_sphere(DVec3::from(place), radius, 3600.0);
        state.grains.velocity[id as usize] = DVec3::new(random(), random(), random()) - 0.5;
    }
    let wall = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    state.walls = vec![wall(0.0), wall(-16.0 * SIDE / 8.0)];
    let model = model(1, 1e5, 300.0, 0.05, 3000.0);
    let mut solver = Solver::new(model, state, 1).expect("a loose bed is possible");
    solver.advance(50_000).expect("a stable step");
    let mut state = solver.snapshot().state;
    state.grains.velocity.fill(DVec3::ZERO);
    state.grains.angular_velocity.fill(DVec3::ZERO);
    state.walls[1].velocity = 0.0;
    state
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
            state.grains.add_sphere(*position + shift, *radius, 3600.0);
        }
    }
    state
}
