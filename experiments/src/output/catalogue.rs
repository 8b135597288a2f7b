//! The catalogue of all outputs: what the grains offer, and what the protocol adds.

use super::pores::{self, SCALARS};
use super::{FileKind, Frame};
use anyhow::{Result, bail};
use dem::output::{
    CONTACTS, Field, FieldReading, GRAINS, PROFILES, Reading, SERIES, Scalar, Storage, Variable,
};
use ndarray::{Array1, ArrayD};

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
    /// From the water between them.
    Water(&'static pores::Scalar),
}

impl Series {
    /// How the file describes it.
    pub fn variable(&self) -> &'static Variable {
        match self {
            Self::Protocol(p) => &p.variable,
            Self::Grains(s) => &s.variable,
            Self::Water(s) => &s.variable,
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
            Self::Water(s) => {
                let water = frame.water.as_ref();
                water.map_or(f64::NAN, |water| (s.read)(frame, water))
            }
        }
    }
}

/// A variable of `profiles.nc`, from wherever it is read.
#[derive(Clone, Copy, Debug)]
pub enum Profile {
    /// From the grains.
    Grains(&'static Field),
    /// From the water between them.
    Water(&'static pores::Profile),
}

impl Profile {
    /// How the file describes it.
    pub fn variable(&self) -> &'static Variable {
        match self {
            Self::Grains(f) => &f.variable,
            Self::Water(p) => &p.variable,
        }
    }

    /// Its values in `frame`, in layers between these `edges` [m].
    pub fn read(&self, frame: &Frame, edges: &[f64]) -> ArrayD<f64> {
        match self {
            Self::Grains(f) => (f.read)(&FieldReading {
                model: &frame.model,
                now: &frame.snapshot,
                edges,
            }),
            Self::Water(p) => {
                let dry = || vec![f64::NAN; edges.len() - 1];
                let water = frame.water.as_ref();
                let values = water.map_or_else(dry, |water| (p.read)(water, edges));
                Array1::from_vec(values).into_dyn()
            }
        }
    }
}

/// All variables of `profiles.nc`, of grains that are `wet` or dry.
pub fn profiles(wet: bool) -> impl Iterator<Item = Profile> {
    let water = pores::PROFILES.iter().filter(move |_| wet);
    let grains = PROFILES.iter().map(Profile::Grains);
    grains.chain(water.map(Profile::Water))
}

/// All variables of `series.nc` of dry grains; those of [`PROGRESS`] are always written.
pub fn series() -> impl Iterator<Item = Series> {
    let protocol = PROGRESS.iter().chain(PROTOCOL).map(Series::Protocol);
    protocol.chain(SERIES.iter().map(Series::Grains))
}

/// The same with water between the grains.
pub fn wet_series() -> impl Iterator<Item = Series> {
    series().chain(SCALARS.iter().map(Series::Water))
}

/// Names of all variables of a file with water between the grains.
pub fn wet_names(kind: FileKind) -> Vec<&'static str> {
    match kind {
        FileKind::Series => wet_series().map(|series| series.variable().name).collect(),
        FileKind::Profiles => profiles(true).map(|p| p.variable().name).collect(),
        FileKind::Fluid => pores::FIELDS.iter().map(|f| f.variable.name).collect(),
        FileKind::Grains | FileKind::Contacts => names(kind),
    }
}

/// Names of all variables of a file of dry grains.
pub fn names(kind: FileKind) -> Vec<&'static str> {
    let of = |fields: &[Field]| fields.iter().map(|field| field.variable.name).collect();
    match kind {
        FileKind::Series => series().map(|series| series.variable().name).collect(),
        FileKind::Profiles => profiles(false).map(|p| p.variable().name).collect(),
        FileKind::Grains => of(GRAINS),
        FileKind::Contacts => of(CONTACTS),
        // There is none: of water alone, see `super::fluid`.
        FileKind::Fluid => Vec::new(),
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
