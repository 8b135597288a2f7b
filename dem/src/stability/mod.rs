//! What the numbers imply before a step is made: the largest stable step, and collisions.
//!
//! **One oscillator.** The solver evaluates forces at x_n with the velocity of half a step
//! before, so x'' = -ω² x - c x' becomes
//!
//! > v⁺ = v⁻ + h (-ω² x - c v⁻),  x⁺ = x + h v⁺.
//!
//! Its matrix has trace 2 - a - b and determinant 1 - b with a = ω² h², b = c h. Both
//! eigenvalues stay inside the unit circle if and only if |trace| < 1 + determinant and
//! |determinant| < 1, that is a + 2 b < 4: the dashpot costs step, since it looks back.
//! Without it this is the well-known h < 2/ω.
//!
//! **A bed.** With M, K, C the matrices of mass, springs and dashpots, a mode φ with
//! multiplier λ obeys λ² - (2 - a - b) λ + 1 - b = 0 with a = h² φ*Kφ/φ*Mφ and
//! b = h φ*Cφ/φ*Mφ: the same condition, so h² K + 2 h C ≤ 4 M is enough. Each contact adds
//! s = h² k + 2 h γ along the normal (s_n), along both tangents (s_t), and for rolling and
//! twisting. As (u_i - u_j)² ≤ 2 u_i² + 2 u_j², the left side is at most twice that of every
//! grain in a cage of neighbours at rest. A cage of Z contacts in all directions has
//! Σ n n = Z/3 and Σ (1 - n n) = 2 Z/3 along any axis, hence
//!
//! > translation: 2 (Z/3 s_n + 2Z/3 s_t) / m ≤ 4
//! >
//! > rotation: 2 (2Z/3 s_t + Z/3 s_r + Z/6 s_w) R²/I ≤ 4,  R²/I = 5/(2m) for a solid sphere
//!
//! (rolling and twisting act over R*, and R*² (1/I_i + 1/I_j) ≤ R_i²/I_i for the smaller
//! grain). Z is the kissing number 12, the most spheres of one size that can touch another.
//! A crystal of the lightest grains reaches both bounds: (8 k_n + 16 k_t)/m from above,
//! 40 k_t/m exactly, by all grains turning in step. Fewer contacts on one side couple
//! translation and rotation, one contact to 1/m + R²/I = 7/(2m), but stay below them up to
//! six contacts. Larger grains gain mass faster than contacts; a contact with a wall at rest
//! counts half. Constraints only lower the left side.
//!
//! Source: O'Sullivan and Bray (2004), Eng. Comput. 21, 278, for modes of assemblies with
//! rotation.
//! Proof: tests/verification/stability.rs

mod collision;

pub use collision::{
    PHASES, Scatter, contact_time, damping_for, restitution, restitution_scatter, steps_per_contact,
};

use crate::contact::{ContactLaw, Linear, LinearLammps};
use crate::{Grains, Model, StressLoad, WallMotion};

/// Contacts that may hold the lightest grain at once: the kissing number of equal spheres.
const CONTACTS: f64 = 12.0;

/// [`default_step`] as a fraction of [`stable_step`].
///
/// Stability is not accuracy: with k_t = 2/7 k_n and weak damping a collision of the
/// two lightest grains lasts four stable steps, and twenty default steps.
const DEFAULT_FRACTION: f64 = 0.2;

/// A spring k [N/m] beside a dashpot γ [N s/m], or sums of such.
#[derive(Clone, Copy, Default)]
struct Pair {
    spring: f64,
    dashpot: f64,
}

impl Pair {
    /// `self + factor * other`
    fn plus(self, factor: f64, other: Self) -> Self {
        Self {
            spring: self.spring + factor * other.spring,
            dashpot: self.dashpot + factor * other.dashpot,
        }
    }

    /// Largest step h with h² k + 2 h γ ≤ 4 `inertia` [s]; infinite without spring and dashpot.
    fn limit(self, inertia: f64) -> f64 {
        let (a, c) = (self.spring / inertia, self.dashpot / inertia);
        4.0 / (c + (c * c + 4.0 * a).sqrt())
    }
}

/// Springs and dashpots of one contact.
#[derive(Default)]
struct Couplings {
    normal: Pair,
    tangential: Pair,
    rolling: Pair,
    twisting: Pair,
}

