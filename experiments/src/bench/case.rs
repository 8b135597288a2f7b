//! The cases that esker runs: a packing under the poster's law, or that of small-shear, sheared
//! between two layers.

use super::Length;
use super::packing::{Packing, Sizes};
use super::report::Sample;
use anyhow::Result;
use dem::contact::{Linear, Sliding, Tension};
use dem::{
    Body, Constraint, ContactLaw, Domain, Drive, Grains, Horizontal, Model, Solver, State, Surface,
    Wall, WallMotion, WallState,
};
use glam::DVec3;
use std::time::Instant;

/// Time step of the poster (s); that of small-shear is ten times longer.
pub const STEP: f64 = 6.6e-7;
/// Strain rate of the poster (1/s).
pub const STRAIN_RATE: f64 = 0.25;
/// Density of the grains (kg/m³).
pub const DENSITY: f64 = 3600.0;

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

    /// Shear `packing` from the start for one measurement.
    pub fn run(self, packing: &Packing, threads: usize, length: Length) -> Result<Sample> {
        let mut solver = Solver::new(self.model(packing), start(packing), threads)?;
        solver.advance(length.warm_up)?;
        let clock = Instant::now();
        solver.advance(length.steps)?;
        let seconds = clock.elapsed().as_secs_f64();

        let contacts = solver.snapshot().state.contacts;
        let pairs = contacts
            .iter()
            .filter(|contact| matches!(contact.j, Body::Grain(_)))
            .count();
        let grains = packing.len() as f64;
        Ok(Sample {
            grain_steps_per_s: grains * length.steps as f64 / seconds,
            coordination_number: 2.0 * pairs as f64 / grains,
            bytes_per_grain: solver.memory() as f64 / grains,
        })
    }

    fn model(self, packing: &Packing) -> Model {
        // The poster's numbers, and those of small-shear: softer, with the same restitution.
        let (stiffness, damping, step) = match self.sizes() {
            Sizes::Poster => (1e9, 780.0, STEP),
            Sizes::One | Sizes::LogNormal => (1e7, 78.0, 10.0 * STEP),
        };
        let friction = Sliding {
            stiffness: 0.1 * stiffness,
            damping,
            friction_static: 0.58,
            friction_dynamic: 0.47,
        };
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
                normal_stiffness: stiffness,
                normal_damping: damping,
                tension: Tension::Clip,
                sliding: (self != Self::Frictionless).then_some(friction),
                rolling: None,
                twisting: None,
            }),
            walls: vec![plane("bottom", DVec3::Z), plane("top", DVec3::NEG_Z)],
            drive: Some(Drive::Velocity(STRAIN_RATE * packing.height)),
            step,
            skin: None,
            ledger: !matches!(self, Self::PosterNoLedger | Self::Frictionless),
        }
    }
}

/// The packing with a linear velocity profile between a held and a driven layer.
fn start(packing: &Packing) -> State {
    let mut grains = Grains::default();
    for (&position, &radius) in packing.position.iter().zip(&packing.radius) {
        let k = grains.add_sphere(position, radius, DENSITY) as usize;
        let (horizontal, speed) = if position.z < packing.layer {
            (Horizontal::Held, 0.0)
        } else if position.z > packing.height - packing.layer {
            (Horizontal::Driven, STRAIN_RATE * packing.height)
        } else {
            (Horizontal::Free, STRAIN_RATE * position.z)
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
