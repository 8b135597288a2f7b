//! `[output]`: which files, which variables, how often.

use super::Scene;
use super::layers::LOOSEST;
use super::phase::{End, Phase};
use super::reader::{Range, Reader, Table};
use super::tree::Step;
use super::units::{LENGTH, TIME};
use crate::output::{FileKind, catalogue};
use crate::protocol;
use enum_map::EnumMap;

/// The files of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Each of them; none: not written.
    pub files: EnumMap<FileKind, Option<File>>,
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
        let series = self.files[FileKind::Series].as_ref();
        series.is_some_and(|file| file.variables.iter().any(|name| needs_sums(name)))
    }
}

/// A file cannot have more than a row a step. Intervals that were chosen become a step long,
/// those that the scene states are refused.
pub fn check(scene: &mut Scene, reader: &Reader) {
    let step = scene.step;
    for (kind, file) in &mut scene.output.files {
        let path = ["output", kind.key(), "every"].map(|key| Step::Key(key.into()));
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
    if scene.output.files[FileKind::Profiles].is_some()
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
            false => protocol::start_height(self).max(settled),
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
    [
        "dissipated_",
        "work_",
        "energy_residual",
        "solid_fraction_drift",
    ]
    .iter()
    .any(|start| name.starts_with(start))
}

/// Read `[output]`, of a scene that is `wet` or dry; `phases` set the default intervals, and the mean `diameter` [m] of the
/// grains that of the profiles' layers. `rough`: have the top and the bottom wall the full law?
pub fn read(
    root: &Table,
    phases: &[Phase],
    diameter: f64,
    rough: [bool; 2],
    wet: bool,
) -> Option<Output> {
    let total: f64 = phases.iter().map(expected).sum();
    let example = "[output] with series = { every = \"1 ms\" }";
    let table = &root.table_or_empty("output", example)?;
    let mut layer = diameter;
    let files = EnumMap::from_fn(|kind| {
        if kind == FileKind::Fluid && !wet {
            return None;
        }
        let (file, of_profiles) = file(table, kind, total, &variables(kind, rough, wet), wet)?;
        if kind == FileKind::Profiles {
            layer = of_profiles.quantity_or("layer", &LENGTH, Range::Positive, diameter);
        }
        Some(file)
    });
    Some(Output { files, layer })
}

/// Rows over the whole protocol unless the scene says otherwise, and an example of an interval.
fn rows(kind: FileKind) -> (f64, &'static str) {
    match kind {
        FileKind::Series => (1000.0, "1 ms"),
        FileKind::Profiles | FileKind::Fluid => (100.0, "10 ms"),
        FileKind::Grains => (20.0, "50 ms"),
        FileKind::Contacts => (20.0, "0.1 s"),
    }
}

/// The variables of a file unless the scene says otherwise: all, without what is always zero, the
/// friction of frictionless walls.
fn variables(kind: FileKind, rough: [bool; 2], wet: bool) -> Vec<&'static str> {
    let mut names = known(kind, wet);
    for (wall, rough) in ["top", "bottom"].into_iter().zip(rough) {
        let start = format!("wall_shear_stress_{wall}");
        names.retain(|name| rough || !name.starts_with(&start));
    }
    names
}

/// All variables of a file.
fn known(kind: FileKind, wet: bool) -> Vec<&'static str> {
    match wet {
        true => catalogue::wet_names(kind),
        false => catalogue::names(kind),
    }
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

/// The file of a kind with the variables `chosen` where the scene says nothing, and its table for
/// what else it may say.
fn file<'a>(
    outer: &Table<'a>,
    kind: FileKind,
    total: f64,
    chosen: &[&'static str],
    wet: bool,
) -> Option<(File, Table<'a>)> {
    let key = kind.key();
    let (rows, interval) = rows(kind);
    // Contacts fill the disk: they are written only if asked for.
    if kind == FileKind::Contacts && !outer.has(key) {
        outer.choose(key, "none");
        return None;
    }
    if outer.is_word(key, "none") {
        return None;
    }
    let example = format!("{key} = {{ every = {interval:?} }}, or \"none\"");
    let table = outer.table_or_empty(key, &example)?;
    let every = table.quantity_or("every", &TIME, Range::Positive, round(total / rows));
    let known = known(kind, wet);
    let example = format!("variables = {:?}", &known[..known.len().min(2)]);
    let stated = table.texts("variables", &example);
    for name in stated.iter().flatten() {
        if !known.contains(name) {
            let known = known.join(", ");
            let message = format!("{name:?} is not known; there are: {known}");
            table.wrong("variables", message);
        }
    }
    let variables = stated.unwrap_or_else(|| {
        let all = toml_edit::Array::from_iter(chosen.iter().copied());
        table.choose("variables", all);
        chosen.to_vec()
    });
    let variables = variables.into_iter().map(Into::into).collect();
    Some((File { every, variables }, table))
}

/// The next of 1, 2, 5 times a power of ten below `x`.
pub fn round(x: f64) -> f64 {
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
