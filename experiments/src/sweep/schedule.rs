//! Which run is next, and how long the rest will take.

use super::plan::Plan;
use super::runs::Ended;
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Where a run stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// It, or the run that it starts from, is not done.
    Waiting,
    /// Since then.
    Running(Instant),
    /// It took so long [s].
    Done(f64),
    /// Why.
    Failed(String),
    /// It can go on another time.
    Stopped,
}

/// Where all runs stand.
#[derive(Debug)]
pub struct Schedule<'a> {
    plan: &'a Plan,
    status: Vec<Status>,
}

impl<'a> Schedule<'a> {
    /// Runs that are done already took so long [s]; all others are waiting.
    pub fn new(plan: &'a Plan, done: &[Option<f64>]) -> Self {
        let status = |seconds: &Option<f64>| seconds.map_or(Status::Waiting, Status::Done);
        Self {
            plan,
            status: done.iter().map(status).collect(),
        }
    }

    /// The next run that can start; it counts as running from now on.
    pub fn next(&mut self) -> Option<usize> {
        let ready = |run: &usize| {
            let from = self.plan.runs[*run].from;
            self.status[*run] == Status::Waiting
                && from.is_none_or(|from| matches!(self.status[from], Status::Done(_)))
        };
        let run = (0..self.status.len()).find(ready)?;
        self.status[run] = Status::Running(Instant::now());
        Some(run)
    }

    /// Run number `run` has ended; without it none that starts from it can be.
    pub fn end(&mut self, run: usize, ended: Result<Ended, String>) {
        self.status[run] = match ended {
            Ok(Ended::Done(seconds)) => Status::Done(seconds),
            Ok(Ended::Stopped) => Status::Stopped,
            Err(reason) => Status::Failed(reason),
        };
        // Each run comes after the one that it starts from.
        for later in run + 1..self.status.len() {
            let from = self.plan.runs[later].from;
            if let Some(Status::Failed(reason)) = from.map(|from| &self.status[from]) {
                let name = &self.plan.runs[from.expect("it has one")].name;
                let reason = match reason.starts_with("it starts from") {
                    true => reason.clone(),
                    false => format!("it starts from {name}, which failed: {reason}"),
                };
                self.status[later] = Status::Failed(reason);
            }
        }
    }

    /// Names of the runs that are running.
    pub fn running(&self) -> Vec<&'a str> {
        let each = self.plan.runs.iter().zip(&self.status);
        let running = each.filter(|(_, status)| matches!(status, Status::Running(_)));
        running.map(|(run, _)| run.name.as_str()).collect()
    }

    /// Can nothing more be started, and does nothing run?
    pub fn over(&self) -> bool {
        let busy = |status: &Status| matches!(status, Status::Waiting | Status::Running(_));
        !self.status.iter().any(busy)
    }

    /// Points that are done.
    pub fn done(&self) -> usize {
        let ends = self.plan.ends.iter();
        let done = |run: &&usize| matches!(self.status[**run], Status::Done(_));
        ends.filter(done).count()
    }

    /// Points that failed, and why.
    pub fn failed(&self) -> Vec<(usize, String)> {
        let each = self.plan.ends.iter().enumerate();
        let failed = each.filter_map(|(point, &run)| match &self.status[run] {
            Status::Failed(reason) => Some((point, reason.clone())),
            _ => None,
        });
        failed.collect()
    }

    /// How much of the whole is done [0 to 1].
    pub fn share(&self) -> f64 {
        let whole: f64 = self.plan.runs.iter().map(|run| run.work as f64).sum();
        let over = |status: &Status| matches!(status, Status::Done(_) | Status::Failed(_));
        let each = self.plan.runs.iter().zip(&self.status);
        let done = each.filter(|(_, status)| over(status));
        done.map(|(run, _)| run.work as f64).sum::<f64>() / whole
    }

    /// About how long `jobs` at a time still take; none: nothing is done that would tell.
    ///
    /// A run takes as long for its work as those of the same phase took that are done, or as all.
    pub fn left(&self, jobs: usize) -> Option<Duration> {
        let mut rates: HashMap<Option<usize>, [f64; 2]> = HashMap::new();
        for (run, status) in self.plan.runs.iter().zip(&self.status) {
            if let Status::Done(seconds) = status {
                for key in [None, Some(run.phase)] {
                    let [sum, work] = rates.entry(key).or_default();
                    (*sum, *work) = (*sum + seconds, *work + run.work as f64);
                }
            }
        }
        let [sum, work] = *rates.get(&None)?;
        let all = sum / work;
        let (mut total, mut longest) = (0.0, 0.0_f64);
        for (run, status) in self.plan.runs.iter().zip(&self.status) {
            let rate = rates.get(&Some(run.phase)).map_or(all, |[s, w]| s / w);
            let whole = rate * run.work as f64;
            let rest = match status {
                Status::Waiting => whole,
                Status::Running(since) => (whole - since.elapsed().as_secs_f64()).max(0.0),
                _ => continue,
            };
            total += rest;
            longest = longest.max(rest);
        }
        Duration::try_from_secs_f64((total / jobs as f64).max(longest)).ok()
    }
}
