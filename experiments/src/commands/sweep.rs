//! `esker sweep`

use super::SceneArgs;
use super::run::{INTERRUPTED, on_interrupt};
use crate::backend::Backend;
use crate::sweep::{Design, Ended, FILE, Folder, Outcome, POINTS, Plan, Workers};
use crate::sweep::{collect, commands, on_gpu, run, slurm, work};
use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// Arguments of `esker sweep`.
#[derive(Clone, Debug, Args)]
pub struct Sweep {
    /// Scene file, folder with a scene.toml, or name of a ready-made experiment; none: go on with
    /// the sweep that --out holds
    scene: Option<String>,
    /// Change the scene for all points
    #[arg(long, value_name = "PATH=VALUE", requires = "scene")]
    set: Vec<String>,
    /// Vary a value: every one of these is combined with every one of the other --vary. Paths are
    /// those of --set; several with commas between them get the same values. The unit of the last
    /// value holds for bare numbers before it. With --hypercube: PATH="LOW..HIGH UNIT", and `log`
    /// behind it to spread logarithms evenly
    #[arg(long, value_name = "PATH=V1,V2,...", requires = "scene")]
    vary: Vec<String>,
    /// Take the points from a CSV file instead: paths in its header, a point in each row
    #[arg(
        long,
        value_name = "FILE",
        requires = "scene",
        conflicts_with = "vary",
        conflicts_with = "hypercube"
    )]
    points: Option<PathBuf>,
    /// Draw N points from a Latin hypercube between the bounds of each --vary
    #[arg(long, value_name = "N", requires = "vary", value_parser = clap::value_parser!(u32).range(1..))]
    hypercube: Option<u32>,
    /// Seed of the hypercube
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "hypercube")]
    hypercube_seed: u64,
    /// Folder of the sweep
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Runs at a time [default: one for each core, or one on a GPU]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Threads of the CPU for each run; results do not depend on it [default: the cores shared out
    /// among the jobs]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Who computes
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// Run nothing, but print the runs for others to start
    #[arg(long, value_enum, value_name = "FORM", conflicts_with_all = ["only", "collect"])]
    print: Option<Print>,
    /// Make only this run, as --print has it; more may be named
    #[arg(long, value_name = "RUN", conflicts_with = "collect")]
    only: Vec<String>,
    /// Run nothing, but collect what is done
    #[arg(long)]
    collect: bool,
    /// Show no progress
    #[arg(long)]
    quiet: bool,
    /// Replace the sweep that is there
    #[arg(long, requires = "scene")]
    force: bool,
}

/// How runs are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Print {
    /// One command a line, phase by phase
    Commands,
    /// A script that submits an array of jobs for each phase
    Slurm,
}

