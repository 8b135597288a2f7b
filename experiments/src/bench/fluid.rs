//! `esker bench speed --fluid N,...`: how many cells of water a second, and how many there could
//! be.
//!
//! A step must read and write the populations of each cell once, and read what the law knows of a
//! bed. So the limit is the speed of the memory: on a CPU that at which as much memory is read and
//! written in place by as many threads, on a GPU that of a copy. Limit and solver are measured in
//! turn, round by round, so that a wandering clock is fair to both.

use super::floor::Floor;
use super::kept::Kept;
use super::report::median_and_range;
use crate::backend::{Machine, processor};
use anyhow::{Result, ensure};
use lbm::{Bed, Ends, Error, Field, Fluid, Model, Real, Regime, Side, Solver, State, gpu};
use serde::Serialize;
use shaders::Device;
use std::time::Instant;

/// Populations of a cell.
const POPULATIONS: usize = 19;
/// Smallest and largest side of a lattice: below, nothing can be timed.
const SIDES: [usize; 2] = [8, 1024];

/// One lattice in one law and one kind of number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FluidRow {
    /// `fluid-free` (with inertia) or `fluid-porous` (Darcy's drag).
    pub case: &'static str,
    /// `cpu` or `gpu`.
    pub backend: &'static str,
    /// The machine.
    pub device: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// Number of threads of the CPU.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threads: Option<usize>,
    /// Number of cells.
    pub cells: usize,
    /// Millions of cells a second, median of the rounds.
    pub mlups: f64,
    /// Slowest and fastest round.
    pub mlups_range: [f64; 2],
    /// Memory over cells: of the populations on a CPU, of all arrays on a GPU.
    pub bytes_per_cell: f64,
    /// Bytes that a step must read and write for each cell.
    pub moved_bytes_per_cell: f64,
    /// Those bytes a second, median.
    pub gb_per_s: f64,
    /// The limit: reading and writing in place on a CPU, copying on a GPU, median.
    pub limit_gb_per_s: f64,
    /// Part of the limit of its own round that a round reached: median.
    pub share: f64,
    /// Least and greatest part.
    pub share_range: [f64; 2],
}

/// Measure lattices of `sides` cells each way on `machine`, print the rows and keep them.
///
/// # Errors
/// Sides that are too small or too large, a machine that fails, a file that cannot be written.
pub fn speed(
    machine: &Machine,
    sides: &[usize],
    threads: &[usize],
    rounds: u32,
    kept: &mut Kept,
) -> Result<()> {
    let [least, most] = SIDES;
    let fine = sides.iter().all(|side| (least..=most).contains(side));
    ensure!(fine, "--fluid: give sides from {least} to {most} cells");
    for &side in sides {
        let mut rows = Vec::new();
        print_head(side, rounds, &machine.describe());
        let mut add = |row: FluidRow| {
            print(&row);
            rows.push(row);
        };
        match machine {
            Machine::Cpu { .. } => {
                for &threads in threads {
                    for porous in [false, true] {
                        add(on_cpu::<f32>(side, porous, threads, rounds, "f32")?);
                        add(on_cpu::<f64>(side, porous, threads, rounds, "f64")?);
                    }
                }
            }
            Machine::Gpu(device) => {
                for porous in [false, true] {
                    on_gpu(device, side, porous, rounds)?.map(&mut add);
                }
            }
        }
        kept.add(&rows)?;
    }
    Ok(())
}

