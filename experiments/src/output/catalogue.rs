//! The catalogue of all outputs: what the grains offer, and what the protocol adds.

use super::{Frame, Plan};
use anyhow::{Result, bail};
use dem::output::{CONTACTS, Field, GRAINS, PROFILES, Reading, SERIES, Scalar, Storage, Variable};

/// A scalar of time that the protocol knows and the grains do not.
#[derive(Debug)]
pub struct Protocol {
    /// How the file describes it.
    pub variable: Variable,
    /// Its value.
    pub read: fn(&Frame) -> f64,
}

const fn protocol(
    name: &'static str,
    long_name: &'static str,
    storage: Storage,
    read: fn(&Frame) -> f64,
) -> Protocol {
    let variable = Variable {
        name,
        dims: &[],
        units: "1",
        long_name,
        storage,
    };
    Protocol { variable, read }
}

/// How far the protocol had come when a row was taken; every file holds it beside `time`.
pub static PROGRESS: &[Protocol] = &[
    protocol("phase", "phase of the protocol", Storage::Integer, |f| {
        f64::from(f.phase)
    }),
    protocol(
        "strain",
        "shear strain since shearing began",
        Storage::Double,
        |f| f.strain,
    ),
];

/// What the protocol adds to `series.nc`.
pub static PROTOCOL: &[Protocol] = &[protocol(
    "dilation",
    "volumetric strain of the bed since the phase began",
    Storage::Double,
    |f| f.dilation,
)];

/// A variable of `series.nc`, from wherever it is read.
#[derive(Clone, Copy, Debug)]
pub enum Series {
    /// From the protocol.
    Protocol(&'static Protocol),
    /// From the grains.
    Grains(&'static Scalar),
}

impl Series {
    /// How the file describes it.
    pub fn variable(&self) -> &'static Variable {
        match self {
            Self::Protocol(p) => &p.variable,
            Self::Grains(s) => &s.variable,
        }
    }

    /// Its value in `frame`.
    pub fn read(&self, frame: &Frame) -> f64 {
        match self {
            Self::Protocol(p) => (p.read)(frame),
            Self::Grains(s) => (s.read)(&Reading {
                model: &frame.model,
                now: &frame.snapshot,
                before: &frame.before,
            }),
        }
    }
}

/// All variables of `series.nc`; those of [`PROGRESS`] are always written.
pub fn series() -> impl Iterator<Item = Series> {
    let protocol = PROGRESS.iter().chain(PROTOCOL).map(Series::Protocol);
    protocol.chain(SERIES.iter().map(Series::Grains))
}

/// The variables that a plan names, resolved.
#[derive(Debug)]
pub(super) struct Chosen {
    pub series: Option<Vec<Series>>,
    pub profiles: Option<Vec<&'static Field>>,
    pub grains: Option<Vec<&'static Field>>,
    pub contacts: Option<Vec<&'static Field>>,
}

impl Chosen {
    /// Look up the names of `plan`; an unknown one is refused.
    pub fn new(plan: &Plan) -> Result<Self> {
        let all: Vec<_> = series().collect();
        let fields = |file, names: &Option<Vec<String>>, all: &'static [Field]| {
            let all: Vec<_> = all.iter().collect();
            choose(file, names, &all, |f| f.variable.name)
        };
        Ok(Self {
            series: choose("series.nc", &plan.series, &all, |s| s.variable().name)?,
            profiles: fields("profiles.nc", &plan.profiles, PROFILES)?,
            grains: fields("grains.nc", &plan.grains, GRAINS)?,
            contacts: fields("contacts.nc", &plan.contacts, CONTACTS)?,
        })
    }
}

/// Those of `all` that are named, in the order of the catalogue.
fn choose<T: Copy>(
    file: &str,
    names: &Option<Vec<String>>,
    all: &[T],
    name_of: impl Fn(&T) -> &'static str,
) -> Result<Option<Vec<T>>> {
    let Some(names) = names else { return Ok(None) };
    let known: Vec<_> = all.iter().map(&name_of).collect();
    for name in names {
        if !known.contains(&name.as_str()) {
            bail!(
                "{file} has no variable \"{name}\"; it knows {}",
                known.join(", ")
            );
        }
    }
    let named = |item: &&T| names.iter().any(|name| name == name_of(item));
    Ok(Some(all.iter().filter(named).copied().collect()))
}
