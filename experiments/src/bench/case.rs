//! The cases that esker runs: the packing under the poster's law, sheared between two layers.

use super::Length;
use super::packing::{HEIGHT, Packing};
use super::poster::Poster;
use super::report::Sample;
use anyhow::Result;
use dem::contact::Linear;
use dem::{
    Body, Constraint, ContactLaw, Domain, Drive, Grains, Horizontal, Model, Solver, State, Surface,
    Wall, WallMotion, WallState,
};
use glam::DVec3;
use std::time::Instant;

/// Grains whose centres are nearer to a plane belong to its held or driven layer (m).
pub const LAYER: f64 = 0.013;

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// As in a run of the poster's experiment: friction with history, and the energy ledger.
    Poster,
    /// The same without the ledger.
    PosterNoLedger,
    /// Neither tangential forces nor ledger.
    Frictionless,
}

impl Case {
    /// In the order of a round.
    pub const ALL: [Self; 3] = [Self::Poster, Self::PosterNoLedger, Self::Frictionless];

    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Poster => "poster",
            Self::PosterNoLedger => "poster-no-ledger",
            Self::Frictionless => "frictionless",
        }
    }

    /// Shear `packing` from the start for one measurement.
    pub fn run(
        self,
        poster: &Poster,
        packing: &Packing,
        threads: usize,
        length: Length,
    ) -> Result<Sample> {
        let (model, start) = (self.model(poster, packing), start(poster, packing));
        let mut solver = Solver::new(model, start, threads)?;
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

    fn model(self, poster: &Poster, packing: &Packing) -> Model {
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
                sliding: (self != Self::Frictionless).then_some(poster.sliding),
                ..poster.law
            }),
            walls: vec![plane("bottom", DVec3::Z), plane("top", DVec3::NEG_Z)],
            drive: Some(Drive::Velocity(poster.strain_rate * HEIGHT)),
            step: poster.step,
            skin: None,
            ledger: self == Self::Poster,
        }
    }
}

/// The packing with a linear velocity profile between a held and a driven layer.
fn start(poster: &Poster, packing: &Packing) -> State {
    let mut grains = Grains::default();
    for (&position, &radius) in packing.position.iter().zip(&packing.radius) {
        let k = grains.add_sphere(position, radius, poster.density) as usize;
        let (horizontal, speed) = if position.z < LAYER {
            (Horizontal::Held, 0.0)
        } else if position.z > HEIGHT - LAYER {
            (Horizontal::Driven, poster.strain_rate * HEIGHT)
        } else {
            (Horizontal::Free, poster.strain_rate * position.z)
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
        walls: vec![plane(0.0), plane(-HEIGHT)],
        ..State::default()
    }
}
