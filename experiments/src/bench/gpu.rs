//! The cases on a GPU: speed, where its time goes, and how near it is to what the device allows.
//!
//! One solver a case goes through all rounds, a stretch of steps each: a large bed takes longer
//! to hand over than to measure.

use super::case::{Bed, Case};
use super::floor::Floor;
use super::packing::Sizes;
use super::report::{OnGpu, Row, Sample, Section};
use anyhow::Result;
use dem::gpu::memory::moved_by_a_step;
use dem::{Error, gpu};
use shaders::Device;
use std::time::Instant;

/// Beds up to here are measured in all cases, and their contacts counted; larger ones in the
/// first case alone, since reading takes more memory and time than stepping.
const ALL_CASES: usize = 1_000_000;
/// Steps that are timed section by section.
const TIMED: u64 = 256;

/// Numbers of grains where none are asked for.
pub fn sizes(device: &Device) -> Vec<usize> {
    match device.adapter.is_hardware() {
        true => vec![1000, 10_000, 100_000, 1_000_000, 10_000_000],
        false => vec![1000, 10_000],
    }
}

/// Measure all cases at `grains` grains in `rounds` rounds, fewer where time `ends`. A case that does
/// not fit, or comes too late, is told and left out.
///
/// # Errors
/// A device that fails.
pub fn measure(
    device: &Device,
    floor: &Floor,
    grains: usize,
    rounds: u32,
    ends: Instant,
) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for sizes in Sizes::ALL {
        let cases = Case::ALL.into_iter().filter(|case| case.sizes() == sizes);
        let all = grains <= ALL_CASES;
        let cases: Vec<Case> = cases.filter(|case| all || *case == Case::Poster).collect();
        if cases.is_empty() {
            continue;
        }
        if Instant::now() >= ends {
            let names: Vec<&str> = cases.iter().map(|case| case.name()).collect();
            println!(
                "{grains} grains, {}: left out, time is up; --minutes gives more",
                names.join(", ")
            );
            continue;
        }
        let bed = Bed::of(sizes, grains)?;
        for case in cases {
            // A device of its own: one that ran out of memory would refuse the next case, too.
            let device = &Device::open_adapter((*device.adapter).clone())?;
            match row(device, floor, case, &bed, rounds, ends) {
                Ok(row) => rows.push(row),
                Err(Error::Device(error @ shaders::Error::Memory(_))) => {
                    println!(
                        "{grains} grains, {}: too little memory: {error}",
                        case.name()
                    );
                }
                Err(error) => return Err(error.into()),
            }
        }
    }
    Ok(rows)
}

fn row(
    device: &Device,
    floor: &Floor,
    case: Case,
    bed: &Bed,
    rounds: u32,
    ends: Instant,
) -> Result<Row, Error> {
    let (model, start) = case.start(bed);
    let mut solver = gpu::Solver::new(device, model, start)?;
    let steps = stretch(device, bed.packing.len());
    // The skin adapts, and the first stretch compiles.
    solver.advance(steps)?;
    let (grains, searched) = (bed.packing.len() as f64, solver.searches());
    let mut samples = Vec::new();
    for round in 0..rounds {
        if round > 0 && Instant::now() >= ends {
            let (n, name) = (bed.packing.len(), case.name());
            println!("{n} grains, {name}: time is up after {round} of {rounds} rounds");
            break;
        }
        let clock = Instant::now();
        solver.advance(steps)?;
        samples.push(Sample {
            grain_steps_per_s: grains * steps as f64 / clock.elapsed().as_secs_f64(),
            coordination_number: None,
            bytes_per_grain: solver.memory() as f64 / grains,
        });
    }
    let searches = solver.searches() - searched;
    let timing = solver.time(TIMED)?;
    if bed.packing.len() <= ALL_CASES {
        let contacts = super::case::coordination_number(&solver.snapshot()?.state);
        for sample in &mut samples {
            sample.coordination_number = Some(contacts);
        }
    }
    let entries = 2.0 * solver.near_pairs() as f64 / grains;
    // As in a dense bed, where nobody counted.
    let touching = samples[0].coordination_number.unwrap_or(4.0);
    let moved = moved_by_a_step(solver.model(), entries, touching);
    let sections = timing.map_or_else(Vec::new, |timing| {
        let each = timing.sections.into_iter();
        each.map(|(name, seconds)| Section {
            name,
            us_per_step: 1e6 * seconds / timing.steps as f64,
        })
        .collect()
    });
    let on_gpu = OnGpu {
        hardware: device.adapter.is_hardware(),
        threads_per_grain: solver.lanes(),
        near_per_grain: entries,
        searches_per_1000_steps: 1e3 * searches as f64 / (steps * samples.len() as u64) as f64,
        sections,
        moved_bytes_per_grain_step: moved,
        us_of_empty_dispatch: 1e6 * floor.dispatch,
        us_of_moved_bytes: 1e6 * moved * grains / floor.bandwidth,
        bytes_per_s_of_copy: floor.bandwidth,
    };
    let device = device.adapter.describe();
    Ok(Row {
        on_gpu: Some(on_gpu),
        ..Row::new(case.name(), "gpu", &device, &bed.packing, None, &samples)
    })
}

/// Steps of a round. On hardware thousands, so that searches have their share; software is there
/// to see that it works.
fn stretch(device: &Device, grains: usize) -> u64 {
    let grains = grains as u64;
    match device.adapter.is_hardware() {
        true => (2_000_000_000 / grains).clamp(1024, 2048),
        false => (300_000 / grains).clamp(64, 256),
    }
}
