//! All runs of a sweep, several at a time, in one program.

use super::outcome::Outcome;
use super::progress::Progress;
use super::runs::{Ended, Folder, run};
use super::schedule::Schedule;
use crate::backend::Backend;
use anyhow::Result;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex};
use std::thread;
use std::time::Duration;

/// Who works.
#[derive(Clone, Copy, Debug)]
pub struct Workers {
    /// Runs at a time.
    pub jobs: usize,
    /// Threads of the CPU for each.
    pub threads: usize,
    /// Who computes.
    pub backend: Backend,
    /// Say nothing?
    pub quiet: bool,
}

/// What came of all points.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// Number of points that are done.
    pub done: usize,
    /// Points that failed, and why.
    pub failed: Vec<(usize, String)>,
}

/// What all workers share.
struct Shared<'a> {
    schedule: Mutex<Schedule<'a>>,
    changed: Condvar,
    progress: Progress,
}

/// Run all that is not done, until it is or `stop` becomes true.
///
/// # Errors
/// Files that cannot be read; what makes a run fail is in the tally.
pub fn work(folder: Folder, workers: Workers, stop: &AtomicBool) -> Result<Tally> {
    let plan = folder.plan;
    let done = (0..plan.runs.len()).map(|run| {
        Ok(match folder.outcome(run)? {
            Some(Outcome::Done { seconds, .. }) => Some(seconds),
            // What failed is tried again.
            Some(Outcome::Failed { .. }) | None => None,
        })
    });
    let schedule = Schedule::new(plan, &done.collect::<Result<Vec<_>>>()?);
    let shared = Shared {
        schedule: Mutex::new(schedule),
        changed: Condvar::new(),
        progress: Progress::new(workers.quiet, plan.ends.len(), workers.jobs),
    };
    thread::scope(|scope| {
        for _ in 0..workers.jobs {
            scope.spawn(|| shared.worker(folder, workers, stop));
        }
        shared.watch(stop);
    });
    shared.progress.finish();
    let schedule = shared.schedule.into_inner().expect(SOUND);
    Ok(Tally {
        done: schedule.done(),
        failed: schedule.failed(),
    })
}

/// No worker panics while it holds the schedule.
const SOUND: &str = "the schedule is whole";

impl Shared<'_> {
    fn worker(&self, folder: Folder, workers: Workers, stop: &AtomicBool) {
        let mut schedule = self.schedule.lock().expect(SOUND);
        while !stop.load(Ordering::Relaxed) && !schedule.over() {
            let Some(number) = schedule.next() else {
                schedule = self.changed.wait(schedule).expect(SOUND);
                continue;
            };
            drop(schedule);
            let (backend, threads) = (workers.backend, workers.threads);
            // A run that panics is a run that failed.
            let ended = catch_unwind(AssertUnwindSafe(|| {
                run(folder, number, backend, threads, stop)
            }));
            let ended = match ended {
                Ok(ended) => ended.map_err(|error| format!("{error:#}")),
                Err(panic) => Err(format!("it panicked: {}", message(&*panic))),
            };
            schedule = self.schedule.lock().expect(SOUND);
            let name = &folder.plan.runs[number].name;
            let what = match &ended {
                Ok(Ended::Done(seconds)) => format!("{name} done in {seconds:.1} s"),
                Ok(Ended::Stopped) => format!("{name} stopped"),
                Err(reason) => format!("{name} FAILED: {reason}"),
            };
            schedule.end(number, ended);
            self.progress.say(&what, &schedule);
            self.changed.notify_all();
        }
        self.changed.notify_all();
    }

    /// Show how far it is, until nothing runs any more.
    fn watch(&self, stop: &AtomicBool) {
        let mut schedule = self.schedule.lock().expect(SOUND);
        loop {
            self.progress.show(&schedule);
            let stopped = stop.load(Ordering::Relaxed) && schedule.running().is_empty();
            if stopped || schedule.over() {
                break;
            }
            let second = Duration::from_secs(1);
            (schedule, _) = self.changed.wait_timeout(schedule, second).expect(SOUND);
        }
        // Those that wait for a run see the stop.
        self.changed.notify_all();
    }
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("without a word")
}
