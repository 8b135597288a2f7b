//! Results: one row a case, as a table and as JSON.

use super::packing::Packing;
use serde::Serialize;
use sysinfo::{CpuRefreshKind, RefreshKind, System};

/// One measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Grains times steps over wall time (1/s).
    pub grain_steps_per_s: f64,
    /// Mean number of grains that a grain touches, at the end.
    pub coordination_number: f64,
    /// Memory over grains.
    pub bytes_per_grain: f64,
}

impl Sample {
    /// Contacts between grains times steps over wall time (1/s).
    pub fn contacts_per_s(&self) -> f64 {
        0.5 * self.coordination_number * self.grain_steps_per_s
    }
}

/// One case over all rounds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What was computed.
    pub case: String,
    /// Who computed it: `cpu` is esker, `lammps` is LAMMPS.
    pub backend: &'static str,
    /// The machine.
    pub device: String,
    /// Number of grains.
    pub grains: usize,
    /// Number of threads, or of LAMMPS' ranks.
    pub threads: usize,
    /// Median speed (1/s).
    pub grain_steps_per_s: f64,
    /// Slowest and fastest round (1/s).
    pub grain_steps_per_s_range: [f64; 2],
    /// Contacts between grains times steps over wall time, median (1/s).
    pub contacts_per_s: f64,
    /// Mean number of grains that a grain touches, at the end.
    pub coordination_number: f64,
    /// Volume of the grains over that between the planes.
    pub solid_fraction: f64,
    /// Memory over grains.
    pub bytes_per_grain: f64,
    /// On rows of LAMMPS: speed of `poster` over this one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poster_ratio: Option<Ratio>,
    /// On `log-normal`: its contacts per second over those of `one-size`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_size_ratio: Option<Ratio>,
}

/// How many times as fast one case is as another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// Median of the ratios of the rounds.
    pub median: f64,
    /// Smallest and largest ratio of a round.
    pub range: [f64; 2],
}

impl Row {
    /// Summary of the samples of one case; there is at least one.
    pub fn new(
        case: &str,
        backend: &'static str,
        packing: &Packing,
        threads: usize,
        samples: &[Sample],
    ) -> Self {
        let (grain_steps_per_s, grain_steps_per_s_range) =
            median_and_range(samples.iter().map(|s| s.grain_steps_per_s));
        let (contacts_per_s, _) = median_and_range(samples.iter().map(Sample::contacts_per_s));
        let last = samples[samples.len() - 1];
        Self {
            case: case.into(),
            backend,
            device: processor(),
            grains: packing.len(),
            threads,
            grain_steps_per_s,
            grain_steps_per_s_range,
            contacts_per_s,
            coordination_number: last.coordination_number,
            solid_fraction: packing.solid_fraction(),
            bytes_per_grain: last.bytes_per_grain,
            poster_ratio: None,
            one_size_ratio: None,
        }
    }
}

/// Ratios of the speeds of two cases, round by round.
pub fn ratio(fast: &[Sample], slow: &[Sample], speed: impl Fn(&Sample) -> f64) -> Ratio {
    let each = fast.iter().zip(slow).map(|(f, s)| speed(f) / speed(s));
    let (median, range) = median_and_range(each);
    Ratio { median, range }
}

/// Print the rows of one packing and one number of threads.
pub fn print(rows: &[Row], rounds: u32) {
    let first = &rows[0];
    println!(
        "{} grains, threads: {}, rounds: {rounds}, {}",
        first.grains, first.threads, first.device
    );
    println!(
        "  {:<32} {:>13} {:>21} {:>10} {:>9} {:>9} {:>11}",
        "case",
        "grain-steps/s",
        "slowest .. fastest",
        "contacts/s",
        "a grain",
        "fraction",
        "bytes/grain"
    );
    for row in rows {
        let [low, high] = row.grain_steps_per_s_range;
        print!(
            "  {:<32} {:>13.3e} {:>21} {:>10.3e} {:>9.2} {:>9.3} {:>11.0}",
            row.case,
            row.grain_steps_per_s,
            format!("{low:.2e} .. {high:.2e}"),
            row.contacts_per_s,
            row.coordination_number,
            row.solid_fraction,
            row.bytes_per_grain
        );
        if let Some(Ratio { median, range }) = row.poster_ratio {
            let [low, high] = range;
            print!("  poster is {median:.2} times as fast ({low:.2} .. {high:.2})");
        }
        if let Some(Ratio { median, range }) = row.one_size_ratio {
            let [low, high] = range;
            print!("  {median:.2} times the contacts/s of one-size ({low:.2} .. {high:.2})");
        }
        println!();
    }
}

fn median_and_range(values: impl Iterator<Item = f64>) -> (f64, [f64; 2]) {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    let median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
    (median, [sorted[0], sorted[n - 1]])
}

/// Name of the processor, or its architecture where the system does not tell.
fn processor() -> String {
    let wanted = RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing());
    let system = System::new_with_specifics(wanted).ok();
    let brand = system.and_then(|s| s.cpus().first().map(|cpu| cpu.brand().trim().to_owned()));
    brand
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| std::env::consts::ARCH.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_of_odd_and_even_counts() {
        let odd = median_and_range([3.0, 1.0, 2.0].into_iter());
        assert_eq!(odd, (2.0, [1.0, 3.0]));
        let even = median_and_range([4.0, 1.0, 2.0, 3.0].into_iter());
        assert_eq!(even, (2.5, [1.0, 4.0]));
    }
}
