//! How fast is a step, and how fast could it be?
//!
//! `cargo run --release -p lbm --example speed -- [CELLS PER SIDE] [THREADS]`
//!
//! The populations of each cell must be read and written once per step, and those of a bed
//! need its storage and drag, which are read. So the limit is the speed at which memory
//! as large is read and written in place by as many threads. Both are measured in turn, some
//! times over, and medians are printed: of each, and of the share that a turn reached.

use lbm::{Bed, Ends, Field, Fluid, Model, Real, Regime, Side, Solver, State};
use std::time::Instant;

/// Turns of limit and solver.
const TURNS: usize = 7;
/// Populations of a cell.
const POPULATIONS: usize = 19;

fn main() {
    let mut numbers = std::env::args().skip(1).map(|arg| {
        arg.parse()
            .unwrap_or_else(|_| panic!("{arg} is not a whole number"))
    });
    let side = numbers.next().unwrap_or(128);
    let threads = numbers.next().unwrap_or(2);
    println!("{side}^3 cells, {threads} threads, medians of {TURNS} turns");
    println!("law      number  MLUPS  B/cell   GB/s  in place GB/s  share");
    for bed in [false, true] {
        compare::<f32>(side, threads, bed, "f32");
        compare::<f64>(side, threads, bed, "f64");
    }
}

fn compare<T: Real>(n: usize, threads: usize, bed: bool, number: &str) {
    let fluid = Fluid::COLD_WATER;
    let model = Model {
        cells: [n, n, n],
        spacing: 1e-3,
        fluid,
        bed: bed.then_some(Bed {
            porosity: Field::Uniform(0.4),
            permeability: Field::Uniform(1e-13),
            forchheimer: None,
        }),
        ends: [
            Ends::Periodic,
            Ends::Periodic,
            Ends::Walls(Side::NoSlip([0.0; 3]), Side::NoSlip([0.0; 3])),
        ],
        solid: Vec::new(),
        acceleration: [0.0; 3],
        inertia: !bed,
        regime: bed.then_some(Regime::Diffusive),
        step: None,
        speed: 1e-3,
    };
    let state = State::at_rest(&model);
    let mut solver = Solver::<T>::new(model, state, threads).expect("the model is possible");
    let cells = n.pow(3) as f64;
    let steps = (1e8 / cells / size_of::<T>() as f64).ceil() as u64 * 2;

    let mut memory = vec![T::of(1.0); POPULATIONS * n.pow(3)];
    let factor = T::of(1.000_000_1);
    in_place(&mut memory, factor, threads);
    solver.advance(2).expect("it is stable");
    let (mut limits, mut speeds) = (Vec::new(), Vec::new());
    for _ in 0..TURNS {
        let start = Instant::now();
        for _ in 0..steps {
            in_place(&mut memory, factor, threads);
        }
        let bytes = 2.0 * steps as f64 * size_of_val(&memory[..]) as f64;
        limits.push(bytes / start.elapsed().as_secs_f64());
        let start = Instant::now();
        solver.advance(steps).expect("it is stable");
        speeds.push(cells * steps as f64 / start.elapsed().as_secs_f64());
    }
    let numbers = 2 * POPULATIONS + if bed { 2 } else { 0 };
    let bytes = (numbers * size_of::<T>()) as f64;
    let shares = speeds
        .iter()
        .zip(&limits)
        .map(|(s, limit)| s * bytes / limit);
    let share = median(shares.collect());
    let (limit, speed) = (median(limits), median(speeds));
    println!(
        "{:8} {number:7} {:5.0}  {:6.1}  {:5.1}  {:13.1}  {:5.2}",
        if bed { "porous" } else { "free" },
        speed / 1e6,
        solver.bytes_per_cell(),
        speed * bytes / 1e9,
        limit / 1e9,
        share
    );
}

/// Read and write all of `memory`, each thread its own part.
fn in_place<T: Real>(memory: &mut [T], factor: T, threads: usize) {
    let part = memory.len().div_ceil(threads);
    std::thread::scope(|scope| {
        for own in memory.chunks_mut(part) {
            scope.spawn(move || own.iter_mut().for_each(|x| *x = *x * factor));
        }
    });
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
