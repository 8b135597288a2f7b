//! The catalogue of all outputs: what the grains offer, and what the protocol adds.

use super::{FileKind, Frame};
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

/// Names of all variables of a file.
pub fn names(kind: FileKind) -> Vec<&'static str> {
    let of = |fields: &[Field]| fields.iter().map(|field| field.variable.name).collect();
    match kind {
        FileKind::Series => series().map(|series| series.variable().name).collect(),
        FileKind::Profiles => of(PROFILES),
        FileKind::Grains => of(GRAINS),
        FileKind::Contacts => of(CONTACTS),
    }
}

/// Those of `all` that are named, in the order of the catalogue; an unknown name is refused.
pub(super) fn named<'a, T>(
    all: &'a [T],
    names: &[String],
    name_of: impl Fn(&T) -> &'static str,
) -> Result<Vec<&'a T>> {
    let known: Vec<_> = all.iter().map(&name_of).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        let known = known.join(", ");
        bail!("there is no variable {name:?}; it knows {known}");
    }
    let named = |item: &&T| names.iter().any(|name| name == name_of(item));
    Ok(all.iter().filter(named).collect())
}
