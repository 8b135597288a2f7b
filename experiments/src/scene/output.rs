//! `[output]`: which files, which variables, how often.

use super::Scene;
use super::layers::LOOSEST;
use super::phase::{End, Phase};
use super::reader::{Range, Reader, Table};
use super::tree::Step;
use super::units::{LENGTH, TIME};
use crate::protocol;

/// The files of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// `series.nc`; none: not written.
    pub series: Option<File>,
    /// `profiles.nc`.
    pub profiles: Option<File>,
    /// `grains.nc`.
    pub grains: Option<File>,
    /// `contacts.nc`.
    pub contacts: Option<File>,
    /// Thickness of the profiles' layers [m].
    pub layer: f64,
}

/// One file.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// Time between rows [s].
    pub every: f64,
    /// Names of its variables.
    pub variables: Vec<String>,
}

impl Output {
    /// Does any variable need the sums of the energy ledger?
    pub fn needs_ledger(&self) -> bool {
        let series = self.series.iter().flat_map(|file| &file.variables);
        series.into_iter().any(|name| needs_sums(name))
    }
}

/// A file cannot have more than a row a step. Intervals that were chosen become a step long,
/// those that the scene states are refused.
pub fn check(scene: &mut Scene, reader: &Reader) {
    let (step, output) = (scene.step, &mut scene.output);
    let files = [
        ("series", &mut output.series),
        ("profiles", &mut output.profiles),
        ("grains", &mut output.grains),
        ("contacts", &mut output.contacts),
    ];
    for (key, file) in files {
        let path = ["output", key, "every"].map(|key| Step::Key(key.into()));
        let Some(file) = file.as_mut().filter(|file| file.every < step) else {
            continue;
        };
        if reader.says(&path) {
            let every = file.every;
            let message = format!("is {every:e} s, shorter than the time step of {step:e} s");
            let message = format!("{message}; write e.g. every = \"1 ms\"");
            reader.note(&path, message);
        } else {
            file.every = step;
            reader.choose(&path, TIME.write(step));
        }
    }
    if scene.output.profiles.is_some()
        && let Err(message) = scene.profile_edges()
    {
        reader.wrong(&["output", "profiles", "layer"], message);
    }
}

/// Layers of a profile; more tell nothing about grains, and fill the disk.
const MOST_LAYERS: usize = 100_000;

impl Scene {
    /// Edges of the layers of `profiles.nc` [m]: from the bottom to a little above the bed as it
    /// will be when settled.
    ///
    /// # Errors
    /// More layers than make sense.
    pub fn profile_edges(&self) -> Result<Vec<f64>, String> {
        let (grains, layer) = (&self.start.grains, self.output.layer);
        let solid: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
        let settled = solid / (LOOSEST * self.domain.area());
        // A bed that comes settled from a file may be higher than its own volume says.
        let height = match self.start.contacts.is_empty() {
            true => settled,
            false => protocol::bed_height(&self.start).max(settled),
        };
        let count = (height / layer).ceil().max(1.0) as usize;
        if count > MOST_LAYERS {
            return Err(format!(
                "is {layer} m, which cuts the bed into {count} layers, more than {MOST_LAYERS}; \
                 write e.g. one diameter, {:.1e} m",
                2.0 * grains.mean_radius()
            ));
        }
        Ok((0..=count).map(|k| k as f64 * layer).collect())
    }
}

/// Energies of the instant are read from the state; the others are summed step by step.
fn needs_sums(name: &str) -> bool {
    ["dissipated_", "work_", "energy_residual"]
        .iter()
        .any(|start| name.starts_with(start))
}

/// What a file is unless the scene says otherwise.
struct Default {
    key: &'static str,
    example: &'static str,
    /// Rows over the whole protocol; none: the file is not written unless asked for.
    rows: Option<f64>,
    /// All variables that it knows.
    known: Vec<&'static str>,
    /// Those that it holds.
    variables: Vec<&'static str>,
}

