//! How far a sweep is: points done, runs under way, failures, time left.

use super::schedule::Schedule;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use std::time::Duration;

/// A bar on a terminal, a line for each run that ends elsewhere, or nothing.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    points: usize,
    jobs: usize,
}

/// Parts of the bar.
const PARTS: u64 = 1000;

impl Progress {
    /// A bar for so many points, with so many runs at a time.
    pub fn new(quiet: bool, points: usize, jobs: usize) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(PARTS)
        };
        let style = ProgressStyle::with_template("[{bar:20}] {wide_msg}");
        let style = style.expect("the template is fixed");
        bar.set_style(style.progress_chars("=> "));
        Self {
            bar,
            quiet,
            points,
            jobs,
        }
    }

    /// Show where all runs stand.
    pub fn show(&self, schedule: &Schedule) {
        self.bar
            .set_position((schedule.share() * PARTS as f64) as u64);
        self.bar.set_message(self.line(schedule));
    }

    /// Say that a run has ended.
    pub fn say(&self, what: &str, schedule: &Schedule) {
        if self.quiet {
            return;
        }
        if self.bar.is_hidden() {
            eprintln!("{what}; {}", self.line(schedule));
        } else {
            self.bar.println(what);
            self.show(schedule);
        }
    }

    /// All is over.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn line(&self, schedule: &Schedule) -> String {
        let running = schedule.running();
        let names = match running.len() {
            0 => String::new(),
            1..=4 => format!(" ({})", running.join(", ")),
            _ => format!(" ({}, ...)", running[..4].join(", ")),
        };
        let left = match schedule.left(self.jobs) {
            Some(Duration::ZERO) => "nothing left".into(),
            Some(left) => format!("about {} left", HumanDuration(left)),
            None => "time left not known yet".into(),
        };
        format!(
            "{} of {} points done, {} running{names}, {} failed, {left}",
            schedule.done(),
            self.points,
            running.len(),
            schedule.failed().len()
        )
    }
}
