//! The command line of esker.

use clap::{Parser, Subcommand};
use experiments::commands::{self, Bench, Check, Import, New, Run, Sweep};
use std::process::ExitCode;

/// Grains under glaciers: the mechanics of sediment, grain by grain
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
struct Esker {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scene, from its start to the end of its protocol
    ///
    /// Ctrl-C ends it cleanly, with all that was computed on disk. A new run that starts from
    /// state.h5 has the same bits as one that was not stopped if the state is from the end of a
    /// phase; from the middle of a phase it goes on as accurately, but not with the same bits.
    Run(Run),
    /// Run a scene many times with other values, and collect the results in one file
    ///
    /// esker sweep small-shear --vary seed=1,2,3 --vary phase.shear.friction=0.3,0.5 --out mine
    ///
    /// makes six runs: every combination. What two points have in common before the first phase
    /// that differs is run only once, with as many rows in its files as the first of them asks for.
    ///
    /// Ctrl-C stops; `esker sweep --out mine` goes on. What is done is not run again, a phase that
    /// was stopped in its middle goes on from there (as accurately, not with the same bits), one
    /// that was killed begins again from the state before it, and what failed is tried again.
    ///
    /// At the end DIR/sweep.nc holds every series.nc, last values (NAME_final) and means over the
    /// last fifth of the last phase (NAME_late), with the varied quantities as dimensions
    /// (--points, --hypercube: as coordinates along `point`). DIR/points.csv says where each point
    /// stands.
    Sweep(Sweep),
    /// Say what the numbers of a scene imply, without running it
    Check(Check),
    /// List the ready-made experiments
    List,
    /// Copy a ready-made experiment into a folder of your own, to edit
    New(New),
    /// Turn a bed of grains from another program into NetCDF
    Import(Import),
    /// List the processor and the graphics devices, and what --backend auto takes
    Info,
    /// Measure how fast this machine is
    #[command(subcommand)]
    Bench(Bench),
}

fn main() -> ExitCode {
    // Mesa's layer that chooses a device for others complains on standard error where there is no
    // display; esker chooses by itself.
    // SAFETY: no other thread runs yet.
    unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    let command = Esker::parse().command;
    // Whoever reads what is printed may have seen enough, as `head` does. A run has files to finish.
    #[cfg(unix)]
    if !matches!(command, Command::Run(_) | Command::Sweep(_)) {
        // SAFETY: the default action in place of Rust's; no handler of ours runs.
        unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
    }
    let done = match command {
        Command::Run(arguments) => commands::run(&arguments),
        Command::Sweep(arguments) => commands::sweep(&arguments),
        Command::Check(arguments) => commands::check(&arguments),
        Command::List => commands::list(),
        Command::New(arguments) => commands::new(&arguments),
        Command::Import(arguments) => commands::import(&arguments),
        Command::Info => commands::info(),
        Command::Bench(arguments) => commands::bench(&arguments),
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
