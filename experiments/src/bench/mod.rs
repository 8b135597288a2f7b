//! `esker bench speed`: how many grain-steps a second on a dense sheared bed, how many cells of
//! water, and what water costs a bed.
//!
//! Every round takes each case once, so that a machine whose clock wanders is fair to all of
//! them; medians and extremes over the rounds are reported.

mod case;
mod floor;
mod fluid;
mod gpu;
mod kept;
mod lammps;
mod numbers;
mod packing;
mod report;
mod wet;
mod wet_gpu;

use crate::backend::{Backend, Machine, processor};
use anyhow::{Result, bail, ensure};
use case::{Bed, Case};
use floor::Floor;
use kept::Kept;
use lammps::Lammps;
use packing::Sizes;
use report::{Row, Sample};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What `esker bench speed` measures.
#[derive(Clone, Debug, clap::Args)]
pub struct SpeedArgs {
    /// Who computes; auto: graphics hardware, or else the CPU
    #[arg(long, value_enum, default_value_t)]
    pub backend: Backend,
    /// Numbers of grains, multiples of 1000 [default: 1000 to 100 000, to 10 000 000 on a GPU]
    #[arg(long, value_delimiter = ',', value_name = "N")]
    pub grains: Vec<usize>,
    /// Cells along each side of lattices of water, instead of grains or, with --grains, beside them
    #[arg(long, value_delimiter = ',', value_name = "N")]
    pub fluid: Vec<usize>,
    /// Numbers of grains of beds with water, multiples of 1000: dry step, prediction and fluid step
    /// apart; instead of dry beds or, with --grains, beside them
    #[arg(long, value_delimiter = ',', value_name = "N")]
    pub wet: Vec<usize>,
    /// Numbers of threads of the CPU (and of LAMMPS' ranks) [default: one for each core]
    #[arg(long, value_delimiter = ',', value_name = "N")]
    pub threads: Vec<usize>,
    /// Rounds; each takes every case once
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pub rounds: u32,
    /// Write the results as a JSON array, one object a case; whole at any time, and more after each
    /// number of grains
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// On a GPU: after so long no further round begins but the first of a case, and no further case
    #[arg(long, default_value_t = 8.0, value_name = "MINUTES")]
    pub minutes: f64,
    /// Run the same packing in LAMMPS too (needs `lmp`, and `mpirun` for several ranks)
    #[arg(long)]
    pub with_lammps: bool,
}

/// Measure, print a table, and write the JSON file if one is asked for.
///
/// # Errors
/// Counts that are no multiple of 1000, a LAMMPS that is asked for and cannot be run, a bed
/// whose coordination number falls below 4 (no longer dense, so no measure of one), and
/// files that cannot be written.
pub fn speed(args: &SpeedArgs) -> Result<()> {
    for &grains in args.grains.iter().chain(&args.wet) {
        packing::check_count(grains)?;
    }
    // Beds of all sizes are measured, also those that are too small for a GPU to pay.
    let machine = args.backend.choose(usize::MAX, 0)?.machine;
    let mut kept = Kept::new(args.json.clone());
    let others = !args.fluid.is_empty() || !args.wet.is_empty();
    let rows = match (&machine, !others || !args.grains.is_empty()) {
        (_, false) => Vec::new(),
        (Machine::Cpu { .. }, true) => on_cpu(args, &mut kept)?,
        (Machine::Gpu(device), true) => on_gpu(device, args, &mut kept)?,
    };
    fluid::speed(
        &machine,
        &args.fluid,
        &threads(args)?,
        args.rounds,
        &mut kept,
    )?;
    for &grains in &args.wet {
        packing::check_count(grains)?;
        match &machine {
            Machine::Cpu { .. } => wet::speed(grains, &threads(args)?, args.rounds, &mut kept)?,
            Machine::Gpu(device) => wet_gpu::speed(device, grains, args.rounds, &mut kept)?,
        }
    }
    // Where sizes differ much, many small grains float in the holes between large ones.
    let dense = |row: &Row| row.case != Case::LogNormal.name();
    ensure!(
        rows.iter().filter(|row| dense(row)).all(|row| row
            .coordination_number
            .is_none_or(|contacts| contacts >= 4.0)),
        "a bed fell below 4 contacts a grain: these are not the speeds of a dense bed"
    );
    Ok(())
}

/// Numbers of threads that are asked for, or one for each core.
fn threads(args: &SpeedArgs) -> Result<Vec<usize>> {
    ensure!(
        args.threads.iter().all(|&t| t > 0),
        "--threads: give 1 or more threads"
    );
    Ok(match args.threads.is_empty() {
        true => vec![std::thread::available_parallelism()?.get()],
        false => args.threads.clone(),
    })
}