/// `esker sweep`
///
/// # Errors
/// Points that are wrong, another sweep in the folder, files that cannot be written. Runs that fail
/// are told at the end.
pub fn sweep(arguments: &Sweep) -> Result<ExitCode> {
    let plan = plan(arguments)?;
    let folder = Folder {
        path: &arguments.out,
        plan: &plan,
    };
    let threads = usize::from(arguments.threads.unwrap_or(1));
    match arguments.print {
        Some(Print::Commands) => print!("{}", commands(&plan, &arguments.out, threads)),
        Some(Print::Slurm) => print!("{}", slurm(&plan, &arguments.out, threads)),
        None if arguments.collect => return gather(arguments, folder),
        None => {
            let stop = on_interrupt()?;
            return match arguments.only.is_empty() {
                true => all(arguments, folder, &stop),
                false => only(arguments, folder, &stop),
            };
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The plan of the scene that is named, or the one that is there.
fn plan(arguments: &Sweep) -> Result<Plan> {
    let Some(scene) = &arguments.scene else {
        return Plan::load(&arguments.out);
    };
    let design = match (&arguments.points, arguments.hypercube) {
        (Some(file), _) => Design::list(file)?,
        (None, Some(points)) => {
            Design::hypercube(&arguments.vary, points as usize, arguments.hypercube_seed)?
        }
        (None, None) => Design::grid(&arguments.vary)?,
    };
    let scene = SceneArgs {
        scene: scene.clone(),
        set: arguments.set.clone(),
    };
    let (plan, texts) = Plan::new(&scene.source()?.0, design)?;
    let out = &arguments.out;
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    plan.store(&texts, out, arguments.force)?;
    Ok(plan)
}

fn all(arguments: &Sweep, folder: Folder, stop: &AtomicBool) -> Result<ExitCode> {
    let _held = folder.hold(true)?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    // A machine that is not there is told before anything runs.
    let on_gpu = on_gpu(folder, arguments.backend)?;
    let jobs = arguments.jobs.map(usize::from);
    let jobs = jobs.unwrap_or(if on_gpu { 1 } else { cores });
    let jobs = jobs.min(folder.plan.ends.len());
    let threads = arguments.threads.map(usize::from);
    let workers = Workers {
        jobs,
        threads: threads.unwrap_or((cores / jobs).max(1)),
        backend: arguments.backend,
        quiet: arguments.quiet,
    };
    if !arguments.quiet {
        let (points, runs) = (folder.plan.ends.len(), folder.plan.runs.len());
        eprintln!(
            "{points} points, {runs} runs, {jobs} at a time with threads of the CPU: {}",
            workers.threads
        );
    }
    let tally = work(folder, workers, stop)?;
    if stop.load(Ordering::Relaxed) {
        let (done, points) = (tally.done, folder.plan.ends.len());
        let out = arguments.out.display();
        eprintln!("stopped with {done} of {points} points done; to go on: esker sweep --out {out}");
        return Ok(ExitCode::from(INTERRUPTED));
    }
    gather(arguments, folder)
}

fn only(arguments: &Sweep, folder: Folder, stop: &AtomicBool) -> Result<ExitCode> {
    let _held = folder.hold(false)?;
    let threads = arguments.threads.map_or(0, usize::from);
    let runs = arguments.only.iter().map(|name| folder.plan.find(name));
    for number in runs.collect::<Result<Vec<_>>>()? {
        let name = &folder.plan.runs[number].name;
        let ended = run(folder, number, arguments.backend, threads, stop);
        match ended.with_context(|| name.clone())? {
            Ended::Stopped => {
                eprintln!("{name} stopped; the same command goes on with it");
                return Ok(ExitCode::from(INTERRUPTED));
            }
            Ended::Done(seconds) if !arguments.quiet => eprintln!("{name} done in {seconds:.1} s"),
            Ended::Done(_) => {}
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Collect, and say what is missing.
fn gather(arguments: &Sweep, folder: Folder) -> Result<ExitCode> {
    let status = collect(folder)?;
    if !arguments.quiet {
        warnings(folder)?;
        let done = status.iter().filter(|why| why.is_none()).count();
        let out = arguments.out.display();
        let points = status.len();
        println!(
            "{done} of {points} points are in {out}/{FILE}, a table of them in {out}/{POINTS}"
        );
    }
    let missing = status.iter().enumerate();
    let missing = missing.filter_map(|(point, why)| {
        let why = why.as_ref()?;
        Some(format!("{}\n    {why}", folder.plan.describe(point)))
    });
    let missing: Vec<String> = missing.collect();
    if !missing.is_empty() {
        bail!(
            "{} of {} points are not done; esker sweep --out {} tries them again\n{}",
            missing.len(),
            status.len(),
            arguments.out.display(),
            missing.join("\n")
        );
    }
    Ok(ExitCode::SUCCESS)
}

/// Each warning once, with the runs that gave it.
fn warnings(folder: Folder) -> Result<()> {
    let mut all: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for number in 0..folder.plan.runs.len() {
        if let Some(Outcome::Done { warnings, .. }) = folder.outcome(number)? {
            for warning in warnings {
                let name = folder.plan.runs[number].name.as_str();
                all.entry(warning).or_default().push(name);
            }
        }
    }
    for (warning, names) in all {
        let (first, more) = (names[0], names.len() - 1);
        match more {
            0 => eprintln!("warning: {first}: {warning}"),
            _ => eprintln!("warning: {first} and {more} more: {warning}"),
        }
    }
    Ok(())
}
