//! `esker bench speed --wet N,...`: what water costs a bed of grains, part by part.
//!
//! The bed is `poster`, sheared dry, and with water in cells of two and of one mean diameter.
//! Nothing is timed inside of a step: dry steps, and four kinds of wet ones, take turns, round by round.
//! With an exchange in every step and no fluid step, and with both in every step: what they
//! add is what an exchange costs (ways to faces, pressure, its push on the grains, renewals
//! of the weights), and a fluid step. And with exchanges and fluid steps as
//! accuracy asks for: in a bed that keeps its pressure for a while, and in one that drains at once.

use super::Length;
use super::case::{Bed, Case};
use super::kept::Kept;
use super::packing::Sizes;
use super::report::median_and_range;
use crate::backend::processor;
use anyhow::Result;
use coupling::{Coupled, Model, Permeability, Resistance};
use lbm::{Fluid, Side, Signal};
use serde::Serialize;
use std::time::Instant;

/// A wet bed in cells of one size.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WetRow {
    /// `wet-2d` or `wet-1d`, by the size of the cells in mean diameters.
    pub case: &'static str,
    /// `cpu`.
    pub backend: &'static str,
    /// The machine.
    pub device: String,
    /// Number of threads.
    pub threads: usize,
    /// Number of grains.
    pub grains: usize,
    /// Number of cells.
    pub cells: usize,
    /// Time of a dry step (microseconds), median of the rounds.
    pub us_of_dry_step: f64,
    /// What an exchange adds to it.
    pub us_of_exchange: f64,
    /// What a fluid step adds to it, of one step of the lattice.
    pub us_of_fluid_step: f64,
    /// A bed of 1e-12 m², with steps as accuracy asks for.
    pub coupled: Chosen,
    /// One of 1e-10 m².
    pub drained: Chosen,
}

/// Steps as accuracy asks for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chosen {
    /// Grain steps from one exchange to the next.
    pub exchange: u64,
    /// Grain steps from one fluid step to the next.
    pub interval: u64,
    /// Steps of the lattice in each.
    pub sub_steps: u64,
    /// A grain step over a dry one, median of the rounds.
    pub over_dry: f64,
    /// Least and greatest.
    pub over_dry_range: [f64; 2],
}

/// Measure a wet bed of `grains` grains on the CPU, print the rows and keep them.
///
/// # Errors
/// A file that cannot be written.
pub fn speed(grains: usize, threads: &[usize], rounds: u32, kept: &mut Kept) -> Result<()> {
    let bed = Bed::of(Sizes::Poster, grains)?;
    let mut rows = Vec::new();
    print_head(grains, rounds);
    for &threads in threads {
        for row in [
            on_cpu::<3>(&bed, threads, rounds)?,
            on_cpu::<5>(&bed, threads, rounds)?,
        ] {
            print(&row);
            rows.push(row);
        }
    }
    kept.add(&rows)
}

/// Cells of two mean diameters along a unit of the packing, and upwards.
const CELLS: [usize; 2] = [5, 4];
const UNIT_SIDE: f64 = 0.2;

/// Steps with water.
#[derive(Clone, Copy)]
enum Kind {
    /// An exchange in each, and no fluid step.
    Exchange,
    /// Both in each.
    FluidStep,
    /// As accuracy asks for.
    Coupled,
    /// The same where water drains within a few grain steps.
    Drained,
}

/// Water in the bed, drained at the top, with steps as accuracy asks for.
pub(super) fn water_of<const N: usize>(bed: &Bed, permeability: f64) -> Model {
    let finer = N / 2;
    let [across, up] = CELLS.map(|cells| cells * finer);
    let [nx, ny] = bed
        .packing
        .size
        .map(|side| (side / UNIT_SIDE).round() as usize * across);
    let law = Resistance::Darcy(Permeability::constant(permeability));
    Model {
        sides: [Side::FreeSlip, Side::Pressure(Signal::Steady(0.0))],
        ..Model::new([nx, ny, up], Fluid::COLD_WATER, law)
    }
}