impl From<&ContactLaw> for Couplings {
    fn from(law: &ContactLaw) -> Self {
        let pair = |spring, dashpot| Pair { spring, dashpot };
        match law {
            ContactLaw::Linear(Linear {
                normal_stiffness,
                normal_damping,
                tension: _,
                sliding,
                rolling,
                twisting,
            }) => Self {
                normal: pair(*normal_stiffness, *normal_damping),
                tangential: sliding.map_or_else(Pair::default, |s| pair(s.stiffness, s.damping)),
                rolling: rolling.map_or_else(Pair::default, |t| pair(t.stiffness, t.damping)),
                twisting: twisting.map_or_else(Pair::default, |t| pair(t.stiffness, t.damping)),
            },
            ContactLaw::LinearLammps(LinearLammps {
                normal_stiffness,
                normal_damping,
                tangential_stiffness,
                tangential_damping,
                friction: _,
            }) => Self {
                normal: pair(*normal_stiffness, *normal_damping),
                tangential: pair(*tangential_stiffness, *tangential_damping),
                ..Self::default()
            },
        }
    }
}

/// Largest time step [s] that is stable for any bed of these grains, whatever touches what:
/// the lightest grain held by twelve contacts, and a wall under stress held by all grains
/// that find room on it. Infinite if nothing pushes.
///
/// The module tells how it is derived, and why twelve.
pub fn stable_step(model: &Model, grains: &Grains) -> f64 {
    let contact = Couplings::from(&model.law);
    let none = Pair::default();
    let translation = none
        .plus(2.0 * CONTACTS / 3.0, contact.normal)
        .plus(4.0 * CONTACTS / 3.0, contact.tangential);
    let rotation = none
        .plus(4.0 * CONTACTS / 3.0, contact.tangential)
        .plus(2.0 * CONTACTS / 3.0, contact.rolling)
        .plus(CONTACTS / 3.0, contact.twisting);

    let of_grain = |k: usize| {
        let inertia = grains.moment_of_inertia[k] / grains.radius[k].powi(2);
        translation
            .limit(grains.mass[k])
            .min(rotation.limit(inertia))
    };
    let of_wall = |load: &StressLoad| {
        let side_by_side = grains_side_by_side(&grains.radius, load.area);
        let held = Pair {
            spring: 0.0,
            dashpot: load.damping,
        };
        held.plus(2.0 * side_by_side, contact.normal)
            .limit(load.mass)
    };
    let grain_limits = (0..grains.len()).map(of_grain);
    let wall_limits = model.walls.iter().filter_map(|wall| match &wall.motion {
        WallMotion::Stress(load) => Some(of_wall(load)),
        WallMotion::Held | WallMotion::Velocity(_) => None,
    });
    grain_limits
        .chain(wall_limits)
        .fold(f64::INFINITY, f64::min)
}

/// Default time step [s]: a fifth of [`stable_step`].
pub fn default_step(model: &Model, grains: &Grains) -> f64 {
    DEFAULT_FRACTION * stable_step(model, grains)
}

