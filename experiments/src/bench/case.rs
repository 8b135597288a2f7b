//! The cases that esker runs: a packing under the poster's law, or that of small-shear, sheared
//! between two layers.

use super::Length;
use super::numbers::Numbers;
use super::packing::{Packing, Sizes};
use super::report::Sample;
use anyhow::Result;
use dem::contact::Linear;
use dem::{
    Body, Constraint, ContactLaw, Domain, Drive, Grains, Horizontal, Model, Solver, State, Surface,
    Wall, WallMotion, WallState,
};
use glam::DVec3;
use std::time::Instant;

/// What is sheared.
pub struct Bed {
    /// The grains.
    pub packing: Packing,
    /// How they are sheared: as in the experiment that has such grains.
    pub numbers: Numbers,
}

impl Bed {
    /// `grains` grains of `sizes`.
    ///
    /// # Errors
    /// An experiment that is no shear of grains with friction any more.
    pub fn of(sizes: Sizes, grains: usize) -> Result<Self> {
        let numbers = match sizes {
            Sizes::Poster => Numbers::of("poster-shear")?,
            Sizes::One | Sizes::LogNormal => Numbers::of("small-shear")?,
        };
        Ok(Self {
            packing: Packing::of(sizes, grains),
            numbers,
        })
    }
}

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// As in a run of the poster's experiment: friction with history, and the energy ledger.
    Poster,
    /// The same without the ledger.
    PosterNoLedger,
    /// Neither tangential forces nor ledger.
    Frictionless,
    /// As in a run of small-shear, grains of one size.
    OneSize,
    /// As in a run of small-shear, radii 1:10.
    LogNormal,
}

impl Case {
    /// In the order of a round.
    pub const ALL: [Self; 5] = [
        Self::Poster,
        Self::PosterNoLedger,
        Self::Frictionless,
        Self::OneSize,
        Self::LogNormal,
    ];

    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Poster => "poster",
            Self::PosterNoLedger => "poster-no-ledger",
            Self::Frictionless => "frictionless",
            Self::OneSize => "one-size",
            Self::LogNormal => "log-normal",
        }
    }

    /// The grains that it takes.
    pub fn sizes(self) -> Sizes {
        match self {
            Self::Poster | Self::PosterNoLedger | Self::Frictionless => Sizes::Poster,
            Self::OneSize => Sizes::One,
            Self::LogNormal => Sizes::LogNormal,
        }
    }

    /// Shear `bed` from the start for one measurement.
    pub fn run(self, bed: &Bed, threads: usize, length: Length) -> Result<Sample> {
        let (model, start) = self.start(bed);
        let mut solver = Solver::new(model, start, threads)?;
        solver.advance(length.warm_up)?;
        let clock = Instant::now();
        solver.advance(length.steps)?;
        let seconds = clock.elapsed().as_secs_f64();

        let grains = bed.packing.len() as f64;
        Ok(Sample {
            grain_steps_per_s: grains * length.steps as f64 / seconds,
            coordination_number: Some(coordination_number(&solver.snapshot().state)),
            bytes_per_grain: solver.memory() as f64 / grains,
        })
    }

    /// What acts, and the state to start from.
    pub fn start(self, bed: &Bed) -> (Model, State) {
        (self.model(bed), start(bed))
    }

    fn model(self, bed: &Bed) -> Model {
        let Bed { packing, numbers } = bed;
        let plane = |name: &str, normal| Wall {
            name: name.into(),
            normal,
            surface: Surface::Frictionless,
            motion: WallMotion::Held,
        };
        Model {
            domain: Domain {
                size: packing.size,
                periodic: [true, true],
            },
            gravity: DVec3::ZERO,
            law: ContactLaw::Linear(Linear {
                sliding: (self != Self::Frictionless).then_some(numbers.sliding),
                ..numbers.law
            }),
            walls: vec![plane("bottom", DVec3::Z), plane("top", DVec3::NEG_Z)],
            drive: Some(Drive::Velocity(numbers.strain_rate * packing.height)),
            step: numbers.step,
            skin: None,
            ledger: !matches!(self, Self::PosterNoLedger | Self::Frictionless),
        }
    }
}

/// Mean number of grains that a grain touches.
pub fn coordination_number(state: &State) -> f64 {
    let pairs = state
        .contacts
        .iter()
        .filter(|contact| matches!(contact.j, Body::Grain(_)))
        .count();
    2.0 * pairs as f64 / state.grains.len() as f64
}

/// The packing with a linear velocity profile between a held and a driven layer.
fn start(bed: &Bed) -> State {
    let Bed { packing, numbers } = bed;
    let mut grains = Grains::default();
    for (&position, &radius) in packing.position.iter().zip(&packing.radius) {
        let k = grains.add_sphere(position, radius, numbers.density) as usize;
        let (horizontal, speed) = if position.z < packing.layer {
            (Horizontal::Held, 0.0)
        } else if position.z > packing.height - packing.layer {
            (Horizontal::Driven, numbers.strain_rate * packing.height)
        } else {
            (Horizontal::Free, numbers.strain_rate * position.z)
        };
        grains.velocity[k] = DVec3::X * speed;
        grains.constraint[k] = Constraint {
            horizontal,
            rotation_held: false,
        };
    }
    let plane = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    State {
        grains,
        walls: vec![plane(0.0), plane(-packing.height)],
        ..State::default()
    }
}
