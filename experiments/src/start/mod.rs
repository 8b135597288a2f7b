//! The state from which a run starts.

mod loose;
mod radii;

pub use loose::FRACTION as LOOSE_FRACTION;
pub use radii::RadiusLaw;

use crate::bed::Bed;
use crate::output::state::Saved;
use dem::{Grains, State, WallState};
use glam::DVec3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Where the grains come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Thrown in at random, without contacts.
    Loose {
        /// Number of grains.
        count: usize,
        /// Their sizes.
        law: RadiusLaw,
        /// Their density [kg/m³].
        density: f64,
        /// The part of the room that they fill at first.
        fraction: f64,
    },
    /// Places and sizes from a file.
    Bed {
        /// The bed as it was read.
        bed: Bed,
        /// Density of its grains [kg/m³].
        density: f64,
    },
    /// Everything from a file, contacts with their history too.
    State(Box<Saved>),
}

impl Source {
    /// The grains; those of a loose start are all at the origin, until [`Source::place`].
    pub fn grains(&self, seed: u64) -> Grains {
        match self {
            Self::Loose {
                count,
                law,
                density,
                ..
            } => {
                let mut grains = Grains::default();
                for radius in law.draw(*count, &mut ChaCha8Rng::seed_from_u64(seed)) {
                    grains.add_sphere(DVec3::ZERO, radius, *density);
                }
                grains
            }
            Self::Bed { bed, density } => {
                let mut grains = Grains::default();
                // The bed stands on the bottom wall, wherever its file put it.
                let low = bed.position.iter().zip(&bed.radius).map(|(p, r)| p.z - r);
                let low = low.fold(f64::INFINITY, f64::min);
                for (position, radius) in bed.position.iter().zip(&bed.radius) {
                    grains.add_sphere(*position - low * DVec3::Z, *radius, *density);
                }
                if let Some(velocity) = &bed.velocity {
                    grains.velocity.clone_from(velocity);
                }
                if let Some(spin) = &bed.angular_velocity {
                    grains.angular_velocity.clone_from(spin);
                }
                grains
            }
            Self::State(saved) => saved.state.grains.clone(),
        }
    }

    /// The state in which all is placed: `grains` as [`Source::grains`] gave them, and the
    /// walls of the [protocol](crate::protocol). The top wall is at `height` [m], or just
    /// above the grains.
    ///
    /// # Errors
    /// Grains outside the box, and what else a user can mend.
    pub fn place(
        &self,
        mut grains: Grains,
        domain: &dem::Domain,
        height: Option<f64>,
        seed: u64,
    ) -> Result<State, String> {
        if let Self::State(saved) = self {
            return Ok(saved.state.clone());
        }
        if let Self::Loose { fraction, .. } = self {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            // Radii took stream 0.
            random.set_stream(1);
            grains.position = loose::place(&grains.radius, domain, *fraction, &mut random);
        }
        wrap(&mut grains, domain);
        check_inside(&grains, domain)?;
        if let Self::Bed { bed, .. } = self {
            bed.check_packing(domain)
                .map_err(|error| error.to_string())?;
        }
        let top = highest(&grains);
        let height = height.unwrap_or(top);
        // A settled bed overlaps its wall a little.
        if top > height + 0.1 * grains.mean_radius() {
            return Err(format!(
                "the grains need a height of {top:.4} m and the box has {height:.4} m; make it \
                 higher, or leave the third length out"
            ));
        }
        Ok(State {
            time: 0.0,
            grains,
            contacts: Vec::new(),
            walls: walls_at(domain, height),
        })
    }
}

/// Upper end of the highest grain [m].
pub fn highest(grains: &Grains) -> f64 {
    let tops = grains.position.iter().zip(&grains.radius);
    tops.map(|(p, r)| p.z + r).fold(0.0, f64::max)
}

/// Walls at rest, in the order of the model of a [protocol](crate::protocol).
fn walls_at(domain: &dem::Domain, height: f64) -> Vec<WallState> {
    let at = |offset| WallState {
        offset,
        velocity: 0.0,
    };
    let mut walls = vec![at(0.0), at(-height)];
    for side in 0..2 {
        if !domain.periodic[side] {
            walls.extend([at(0.0), at(-domain.size[side])]);
        }
    }
    walls
}

fn wrap(grains: &mut Grains, domain: &dem::Domain) {
    for position in &mut grains.position {
        for side in 0..2 {
            if domain.periodic[side] {
                let length = domain.size[side];
                let x = position[side].rem_euclid(length);
                // A tiny negative number wraps to the length itself.
                position[side] = if x < length { x } else { 0.0 };
            }
        }
    }
}

/// Along periodic sides every place is inside: a grain may have crossed since it was
/// wrapped.
fn check_inside(grains: &Grains, domain: &dem::Domain) -> Result<(), String> {
    for (k, p) in grains.position.iter().enumerate() {
        // Walls are soft: a grain may overlap one, but its centre is inside.
        let outside =
            |side: usize| !domain.periodic[side] && !(0.0..=domain.size[side]).contains(&p[side]);
        if !p.is_finite() || outside(0) || outside(1) {
            return Err(format!(
                "grain {k} at ({:.4}, {:.4}, {:.4}) m is outside of the box; write the size of \
                 the box that the bed was made in",
                p.x, p.y, p.z
            ));
        }
    }
    Ok(())
}