/// How many grains can touch a plane of `area` [m²] at once, at most: the smallest first,
/// each on the 2√3 R² that it takes in the densest layer.
fn grains_side_by_side(radius: &[f64], area: f64) -> f64 {
    let mut radius = radius.to_vec();
    radius.sort_by(f64::total_cmp);
    let mut free = area;
    let fits = radius.iter().take_while(|r| {
        free -= 2.0 * 3.0_f64.sqrt() * r.powi(2);
        free > 0.0
    });
    // One more may reach in over the edge.
    (fits.count() + 1).min(radius.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Sliding, Tension, Turning};
    use crate::{Domain, Surface, Wall};
    use approx::assert_relative_eq;
    use glam::DVec3;

    /// The poster's law and step.
    fn poster() -> Model {
        Model {
            domain: Domain {
                size: [0.2, 0.2],
                periodic: [true, true],
            },
            gravity: DVec3::ZERO,
            law: ContactLaw::Linear(Linear {
                normal_stiffness: 1e9,
                normal_damping: 780.0,
                tension: Tension::Clip,
                sliding: Some(Sliding {
                    stiffness: 1e8,
                    damping: 780.0,
                    friction_static: 0.58,
                    friction_dynamic: 0.47,
                }),
                rolling: None,
                twisting: None,
            }),
            walls: vec![],
            drive: None,
            step: 6.60e-7,
            skin: None,
            ledger: false,
        }
    }

    fn one_grain(radius: f64) -> Grains {
        let mut grains = Grains::default();
        grains.add_sphere(DVec3::ZERO, radius, 3600.0);
        grains
    }

    fn linear(model: &mut Model) -> &mut Linear {
        match &mut model.law {
            ContactLaw::Linear(law) => law,
            ContactLaw::LinearLammps(_) => unreachable!("the poster's law is linear"),
        }
    }

    fn turning(stiffness: f64, damping: f64) -> Option<Turning> {
        Some(Turning {
            stiffness,
            damping,
            friction: 0.1,
        })
    }

    #[test]
    fn the_posters_step_is_stable_down_to_a_radius_of_8_93_mm() {
        let model = poster();
        assert!(stable_step(&model, &one_grain(8.93e-3)) > model.step);
        assert!(stable_step(&model, &one_grain(8.92e-3)) < model.step);
    }

    #[test]
    fn the_lightest_grain_sets_the_step() {
        let model = poster();
        let mut grains = one_grain(1e-2);
        let alone = stable_step(&model, &grains);
        grains.add_sphere(DVec3::X, 2e-2, 3600.0);
        assert_eq!(stable_step(&model, &grains), alone);
        grains.add_sphere(DVec3::Y, 5e-3, 3600.0);
        assert!(stable_step(&model, &grains) < alone);
        assert_relative_eq!(
            default_step(&model, &grains),
            0.2 * stable_step(&model, &grains)
        );
    }

    #[test]
    fn without_dashpots_the_limit_is_two_over_the_highest_frequency() {
        let mut model = poster();
        let grains = one_grain(1e-2);
        let law = linear(&mut model);
        law.normal_damping = 0.0;
        law.sliding = None;
        let crystal = (8.0 * 1e9 / grains.mass[0]).sqrt();
        assert_relative_eq!(
            stable_step(&model, &grains),
            2.0 / crystal,
            max_relative = 1e-14
        );
    }

    #[test]
    fn every_spring_and_dashpot_can_bound_the_step() {
        let grains = one_grain(1e-2);
        let free = stable_step(&poster(), &grains);
        let lowered = |change: fn(&mut Linear)| {
            let mut model = poster();
            change(linear(&mut model));
            stable_step(&model, &grains) < 0.9 * free
        };
        assert!(lowered(|law| law.normal_stiffness *= 100.0));
        assert!(lowered(|law| law.normal_damping *= 100.0));
        assert!(lowered(
            |law| law.sliding.as_mut().unwrap().stiffness *= 100.0
        ));
        assert!(lowered(|law| law.sliding.as_mut().unwrap().damping *= 100.0));
        assert!(lowered(|law| law.rolling = turning(1e10, 0.0)));
        assert!(lowered(|law| law.rolling = turning(0.0, 1e4)));
        assert!(lowered(|law| law.twisting = turning(1e10, 0.0)));
        assert!(lowered(|law| law.twisting = turning(0.0, 1e4)));
    }

    #[test]
    fn a_light_wall_under_stress_bounds_the_step() {
        let mut model = poster();
        let grains = one_grain(1e-2);
        let free = stable_step(&model, &grains);
        let load = StressLoad {
            mean: 1e5,
            amplitude: 0.0,
            frequency: 0.0,
            area: 0.04,
            mass: 1.0,
            damping: 0.0,
        };
        let wall = |load| Wall {
            name: "top".into(),
            normal: -DVec3::Z,
            surface: Surface::Frictionless,
            motion: WallMotion::Stress(load),
        };
        model.walls = vec![wall(load)];
        assert_eq!(stable_step(&model, &grains), free);
        model.walls = vec![wall(StressLoad { mass: 1e-5, ..load })];
        assert!(stable_step(&model, &grains) < 0.1 * free);
        model.walls = vec![wall(StressLoad {
            damping: 1e8,
            ..load
        })];
        assert!(stable_step(&model, &grains) < 0.1 * free);
    }

    #[test]
    fn a_layer_holds_as_many_grains_as_its_densest_packing() {
        let cell = 2.0 * 3.0_f64.sqrt();
        assert_eq!(grains_side_by_side(&[1.0; 1000], 99.5 * cell), 100.0);
        assert_eq!(grains_side_by_side(&[1.0, 1.0], 1000.0), 2.0);
    }

    #[test]
    fn nothing_to_push_allows_any_step() {
        assert_eq!(stable_step(&poster(), &Grains::default()), f64::INFINITY);
    }
}
