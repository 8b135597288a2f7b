//! The normal part of the linear laws: spring and dashpot along the line of centres.
//!
//! F_n = k_n d - γ_n v_n, clipped at zero unless the law keeps tension.
//! Source: Cundall and Strack (1979), Géotechnique 29, 47-65.
//! Twin:   shaders/dem/contact/normal.wgsl
//! Proof:  tests/verification (restitution, contact time)

use super::{ContactLaw, Law, Losses, Memory, Response, Springs, Tension, Touch, Turn};
use crate::lanes::Lanes;

/// Spring and dashpot; also the whole law of frictionless grains and walls.
#[derive(Clone, Copy)]
pub(crate) struct Normal {
    stiffness: f64,
    damping: f64,
    /// Smallest force allowed: zero where tension is clipped, else minus infinity.
    floor: f64,
}

impl Normal {
    /// F_n [N].
    #[inline(always)]
    pub fn force<V: Lanes>(&self, touch: &Touch<V>) -> V {
        let spring = V::splat(self.stiffness) * touch.overlap;
        V::splat(self.damping)
            .neg_mul_add(touch.separation, spring)
            .max(V::splat(self.floor))
    }

    /// Energy taken by the dashpot over the last drift [J]: the mean of its force before
    /// and after, F - k d, times the way. `before` is the normal force of the last step.
    #[inline(always)]
    pub fn loss<V: Lanes>(&self, touch: &Touch<V>, before: V, after: V, step: V) -> V {
        let way = touch.separation * step;
        let overlap_before = (touch.overlap + way).max(V::splat(0.0));
        let k = V::splat(self.stiffness);
        let dashpots = k.neg_mul_add(touch.overlap + overlap_before, before + after);
        V::splat(-0.5) * way * dashpots
    }
}

impl Law for Normal {
    const SLIDES: bool = false;
    const TURNS: bool = false;

    fn of(law: &ContactLaw) -> Self {
        let clipped = match law {
            ContactLaw::Linear(law) => law.tension == Tension::Clip,
            ContactLaw::LinearLammps(_) => false,
        };
        Self {
            stiffness: law.normal_stiffness(),
            damping: law.normal_damping(),
            floor: if clipped { 0.0 } else { f64::NEG_INFINITY },
        }
    }

    #[inline(always)]
    fn velocity_arm<V: Lanes>(radius: V, _overlap: V) -> V {
        radius
    }

    #[inline(always)]
    fn torque_arm<V: Lanes, const WALL: bool>(radius: V, _overlap: V) -> V {
        radius
    }

    #[inline(always)]
    fn respond<V: Lanes>(
        &self,
        touch: &Touch<V>,
        _turn: &Turn<V>,
        _springs: &Springs<V>,
        _step: V,
    ) -> Response<V> {
        Response {
            normal: self.force(touch),
            ..Response::none()
        }
    }

    #[inline(always)]
    fn losses<V: Lanes>(
        &self,
        touch: &Touch<V>,
        _turn: &Turn<V>,
        before: &Memory<V>,
        after: &Response<V>,
        step: V,
    ) -> Losses<V> {
        let pushed = before.force.dot(touch.normal);
        Losses {
            viscosity: self.loss(touch, pushed, after.normal, step),
            ..Losses::none()
        }
    }
}
