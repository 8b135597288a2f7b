//! The numbers of a ready-made experiment, from its scene.

use crate::ready;
use crate::scene::{Document, Scene, Shear};
use anyhow::{Context, Result, bail};
use dem::ContactLaw;
use dem::contact::{Linear, Sliding};
use std::path::Path;

/// What a bench shares with an experiment, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// How grains push each other.
    pub law: Linear,
    /// Its tangential part.
    pub sliding: Sliding,
    /// Time step [s].
    pub step: f64,
    /// Strain rate of the shear [1/s].
    pub strain_rate: f64,
    /// Density of the grains [kg/m³].
    pub density: f64,
}

impl Numbers {
    /// Read the scene of the experiment `name`.
    ///
    /// # Errors
    /// A scene that is no shear of grains with friction any more.
    pub fn of(name: &str) -> Result<Self> {
        let text = ready::find(name).context("it is ready-made")?.scene();
        let scene = Scene::read(&Document::new(name, Path::new("."), text, &[])?)?;
        let sheared = scene.phases.iter().find_map(|phase| match phase.shear {
            Some(Shear::StrainRate(rate)) => Some((phase.law, rate)),
            _ => None,
        });
        let Some((ContactLaw::Linear(law), strain_rate)) = sheared else {
            bail!("{name} has no shear at a strain rate under the law linear");
        };
        Ok(Self {
            law,
            sliding: law
                .sliding
                .with_context(|| format!("{name} has no friction"))?,
            step: scene.step,
            strain_rate,
            density: dem::measure::grain_density(&scene.start.grains),
        })
    }
}
