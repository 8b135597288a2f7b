//! Linear spring-dashpot contact with static and dynamic friction, the poster's law.
//!
//! Normal:     F_n = k_n d - γ_n v_n, never attractive unless tension is kept.
//! Tangential: the spring ξ is projected on the contact plane of the moment and grows by
//!             the surface velocity u dt; trial force f* = -k_t ξ - γ_t u.
//!             Sticking contacts slide when |f*| > μ_s F_n, sliding ones until
//!             |f*| <= μ_d F_n. A sliding contact carries f = μ_d F_n f*/|f*|, and its
//!             spring is reset to -(f + γ_t u)/k_t, so that both together give the limit.
//! Arms:       R - d/2, in the surface velocity and in the torque: they add up to the
//!             distance, so that angular momentum and work are exact.
//! Source:     Luding (2008), Granular Matter 10, 235-246, section 2.3.
//! Differs from `sphere`, whose force at the moment of slip is the static limit.
//! Projection alone is enough to carry the spring: it shortens ξ by the square of the
//! rotation in a step, which vanishes with the step.
//! Twin:       shaders/dem/contact/linear.wgsl
//! Proof:      tests/verification (friction, impacts, ledger)

use super::turning::{self, Turning};
use super::{ContactLaw, Law, Losses, Memory, Normal, Response, Springs, Touch, Turn};
use crate::lanes::{Lanes, V3};

/// The description of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Normal stiffness k_n [N/m].
    pub normal_stiffness: f64,
    /// Normal damping γ_n [N s/m].
    pub normal_damping: f64,
    /// May the dashpot pull?
    pub tension: Tension,
    /// Tangential spring and friction; none: frictionless grains.
    pub sliding: Option<Sliding>,
    /// Rolling resistance.
    pub rolling: Option<Turning>,
    /// Twisting resistance.
    pub twisting: Option<Turning>,
}

/// What becomes of a normal force that would pull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tension {
    /// Clipped at zero.
    #[default]
    Clip,
    /// Kept until the grains part.
    Keep,
}

/// Tangential spring, dashpot and slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Tangential stiffness k_t [N/m].
    pub stiffness: f64,
    /// Tangential damping γ_t [N s/m].
    pub damping: f64,
    /// Static friction coefficient μ_s: the limit of a contact that sticks.
    pub friction_static: f64,
    /// Dynamic friction coefficient μ_d: the limit once it slides; at most μ_s.
    pub friction_dynamic: f64,
}

/// The law with friction; `TURNS` adds rolling and twisting resistance.
#[derive(Clone, Copy)]
pub(crate) struct Frictional<const TURNS: bool> {
    normal: Normal,
    stiffness: f64,
    compliance: f64,
    damping: f64,
    friction_static: f64,
    friction_dynamic: f64,
    rolling: Turning,
    twisting: Turning,
}

impl<const TURNING: bool> Law for Frictional<TURNING> {
    const SLIDES: bool = true;
    const TURNS: bool = TURNING;

    fn of(law: &ContactLaw) -> Self {
        let (sliding, rolling, twisting) = match law {
            ContactLaw::Linear(law) => (law.sliding, law.rolling, law.twisting),
            ContactLaw::LinearLammps(_) => (None, None, None),
        };
        let sliding = sliding.expect("the kernel with friction runs only scenes that have it");
        Self {
            normal: Normal::of(law),
            stiffness: sliding.stiffness,
            compliance: 1.0 / sliding.stiffness,
            damping: sliding.damping,
            friction_static: sliding.friction_static,
            friction_dynamic: sliding.friction_dynamic,
            rolling: rolling.unwrap_or(Turning::NONE),
            twisting: twisting.unwrap_or(Turning::NONE),
        }
    }

    #[inline(always)]
    fn velocity_arm<V: Lanes>(radius: V, overlap: V) -> V {
        V::splat(0.5).neg_mul_add(overlap, radius)
    }

    #[inline(always)]
    fn torque_arm<V: Lanes, const WALL: bool>(radius: V, overlap: V) -> V {
        V::splat(0.5).neg_mul_add(overlap, radius)
    }

    #[inline(always)]
    fn respond<V: Lanes>(
        &self,
        touch: &Touch<V>,
        turn: &Turn<V>,
        springs: &Springs<V>,
        step: V,
    ) -> Response<V> {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let (n, u) = (touch.normal, touch.slip);
        let (k_t, gamma_t) = (V::splat(self.stiffness), V::splat(self.damping));

        let normal = self.normal.force(touch);
        let pressing = normal.max(zero);

        let old = springs.tangential;
        let carried = old.minus(old.dot(n), n);
        let stretched = carried.plus(step, u);
        let dashpot = u.scale(zero - gamma_t);
        let trial = dashpot.minus(k_t, stretched);

        let was_sliding = springs.sliding.greater(V::splat(0.5));
        let dynamic_limit = V::splat(self.friction_dynamic) * pressing;
        let static_limit = V::splat(self.friction_static) * pressing;
        let limit = V::select(was_sliding, dynamic_limit, static_limit);
        let trial_squared = trial.dot(trial);
        let slides = trial_squared.greater(limit * limit);
        let cut = V::select(slides, dynamic_limit / trial_squared.sqrt(), one);
        let tangential = trial.scale(cut);
        let relaxed = dashpot
            .minus(one, tangential)
            .scale(V::splat(self.compliance));

        let mut response = Response {
            normal,
            tangential,
            couple: V3::zero(),
            springs: Springs {
                tangential: V3::select(slides, relaxed, stretched),
                sliding: touch.closed.keep(slides),
                ..*springs
            },
        };
        if TURNING {
            let resistance = (&self.rolling, &self.twisting);
            turning::resist(
                resistance,
                touch.normal,
                turn,
                pressing,
                step,
                &mut response,
            );
        }
        response
    }

    #[inline(always)]
    fn losses<V: Lanes>(
        &self,
        touch: &Touch<V>,
        turn: &Turn<V>,
        before: &Memory<V>,
        after: &Response<V>,
        step: V,
    ) -> Losses<V> {
        let k_t = V::splat(self.stiffness);
        let mut losses = Losses::of_sliding(&self.normal, k_t, touch, before, after, step);
        if TURNING {
            let resistance = (&self.rolling, &self.twisting);
            losses.rolling = turning::loss(resistance, turn, before, after, step);
        }
        losses
    }
}
