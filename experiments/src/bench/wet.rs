//! `esker bench speed --wet N,...`: what water costs a bed of grains, part by part.
//!
//! The bed is `poster`, sheared dry, and with water in cells of two and of one mean diameter.
//! Nothing is timed inside of a step: dry steps, wet ones whose fluid never steps, and wet ones
//! with a fluid step in each take turns, round by round, and the parts are the differences. So the
//! prediction is all that water costs in every step (velocities to faces, pressure, its push on the
//! grains, renewals of the weights), and the fluid step all that its step adds.

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
    /// What the prediction adds to it, in every step.
    pub us_of_prediction: f64,
    /// What a fluid step adds to it, of one step of the lattice.
    pub us_of_fluid_step: f64,
    /// A step with prediction over a dry one, median and extremes of the rounds.
    pub predicted_over_dry: f64,
    /// Least and greatest.
    pub predicted_over_dry_range: [f64; 2],
    /// A step with prediction and fluid step over a dry one.
    pub coupled_over_dry: f64,
    /// Least and greatest.
    pub coupled_over_dry_range: [f64; 2],
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

/// Water in the bed, drained at the top: so tight that the fluid need never step, or with a step
/// in each of the grains'.
fn water<const N: usize>(bed: &Bed, fluid_steps: bool) -> Model {
    let finer = N / 2;
    let [across, up] = CELLS.map(|cells| cells * finer);
    let [nx, ny] = bed
        .packing
        .size
        .map(|side| (side / UNIT_SIDE).round() as usize * across);
    let (permeability, interval) = match fluid_steps {
        true => (1e-12, 1),
        false => (1e-18, 1 << 20),
    };
    let law = Resistance::Darcy(Permeability::constant(permeability));
    Model {
        sides: [Side::FreeSlip, Side::Pressure(Signal::Steady(0.0))],
        interval: Some(interval),
        ..Model::new([nx, ny, up], Fluid::COLD_WATER, law)
    }
}

/// Seconds of a step in one round.
struct Sample {
    dry: f64,
    predicted: f64,
    coupled: f64,
}

fn on_cpu<const N: usize>(bed: &Bed, threads: usize, rounds: u32) -> Result<WetRow> {
    let length = Length::of(bed.packing.len(), threads);
    let wet = |fluid_steps| -> Result<f64> {
        let (model, start) = Case::Poster.start(bed);
        let water = water::<N>(bed, fluid_steps);
        let mut wet = Coupled::<N>::new(model, start, water, None, threads)?;
        wet.advance(length.warm_up)?;
        let clock = Instant::now();
        wet.advance(length.steps)?;
        Ok(clock.elapsed().as_secs_f64() / length.steps as f64)
    };
    let grains = bed.packing.len();
    let mut samples = Vec::new();
    for _ in 0..rounds {
        let dry = Case::Poster.run(bed, threads, length)?;
        samples.push(Sample {
            dry: grains as f64 / dry.grain_steps_per_s,
            predicted: wet(false)?,
            coupled: wet(true)?,
        });
    }
    let of = |value: fn(&Sample) -> f64| median_and_range(samples.iter().map(value));
    let (predicted_over_dry, predicted_over_dry_range) = of(|s| s.predicted / s.dry);
    let (coupled_over_dry, coupled_over_dry_range) = of(|s| s.coupled / s.dry);
    Ok(WetRow {
        case: if N == 3 { "wet-2d" } else { "wet-1d" },
        backend: "cpu",
        device: processor(),
        threads,
        grains,
        cells: water::<N>(bed, true).cells.iter().product(),
        us_of_dry_step: 1e6 * of(|s| s.dry).0,
        us_of_prediction: 1e6 * of(|s| s.predicted - s.dry).0,
        us_of_fluid_step: 1e6 * of(|s| s.coupled - s.predicted).0,
        predicted_over_dry,
        predicted_over_dry_range,
        coupled_over_dry,
        coupled_over_dry_range,
    })
}

fn print_head(grains: usize, rounds: u32) {
    println!("{grains} wet grains, rounds: {rounds}, {}", processor());
    println!(
        "  {:<7} {:>7} {:>7} {:>10} {:>10} {:>10} {:>14} {:>12} {:>14} {:>12}",
        "case",
        "threads",
        "cells",
        "us dry",
        "prediction",
        "fluid step",
        "predicted/dry",
        "of rounds",
        "coupled/dry",
        "of rounds"
    );
}

fn print(row: &WetRow) {
    let range = |[least, most]: [f64; 2]| format!("{least:.2}..{most:.2}");
    println!(
        "  {:<7} {:>7} {:>7} {:>10.1} {:>10.1} {:>10.1} {:>14.2} {:>12} {:>14.2} {:>12}",
        row.case,
        row.threads,
        row.cells,
        row.us_of_dry_step,
        row.us_of_prediction,
        row.us_of_fluid_step,
        row.predicted_over_dry,
        range(row.predicted_over_dry_range),
        row.coupled_over_dry,
        range(row.coupled_over_dry_range)
    );
}
