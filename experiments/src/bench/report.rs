//! Results: one row a case, as a table and as JSON.

use super::packing::Packing;
use serde::Serialize;

/// One measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Grains times steps over wall time (1/s).
    pub grain_steps_per_s: f64,
    /// Mean number of grains that a grain touches, at the end; none: not counted.
    pub coordination_number: Option<f64>,
    /// Memory over grains.
    pub bytes_per_grain: f64,
}

impl Sample {
    /// Contacts between grains times steps over wall time (1/s); NaN if they were not counted.
    pub fn contacts_per_s(&self) -> f64 {
        0.5 * self.coordination_number.unwrap_or(f64::NAN) * self.grain_steps_per_s
    }
}

/// One case over all rounds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What was computed.
    pub case: String,
    /// Who computed it: `cpu` and `gpu` are esker, `lammps` is LAMMPS.
    pub backend: &'static str,
    /// The machine.
    pub device: String,
    /// Number of grains.
    pub grains: usize,
    /// Number of threads, or of LAMMPS' ranks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threads: Option<usize>,
    /// Median speed (1/s).
    pub grain_steps_per_s: f64,
    /// Slowest and fastest round (1/s).
    pub grain_steps_per_s_range: [f64; 2],
    /// Time of a step of all grains, median (microseconds).
    pub us_per_step: f64,
    /// Contacts between grains times steps over wall time, median (1/s); none: not counted.
    pub contacts_per_s: Option<f64>,
    /// Mean number of grains that a grain touches, at the end; none: not counted.
    pub coordination_number: Option<f64>,
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
    /// On rows of a GPU: where the time goes, and the floor below it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on_gpu: Option<OnGpu>,
}

/// More of a row of a GPU.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OnGpu {
    /// Is it hardware, and not software that plays it?
    pub hardware: bool,
    /// Threads that share a grain.
    pub threads_per_grain: u32,
    /// Mean number of grains in a grain's list.
    pub near_per_grain: f64,
    /// Neighbour searches in a thousand steps.
    pub searches_per_1000_steps: f64,
    /// Time of each kind of kernel by the device's own clock, in a short stretch after the
    /// rounds; empty where it has none.
    pub sections: Vec<Section>,
    /// Bytes that a step must read and write.
    pub moved_bytes_per_grain_step: f64,
    /// Floor of the launch: one dispatch after another that do nothing.
    pub us_of_empty_dispatch: f64,
    /// Floor of the memory: those bytes at the speed of a copy.
    pub us_of_moved_bytes: f64,
    /// Speed of a copy, bytes read and written (1/s).
    pub bytes_per_s_of_copy: f64,
}

/// Time of a kind of kernel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Section {
    /// Which.
    pub name: &'static str,
    /// Its share of a step (microseconds).
    pub us_per_step: f64,
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
        device: &str,
        packing: &Packing,
        threads: Option<usize>,
        samples: &[Sample],
    ) -> Self {
        let (grain_steps_per_s, grain_steps_per_s_range) =
            median_and_range(samples.iter().map(|s| s.grain_steps_per_s));
        let (contacts_per_s, _) = median_and_range(samples.iter().map(Sample::contacts_per_s));
        let last = samples[samples.len() - 1];
        Self {
            case: case.into(),
            backend,
            device: device.into(),
            grains: packing.len(),
            threads,
            grain_steps_per_s,
            grain_steps_per_s_range,
            us_per_step: 1e6 * packing.len() as f64 / grain_steps_per_s,
            contacts_per_s: last.coordination_number.map(|_| contacts_per_s),
            coordination_number: last.coordination_number,
            solid_fraction: packing.solid_fraction(),
            bytes_per_grain: last.bytes_per_grain,
            poster_ratio: None,
            one_size_ratio: None,
            on_gpu: None,
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
    let Some(first) = rows.first() else { return };
    let threads = first.threads.map(|n| format!("threads: {n}, "));
    println!(
        "{} grains, {}rounds: {rounds}, {}",
        first.grains,
        threads.unwrap_or_default(),
        first.device
    );
    println!(
        "  {:<32} {:>13} {:>21} {:>10} {:>10} {:>9} {:>9} {:>11}",
        "case",
        "grain-steps/s",
        "slowest .. fastest",
        "us a step",
        "contacts/s",
        "a grain",
        "fraction",
        "bytes/grain"
    );
    for row in rows {
        let [low, high] = row.grain_steps_per_s_range;
        print!(
            "  {:<32} {:>13.3e} {:>21} {:>10.1} {:>10} {:>9} {:>9.3} {:>11.0}",
            row.case,
            row.grain_steps_per_s,
            format!("{low:.2e} .. {high:.2e}"),
            row.us_per_step,
            row.contacts_per_s
                .map_or_else(|| "-".into(), |x| format!("{x:.3e}")),
            row.coordination_number
                .map_or_else(|| "-".into(), |x| format!("{x:.2}")),
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
    let on_gpu = rows
        .iter()
        .flat_map(|row| Some((row, row.on_gpu.as_ref()?)));
    for (row, on_gpu) in on_gpu {
        let sections = on_gpu.sections.iter();
        let sections: Vec<String> = sections
            .map(|section| format!("{} {:.2}", section.name, section.us_per_step))
            .collect();
        println!(
            "  {:<16} us a step: {}; floor: {:.2} to start it, {:.2} for {:.0} bytes a grain; \
             {:.1} near, {} threads a grain, {:.1} searches in 1000 steps",
            row.case,
            match sections.is_empty() {
                true => "no time stamps here".into(),
                false => sections.join(", "),
            },
            on_gpu.us_of_empty_dispatch,
            on_gpu.us_of_moved_bytes,
            on_gpu.moved_bytes_per_grain_step,
            on_gpu.near_per_grain,
            on_gpu.threads_per_grain,
            on_gpu.searches_per_1000_steps
        );
    }
}

/// Median, and least and greatest of values, of which there is at least one.
pub fn median_and_range(values: impl Iterator<Item = f64>) -> (f64, [f64; 2]) {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    let median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
    (median, [sorted[0], sorted[n - 1]])
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