/// Read `[output]`; `phases` set the default intervals, and the mean `diameter` [m] of the
/// grains that of the profiles' layers. `rough`: have the top and the bottom wall the full law?
pub fn read(root: &Table, phases: &[Phase], diameter: f64, rough: [bool; 2]) -> Option<Output> {
    let total: f64 = phases.iter().map(expected).sum();
    let example = "[output] with series = { every = \"1 ms\" }";
    let table = &root.table_or_empty("output", example)?;
    let series = Default {
        key: "series",
        example: "series = { every = \"1 ms\" }",
        rows: Some(1000.0),
        known: series_names(),
        variables: series_names_for(rough),
    };
    let profiles = Default {
        key: "profiles",
        example: "profiles = { every = \"10 ms\" }",
        rows: Some(100.0),
        known: names(dem::output::PROFILES),
        variables: names(dem::output::PROFILES),
    };
    let grains = Default {
        key: "grains",
        example: "grains = { every = \"50 ms\" }",
        rows: Some(20.0),
        known: names(dem::output::GRAINS),
        variables: names(dem::output::GRAINS),
    };
    let contacts = Default {
        key: "contacts",
        example: "contacts = { every = \"0.1 s\" }",
        rows: None,
        known: names(dem::output::CONTACTS),
        variables: names(dem::output::CONTACTS),
    };
    let mut layer = diameter;
    let of_profiles = |table: &Table| {
        layer = table.quantity_or("layer", &LENGTH, Range::Positive, diameter);
    };
    Some(Output {
        series: file(table, &series, total, |_| {}),
        profiles: file(table, &profiles, total, of_profiles),
        grains: file(table, &grains, total, |_| {}),
        contacts: file(table, &contacts, total, |_| {}),
        layer,
    })
}

/// Without what is always zero: the friction of frictionless walls.
fn series_names_for(rough: [bool; 2]) -> Vec<&'static str> {
    let mut names = series_names();
    for (wall, rough) in ["top", "bottom"].into_iter().zip(rough) {
        let start = format!("wall_shear_stress_{wall}");
        names.retain(|name| rough || !name.starts_with(&start));
    }
    names
}

fn series_names() -> Vec<&'static str> {
    let all = crate::output::catalogue::series();
    all.map(|series| series.variable().name).collect()
}

fn names(fields: &[dem::output::Field]) -> Vec<&'static str> {
    fields.iter().map(|field| field.variable.name).collect()
}

/// About how long a phase lasts [s]; a tenth of `max_duration` where a criterion ends it.
fn expected(phase: &Phase) -> f64 {
    use super::phase::Shear;
    let End {
        duration,
        strain,
        at_rest,
    } = phase.end;
    let of_strain = match (phase.shear, strain) {
        (Some(Shear::StrainRate(rate)), Some(strain)) => (strain / rate).abs(),
        _ => f64::INFINITY,
    };
    let known = if at_rest.is_some() {
        0.1 * duration
    } else {
        duration
    };
    let expected = known.min(of_strain);
    // A velocity without a height yet: some seconds, as good as any guess.
    if expected.is_finite() { expected } else { 10.0 }
}

/// The file `default.key`; `more` reads what only this one has.
fn file(outer: &Table, default: &Default, total: f64, more: impl FnOnce(&Table)) -> Option<File> {
    let key = default.key;
    if !outer.has(key) && default.rows.is_none() {
        outer.choose(key, "none");
    }
    if outer.is_word(key, "none") || !outer.has(key) && default.rows.is_none() {
        return None;
    }
    let table = outer.table_or_empty(key, &format!("{}, or \"none\"", default.example))?;
    let rows = default.rows.unwrap_or(20.0);
    let every = table.quantity_or("every", &TIME, Range::Positive, round(total / rows));
    more(&table);
    let example = format!(
        "variables = {:?}",
        &default.known[..default.known.len().min(2)]
    );
    let variables = table.texts("variables", &example);
    for name in variables.iter().flatten() {
        if !default.known.contains(name) {
            let known = default.known.join(", ");
            table.wrong(
                "variables",
                format!("{name:?} is not known; there are: {known}"),
            );
        }
    }
    let variables = variables.unwrap_or_else(|| {
        let all = toml_edit::Array::from_iter(default.variables.iter().copied());
        table.choose("variables", all);
        default.variables.clone()
    });
    Some(File {
        every,
        variables: variables.into_iter().map(Into::into).collect(),
    })
}

/// The next of 1, 2, 5 times a power of ten below `x`.
fn round(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let digit = x / power;
    let digit = if digit >= 5.0 {
        5.0
    } else if digit >= 2.0 {
        2.0
    } else {
        1.0
    };
    digit * power
}