fn water<const N: usize>(bed: &Bed, kind: Kind) -> Model {
    let (permeability, exchange, interval) = match kind {
        Kind::Exchange => (1e-18, Some(1), Some(1 << 20)),
        Kind::FluidStep => (1e-12, Some(1), Some(1)),
        Kind::Coupled => (1e-12, None, None),
        Kind::Drained => (1e-10, None, None),
    };
    Model {
        exchange,
        interval,
        ..water_of::<N>(bed, permeability)
    }
}

/// Seconds of a step in one round: dry, and of each kind.
struct Sample {
    dry: f64,
    wet: [f64; 4],
}

fn on_cpu<const N: usize>(bed: &Bed, threads: usize, rounds: u32) -> Result<WetRow> {
    const KINDS: [Kind; 4] = [
        Kind::Exchange,
        Kind::FluidStep,
        Kind::Coupled,
        Kind::Drained,
    ];
    let length = Length::of(bed.packing.len(), threads);
    let grains = bed.packing.len();
    let mut reports = Vec::new();
    let mut samples = Vec::new();
    for _ in 0..rounds {
        let dry = Case::Poster.run(bed, threads, length)?;
        let mut sample = Sample {
            dry: grains as f64 / dry.grain_steps_per_s,
            wet: [0.0; 4],
        };
        reports.clear();
        for (kind, time) in KINDS.into_iter().zip(&mut sample.wet) {
            let (model, start) = Case::Poster.start(bed);
            let mut wet = Coupled::<N>::new(model, start, water::<N>(bed, kind), None, threads)?;
            wet.advance(length.warm_up)?;
            let clock = Instant::now();
            wet.advance(length.steps)?;
            *time = clock.elapsed().as_secs_f64() / length.steps as f64;
            reports.push(wet.report());
        }
        samples.push(sample);
    }
    let of = |value: &dyn Fn(&Sample) -> f64| median_and_range(samples.iter().map(value));
    let chosen = |kind: usize| {
        let (over_dry, over_dry_range) = of(&|s| s.wet[kind] / s.dry);
        Chosen {
            exchange: reports[kind].exchange,
            interval: reports[kind].interval,
            sub_steps: reports[kind].sub_steps,
            over_dry,
            over_dry_range,
        }
    };
    Ok(WetRow {
        case: if N == 3 { "wet-2d" } else { "wet-1d" },
        backend: "cpu",
        device: processor(),
        threads,
        grains,
        cells: water::<N>(bed, Kind::Coupled).cells.iter().product(),
        us_of_dry_step: 1e6 * of(&|s| s.dry).0,
        us_of_exchange: 1e6 * of(&|s| s.wet[0] - s.dry).0,
        us_of_fluid_step: 1e6 * of(&|s| s.wet[1] - s.wet[0]).0,
        coupled: chosen(2),
        drained: chosen(3),
    })
}

fn print_head(grains: usize, rounds: u32) {
    println!("{grains} wet grains, rounds: {rounds}, {}", processor());
    println!(
        "  {:<7} {:>7} {:>7} {:>10} {:>10} {:>10}   a step over a dry one, exchange and fluid every",
        "case", "threads", "cells", "us dry", "exchange", "fluid step",
    );
}

fn print(row: &WetRow) {
    print!(
        "  {:<7} {:>7} {:>7} {:>10.1} {:>10.1} {:>10.1}",
        row.case,
        row.threads,
        row.cells,
        row.us_of_dry_step,
        row.us_of_exchange,
        row.us_of_fluid_step,
    );
    for (name, chosen) in [("coupled", &row.coupled), ("drained", &row.drained)] {
        let [least, most] = chosen.over_dry_range;
        print!(
            "   {name} {:.2} ({least:.2}..{most:.2}), {} {} in {}",
            chosen.over_dry, chosen.exchange, chosen.interval, chosen.sub_steps
        );
    }
    println!();
}