fn on_cpu(args: &SpeedArgs, kept: &mut Kept) -> Result<Vec<Row>> {
    let threads = threads(args)?;
    if args.with_lammps {
        lammps::check_installed(threads.iter().any(|&t| t > 1))?;
    }
    let mut rows = Vec::new();
    for grains in or(&args.grains, || vec![1000, 10_000, 100_000]) {
        let beds = Sizes::ALL.map(|sizes| Bed::of(sizes, grains));
        let beds = beds.into_iter().collect::<Result<Vec<_>>>()?;
        for &threads in &threads {
            let new = measure(&beds, threads, args)?;
            report::print(&new, args.rounds);
            kept.add(&new)?;
            rows.extend(new);
        }
    }
    Ok(rows)
}

fn on_gpu(device: &shaders::Device, args: &SpeedArgs, kept: &mut Kept) -> Result<Vec<Row>> {
    if args.with_lammps {
        bail!("--with-lammps compares with the CPU; add --backend cpu");
    }
    if !device.adapter.is_hardware() {
        println!(
            "NO GRAPHICS HARDWARE HERE: {} is software. What follows shows that it works, not how \
             fast a GPU is; a device is missing.",
            device.adapter.describe()
        );
    }
    let floor = Floor::measure(device)?;
    let mut rows = Vec::new();
    let ends = Instant::now() + Duration::from_secs_f64(60.0 * args.minutes);
    for grains in or(&args.grains, || gpu::sizes(device)) {
        let new = gpu::measure(device, &floor, grains, args.rounds, ends)?;
        report::print(&new, args.rounds);
        kept.add(&new)?;
        rows.extend(new);
    }
    Ok(rows)
}

/// What was asked for, or else the `default`.
fn or(asked: &[usize], default: impl FnOnce() -> Vec<usize>) -> Vec<usize> {
    match asked.is_empty() {
        true => default(),
        false => asked.to_vec(),
    }
}

/// All cases at one number of grains and of threads, alternating; one bed for each of
/// [`Sizes::ALL`].
fn measure(beds: &[Bed], threads: usize, args: &SpeedArgs) -> Result<Vec<Row>> {
    let bed = |case: Case| &beds[case.sizes() as usize];
    let poster_bed = bed(Case::Poster);
    let length = Length::of(poster_bed.packing.len(), threads);
    let lammps = if args.with_lammps {
        Lammps::all(poster_bed, threads, length)?
    } else {
        Vec::new()
    };
    let mut own = Case::ALL.map(|case| (case, Vec::new()));
    let mut peers: Vec<_> = lammps.iter().map(|peer| (peer, Vec::new())).collect();
    for _ in 0..args.rounds {
        for (case, samples) in &mut own {
            samples.push(case.run(bed(*case), threads, length)?);
        }
        for (peer, samples) in &mut peers {
            samples.push(peer.run(length)?);
        }
    }

    let device = processor();
    let samples = |case: Case| &own[case as usize].1;
    let one_size = samples(Case::OneSize);
    let own_rows = own.iter().map(|(case, samples)| Row {
        one_size_ratio: (*case == Case::LogNormal)
            .then(|| report::ratio(samples, one_size, Sample::contacts_per_s)),
        ..Row::new(
            case.name(),
            "cpu",
            &device,
            &bed(*case).packing,
            Some(threads),
            samples,
        )
    });
    let poster = samples(Case::Poster);
    let peer_rows = peers.iter().map(|(peer, samples)| Row {
        poster_ratio: Some(report::ratio(poster, samples, |s| s.grain_steps_per_s)),
        ..Row::new(
            &peer.name(),
            "lammps",
            &device,
            &poster_bed.packing,
            Some(threads),
            samples,
        )
    });
    Ok(own_rows.chain(peer_rows).collect())
}

/// How long one measurement is.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Length {
    /// Steps before the clock starts: caches and neighbour lists settle.
    warm_up: u64,
    /// Steps on the clock.
    steps: u64,
}

impl Length {
    /// About 6 million grain-steps a thread, and 100 steps at least. Held planes let the
    /// pressure of a sheared bed rise, so small beds must not run for long: 6000 steps of
    /// 1000 grains are a strain of 0.001, and the bed stays at 4.1 contacts a grain.
    fn of(grains: usize, threads: usize) -> Self {
        Self {
            warm_up: (3_000_000 / grains as u64).clamp(30, 300),
            steps: (6_000_000 * threads as u64 / grains as u64).max(100),
        }
    }
}
