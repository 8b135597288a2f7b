//! The progress bar: phase, simulated time, steps per second, time left.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar on a terminal, one line a phase elsewhere, or nothing.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    /// Steps that each phase may make.
    expected: Vec<u64>,
    /// Steps of the phases before.
    before: u64,
    /// Steps of the phase that runs.
    done: u64,
}

impl Progress {
    /// A bar for phases of `expected` steps each.
    pub fn new(quiet: bool, expected: Vec<u64>) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(sum(&expected))
        };
        let form = "{prefix:>12} [{bar:30}] {percent:>3} %  {msg}, {eta} left";
        let style = ProgressStyle::with_template(form).expect("the template is fixed");
        bar.set_style(style.progress_chars("=> "));
        Self {
            bar,
            quiet,
            expected,
            before: 0,
            done: 0,
        }
    }

    /// Phase `number` begins; now its `steps` are known.
    pub fn begin(&mut self, number: usize, name: &str, steps: u64) {
        self.before += self.done;
        self.done = 0;
        self.expected[number] = steps;
        let ahead = sum(&self.expected[number..]);
        self.bar.set_length(self.before.saturating_add(ahead));
        self.bar.set_prefix(name.to_owned());
    }

    /// The phase has made `done` steps of `step` [s].
    pub fn at(&mut self, done: u64, step: f64, steps_per_second: f64) {
        self.done = done;
        let time = done as f64 * step;
        self.bar.set_position(self.before + done);
        self.bar.set_message(format!(
            "{time:.4} s simulated, {steps_per_second:.0} steps/s"
        ));
    }

    /// Print `line` above the bar.
    pub fn say(&mut self, line: &str) {
        if self.quiet {
            return;
        }
        if self.bar.is_hidden() {
            eprintln!("{line}");
        } else {
            self.bar.println(line);
        }
    }

    /// All is over.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A duration beyond all bounds is as many steps as can be counted.
fn sum(steps: &[u64]) -> u64 {
    steps.iter().fold(0, |sum, &n| sum.saturating_add(n))
}
