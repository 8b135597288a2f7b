//! `esker bench speed --backend gpu --wet N,...`: what water costs a bed of grains on a device.
//!
//! The bed is `poster`, sheared, dry and with water in cells of two and of one mean diameter, whose
//! fluid steps as accuracy asks for. Dry and wet steps take turns, round by round; then some steps
//! are timed on the device's own clock, kernel by kernel.

use super::case::{Bed, Case};
use super::kept::Kept;
use super::packing::Sizes;
use super::report::{Section, median_and_range};
use super::wet::water_of;
use anyhow::Result;
use coupling::gpu::Coupled;
use serde::Serialize;
use shaders::Device;
use std::time::Instant;

/// A wet bed in cells of one size.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WetRow {
    /// `wet-2d` or `wet-1d`, by the size of the cells in mean diameters.
    pub case: &'static str,
    /// `gpu`.
    pub backend: &'static str,
    /// The device.
    pub device: String,
    /// Is it hardware?
    pub hardware: bool,
    /// Number of grains.
    pub grains: usize,
    /// Number of cells.
    pub cells: usize,
    /// Grain steps from one exchange to the next.
    pub exchange: u64,
    /// Dispatches of a step in the mean, those of searches and renewals included.
    pub dispatches_per_step: f64,
    /// Grain steps from one fluid step to the next, and steps of the lattice in each.
    pub interval: u64,
    /// Steps of the lattice in each.
    pub sub_steps: u64,
    /// Time of a dry and of a coupled step (microseconds), median of the rounds.
    pub us_of_dry_step: f64,
    /// The same of a coupled step.
    pub us_of_coupled_step: f64,
    /// A coupled step over a dry one, median and extremes of the rounds.
    pub coupled_over_dry: f64,
    /// Least and greatest.
    pub coupled_over_dry_range: [f64; 2],
    /// By the device's own clock, where it has one.
    pub sections: Vec<Section>,
}

/// Steps that are timed section by section.
const TIMED: u64 = 256;
/// Measure a wet bed of so many grains, print its rows and keep them.
///
/// # Errors
/// A device that fails, a file that cannot be written.
pub fn speed(device: &Device, grains: usize, rounds: u32, kept: &mut Kept) -> Result<()> {
    let bed = Bed::of(Sizes::Poster, grains)?;
    let rows = [
        measure::<3>(device, &bed, rounds)?,
        measure::<5>(device, &bed, rounds)?,
    ];
    for row in &rows {
        print(row, rounds);
    }
    kept.add(&rows)
}

fn measure<const N: usize>(device: &Device, bed: &Bed, rounds: u32) -> Result<WetRow> {
    // One at a time on the device, so that memory suffices for both.
    let device = &Device::open_adapter((*device.adapter).clone())?;
    let hardware = device.adapter.is_hardware();
    let grains = bed.packing.len();
    let steps = match hardware {
        true => (1_000_000_000 / grains as u64).clamp(512, 2048),
        false => (150_000 / grains as u64).clamp(64, 128),
    };
    let (model, start) = Case::Poster.start(bed);
    let mut dry = dem::gpu::Solver::new(device, model.clone(), start.clone())?;
    let water = water_of::<N>(bed, 1e-12);
    let cells = water.cells.iter().product();
    let mut wet = Coupled::<N>::new(device, model, start, water, None)?;
    dry.advance(steps)?;
    wet.advance(steps)?;
    let mut samples = Vec::new();
    let mut dispatches_per_step = 0.0;
    for _ in 0..rounds {
        let clock = Instant::now();
        dry.advance(steps)?;
        let dry = clock.elapsed().as_secs_f64();
        let before = device.traffic().dispatches;
        let clock = Instant::now();
        wet.advance(steps)?;
        samples.push([dry, clock.elapsed().as_secs_f64()].map(|time| 1e6 * time / steps as f64));
        dispatches_per_step = (device.traffic().dispatches - before) as f64 / steps as f64;
    }
    let report = wet.read()?.1;
    let sections = wet.time_steps(TIMED)?.unwrap_or_default();
    let of = |value: fn(&[f64; 2]) -> f64| median_and_range(samples.iter().map(value));
    let (coupled_over_dry, coupled_over_dry_range) = of(|[dry, wet]| wet / dry);
    Ok(WetRow {
        case: if N == 3 { "wet-2d" } else { "wet-1d" },
        backend: "gpu",
        device: device.adapter.describe(),
        hardware,
        grains,
        cells,
        exchange: report.exchange,
        dispatches_per_step,
        interval: report.interval,
        sub_steps: report.sub_steps,
        us_of_dry_step: of(|[dry, _]| *dry).0,
        us_of_coupled_step: of(|[_, wet]| *wet).0,
        coupled_over_dry,
        coupled_over_dry_range,
        sections: sections
            .into_iter()
            .map(|(name, seconds)| Section {
                name,
                us_per_step: 1e6 * seconds / TIMED as f64,
            })
            .collect(),
    })
}

fn print(row: &WetRow, rounds: u32) {
    let [least, most] = row.coupled_over_dry_range;
    println!(
        "{} wet grains, {}, {} cells, exchange every {} steps, fluid every {} in {}, rounds: {rounds}, {}",
        row.grains, row.case, row.cells, row.exchange, row.interval, row.sub_steps, row.device
    );
    println!(
        "  dry step {:.1} us, coupled {:.1} us, {:.2} times as long ({least:.2}..{most:.2}), {:.1} dispatches",
        row.us_of_dry_step, row.us_of_coupled_step, row.coupled_over_dry, row.dispatches_per_step
    );
    for section in &row.sections {
        println!(
            "  {:<10} {:>8.1} us a step",
            section.name, section.us_per_step
        );
    }
}
