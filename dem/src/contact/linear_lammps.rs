//! The linear law exactly as LAMMPS' `pair_style granular` computes it: `hooke` with
//! `damping velocity` and `tangential linear_history`, for comparing trajectories.
//!
//! It differs from `linear` in these points: the normal force may pull; the surface
//! velocity has the full radii as arms; the limit is μ |F_n|, one coefficient, no memory
//! of sliding; the spring is projected only where k_t |ξ·n| > 1e-10 of the limit and then
//! regains its length; the torque's arm at a wall is R. So its ledger closes only to the
//! ratio of overlap and radius.
//! Source: LAMMPS 29 Sep 2021, `pair_style granular`; written from its documentation and
//! from trajectories.
//! Twin:   shaders/dem/contact/linear_lammps.wgsl
//! Proof:  tests/verification/lammps/

use super::{ContactLaw, Law, Losses, Memory, Normal, Response, Springs, Touch, Turn};
use crate::lanes::{Lanes, V3};

/// The description of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearLammps {
    /// Normal stiffness k_n [N/m].
    pub normal_stiffness: f64,
    /// Normal damping γ_n [N s/m].
    pub normal_damping: f64,
    /// Tangential stiffness k_t [N/m].
    pub tangential_stiffness: f64,
    /// Tangential damping γ_t [N s/m].
    pub tangential_damping: f64,
    /// Friction coefficient μ.
    pub friction: f64,
}

/// The law ready for the kernel.
#[derive(Clone, Copy)]
pub(crate) struct Lammps {
    normal: Normal,
    stiffness: f64,
    damping: f64,
    friction: f64,
}

impl Law for Lammps {
    const SLIDES: bool = true;
    const TURNS: bool = false;

    fn of(law: &ContactLaw) -> Self {
        let ContactLaw::LinearLammps(own) = law else {
            unreachable!("the kernel of linear-lammps runs only scenes that choose it")
        };
        Self {
            normal: Normal::of(law),
            stiffness: own.tangential_stiffness,
            damping: own.tangential_damping,
            friction: own.friction,
        }
    }

    #[inline(always)]
    fn velocity_arm<V: Lanes>(radius: V, _overlap: V) -> V {
        radius
    }

    #[inline(always)]
    fn torque_arm<V: Lanes, const WALL: bool>(radius: V, overlap: V) -> V {
        if WALL {
            radius
        } else {
            V::splat(0.5).neg_mul_add(overlap, radius)
        }
    }

    #[inline(always)]
    fn respond<V: Lanes>(
        &self,
        touch: &Touch<V>,
        _turn: &Turn<V>,
        springs: &Springs<V>,
        step: V,
    ) -> Response<V> {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let (n, u) = (touch.normal, touch.slip);
        let (k_t, gamma_t) = (V::splat(self.stiffness), V::splat(self.damping));

        let normal = self.normal.force(touch);
        let limit = V::splat(self.friction) * normal.abs();

        let old = springs.tangential;
        let along = old.dot(n);
        let tilted = (k_t * along.abs()).greater(V::splat(1e-10) * limit);
        let flat = old.minus(along, n);
        let flat_squared = flat.dot(flat);
        let grown = V::select(
            flat_squared.greater(zero),
            (old.dot(old) / flat_squared).sqrt(),
            zero,
        );
        let carried = V3::select(tilted, flat.scale(grown), old);
        let stretched = carried.plus(step, u);
        let trial = V3::zero().minus(k_t, stretched).minus(gamma_t, u);

        let size = trial.dot(trial).sqrt();
        let slides = size.greater(limit);
        // A contact that slides before it has any spring carries no tangential force.
        let loaded = stretched.dot(stretched).greater(zero);
        let cut = V::select(loaded, limit / size, zero);
        let tangential = trial.scale(V::select(slides, cut, one));
        let relaxed = tangential.plus(gamma_t, u).scale(zero - one / k_t);
        let relaxed = V3::select(loaded, relaxed, stretched);

        Response {
            normal,
            tangential,
            couple: V3::zero(),
            springs: Springs {
                tangential: V3::select(slides, relaxed, stretched),
                sliding: touch.closed.keep(slides),
                ..*springs
            },
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
        let k_t = V::splat(self.stiffness);
        Losses::of_sliding(&self.normal, k_t, touch, before, after, step)
    }
}