/// Water between two plates, free or in a bed.
fn model(side: usize, porous: bool) -> Model {
    Model {
        cells: [side; 3],
        spacing: 1e-3,
        fluid: Fluid::COLD_WATER,
        bed: porous.then_some(Bed {
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
        inertia: !porous,
        regime: porous.then_some(Regime::Diffusive),
        step: None,
        speed: 1e-3,
    }
}

/// What was found in one round.
struct Sample {
    mlups: f64,
    /// [bytes/s]
    limit: f64,
}

fn row(
    samples: &[Sample],
    model: &Model,
    (precision, moved, held): (&'static str, f64, f64),
) -> FluidRow {
    let (mlups, mlups_range) = median_and_range(samples.iter().map(|s| s.mlups));
    let (limit, _) = median_and_range(samples.iter().map(|s| s.limit));
    let shares = samples.iter().map(|s| s.mlups * 1e6 * moved / s.limit);
    let (share, share_range) = median_and_range(shares);
    FluidRow {
        case: match model.bed {
            Some(_) => "fluid-porous",
            None => "fluid-free",
        },
        backend: "cpu",
        device: processor(),
        precision,
        threads: None,
        cells: model.cells.iter().product(),
        mlups,
        mlups_range,
        bytes_per_cell: held,
        moved_bytes_per_cell: moved,
        gb_per_s: mlups * moved / 1e3,
        limit_gb_per_s: limit / 1e9,
        share,
        share_range,
    }
}

fn on_cpu<T: Real>(
    side: usize,
    porous: bool,
    threads: usize,
    rounds: u32,
    precision: &'static str,
) -> Result<FluidRow> {
    let model = model(side, porous);
    let cells = side.pow(3);
    let mut solver = Solver::<T>::new(model.clone(), State::at_rest(&model), threads)?;
    // About 0.2 s a round at the speed of memory.
    let steps = (2e8 / (cells * size_of::<T>()) as f64).ceil() as u64;
    let mut memory = vec![T::of(1.0); POPULATIONS * cells];
    let factor = T::of(1.000_000_1);
    in_place(&mut memory, factor, threads);
    solver.advance(2)?;
    let mut samples = Vec::new();
    for _ in 0..rounds {
        let clock = Instant::now();
        for _ in 0..steps {
            in_place(&mut memory, factor, threads);
        }
        let bytes = 2.0 * steps as f64 * size_of_val(&memory[..]) as f64;
        let limit = bytes / clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        solver.advance(steps)?;
        let seconds = clock.elapsed().as_secs_f64();
        let mlups = cells as f64 * steps as f64 / seconds / 1e6;
        samples.push(Sample { mlups, limit });
    }
    let of_bed = if porous { 2 } else { 0 };
    let moved = ((2 * POPULATIONS + of_bed) * size_of::<T>()) as f64;
    Ok(FluidRow {
        threads: Some(threads),
        ..row(
            &samples,
            &model,
            (precision, moved, solver.bytes_per_cell()),
        )
    })
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

/// One row, or none where the lattice does not fit.
fn on_gpu(device: &Device, side: usize, porous: bool, rounds: u32) -> Result<Option<FluidRow>> {
    let model = model(side, porous);
    let cells = side.pow(3);
    let state = State::at_rest(&model);
    let mut solver = match gpu::Solver::new(device, model.clone(), state) {
        Ok(solver) => solver,
        Err(Error::Device(error @ shaders::Error::Memory(_))) => {
            println!("{side}^3 cells: too little memory: {error}");
            return Ok(None);
        }
        Err(error) => return Err(error.into()),
    };
    // Software is there to see that it works.
    let steps = match device.adapter.is_hardware() {
        true => (4e9 / cells as f64).clamp(20.0, 2000.0) as u64,
        false => (1e6 / cells as f64).clamp(2.0, 200.0) as u64,
    };
    solver.advance(steps)?;
    let mut samples = Vec::new();
    for _ in 0..rounds {
        let limit = Floor::measure(device)?.bandwidth;
        let clock = Instant::now();
        solver.advance(steps)?;
        let seconds = clock.elapsed().as_secs_f64();
        let mlups = cells as f64 * steps as f64 / seconds / 1e6;
        samples.push(Sample { mlups, limit });
    }
    let moved = gpu::memory::moved_by_a_step(&model);
    let held = solver.memory() as f64 / cells as f64;
    Ok(Some(FluidRow {
        backend: "gpu",
        device: device.adapter.describe(),
        ..row(&samples, &model, ("f32", moved, held))
    }))
}

fn print_head(side: usize, rounds: u32, device: &str) {
    println!("{side}^3 cells of water, rounds: {rounds}, {device}");
    println!(
        "  {:<14} {:>6} {:>7} {:>8} {:>17} {:>10} {:>8} {:>10} {:>6} {:>12}",
        "case",
        "number",
        "threads",
        "MLUPS",
        "slowest..fastest",
        "bytes/cell",
        "GB/s",
        "limit GB/s",
        "share",
        "of rounds"
    );
}

fn print(row: &FluidRow) {
    let [low, high] = row.mlups_range;
    let [least, most] = row.share_range;
    println!(
        "  {:<14} {:>6} {:>7} {:>8.1} {:>17} {:>10.0} {:>8.1} {:>10.1} {:>6.2} {:>12}",
        row.case,
        row.precision,
        row.threads.map_or_else(|| "-".into(), |n| n.to_string()),
        row.mlups,
        format!("{low:.1}..{high:.1}"),
        row.bytes_per_cell,
        row.gb_per_s,
        row.limit_gb_per_s,
        row.share,
        format!("{least:.2}..{most:.2}")
    );
}
