//! `[output]` of water alone: `series.nc` and `fluid.nc`.

use super::{End, Water};
use crate::output::FileKind;
use crate::output::fluid::{FIELDS, SCALARS};
use crate::scene::output::{File, round};
use crate::scene::reader::{Range, Reader, Table};
use crate::scene::tree::Step;
use crate::scene::units::TIME;
use enum_map::EnumMap;

/// The files of a run; none: not written.
pub type Output = EnumMap<FileKind, Option<File>>;

/// Read `[output]`. Where `water` and `end` could not be read, only the words are checked.
pub fn read(
    root: &Table,
    reader: &Reader,
    water: Option<&Water>,
    end: Option<End>,
) -> Option<Output> {
    let example = "[output] with fluid = { every = \"1 ms\" }";
    let table = &root.table_or_empty("output", example)?;
    // What a criterion ends lasts a tenth of what it may, as for grains.
    let total = end.map_or(1.0, |end| match end.steady {
        Some(_) => 0.1 * end.duration,
        None => end.duration,
    });
    let step = water.map_or(0.0, |water| water.scaling.step);
    let chosen = |by: fn(&Water) -> bool| water.is_none_or(by);
    let names = SCALARS.iter().map(|s| (s.variable.name, chosen(s.chosen)));
    let names = names.collect();
    let series = file(table, reader, FileKind::Series, names, total / 500.0, step);
    let names = FIELDS.iter().map(|f| (f.variable.name, chosen(f.chosen)));
    let names = names.collect();
    let fluid = file(table, reader, FileKind::Fluid, names, total / 20.0, step);
    if let (Some(water), Some(fluid)) = (water, &fluid) {
        for field in FIELDS {
            let name = field.variable.name;
            if let Some(why) =
                (field.refused)(water).filter(|_| fluid.variables.iter().any(|v| v == name))
            {
                let path = ["output", "fluid", "variables"].map(|key| Step::Key(key.into()));
                reader.note(&path, format!("{name:?} is not there: {why}"));
            }
        }
    }
    let mut files = Output::default();
    files[FileKind::Series] = series;
    files[FileKind::Fluid] = fluid;
    Some(files)
}

/// One file with the variables `known`, of which some are taken where the scene says nothing, and
/// rows `every` so many seconds then, but no faster than the `step` [s].
fn file(
    outer: &Table,
    reader: &Reader,
    kind: FileKind,
    known: Vec<(&'static str, bool)>,
    every: f64,
    step: f64,
) -> Option<File> {
    let key = kind.key();
    if outer.is_word(key, "none") {
        return None;
    }
    let example = format!("{key} = {{ every = \"1 ms\" }}, or \"none\"");
    let table = outer.table_or_empty(key, &example)?;
    let every = table.quantity_or("every", &TIME, Range::Positive, round(every).max(step));
    if every < step {
        let message = format!(
            "is {every:e} s, shorter than the time step of {step:.3e} s; write at least that"
        );
        let path = ["output", key, "every"].map(|key| Step::Key(key.into()));
        reader.note(&path, message);
    }
    let example = format!("variables = [{:?}]", known[0].0);
    let stated = table.texts("variables", &example);
    for name in stated.iter().flatten() {
        if !known.iter().any(|(own, _)| own == name) {
            let names: Vec<_> = known.iter().map(|(name, _)| *name).collect();
            let message = format!("{name:?} is not known; there are: {}", names.join(", "));
            table.wrong("variables", message);
        }
    }
    let variables = stated.unwrap_or_else(|| {
        let chosen = known
            .iter()
            .filter(|(_, chosen)| *chosen)
            .map(|(name, _)| *name);
        let chosen: Vec<_> = chosen.collect();
        table.choose(
            "variables",
            toml_edit::Array::from_iter(chosen.iter().copied()),
        );
        chosen
    });
    let variables = variables.into_iter().map(Into::into).collect();
    Some(File { every, variables })
}
