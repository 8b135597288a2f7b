//! Water in a porous bed, compressible or not, at any permeability.
//!
//! f_i^eq = w_i [3 P + 3 c·j + (9/2 (c·j)² - 3/2 j²)/φ]  for the moving populations,
//! f_0^eq = N - Σ of these,   N = Σf + m/2,   P = N / S
//!
//! N is the content of the cell (water beyond that at P = 0), j the flux through it, S its
//! storage, m the source. Storage, and with it the porosity, sits in the rest population
//! alone, and the moving ones carry only pressure: where P is uniform nothing flows, however
//! φ jumps between cells. The source goes into the rest population too.
//!
//! Drag F = -(σ + b |j|) j (Darcy and Forchheimer) and a body force G enter implicitly, in
//! closed form: with n = Σcf + G/2,
//!
//! j = n / (1 + σ/2 + b |j|/2),   |j| = 2 |n| / (a + √(a² + 2 b |n|)),   a = 1 + σ/2
//!
//! which has no limit of stability in σ. Without ∂t and viscous terms j = -∇P/σ for every σ:
//! the first moment relaxes with ω₁ = σ/(1 + σ/2), and (1/ω₁ - 1/2) = 1/σ. Between two cells
//! resistances add, so that layers in series are exact.
//!
//! Cells that are no cubes have one σ along x, y and another one along z.
//!
//! Sources: Guo and Zhao (2002), Phys. Rev. E 66, 036304, for the drag in closed form. The
//! storage in the rest population is a derivation of this project.
//! Twin: shaders/lbm/collide/porous.wgsl. Proof: lbm/tests/verification/porous.rs

use super::{
    Cell, Coefficients, Law, Moments, first_order, forced, odd_part, relaxed, second_order, sums,
};
use crate::lanes::{Lanes, Real};

/// With the squares of the flux, with Forchheimer's drag, with sources, or without them.
pub(crate) struct Porous<const INERTIA: bool, const FORCHHEIMER: bool, const SOURCE: bool>;

impl<T: Real, const INERTIA: bool, const FORCHHEIMER: bool, const SOURCE: bool> Law<T>
    for Porous<INERTIA, FORCHHEIMER, SOURCE>
{
    #[inline(always)]
    unsafe fn collide<V: Lanes<T>>(k: &Coefficients<T>, at: usize, cell: Cell<V>) -> Cell<V> {
        let of = |x: f64| V::splat(T::of(x));
        let (moving, momentum, s, d) = sums(&cell);
        let omega = V::splat(k.omega_even);
        // SAFETY: the caller's promise; the arrays in use have an entry for each place.
        let (inverse_storage, source) = unsafe {
            let source = if SOURCE {
                V::load(k.source.as_ptr().add(at))
            } else {
                of(0.0)
            };
            (V::load(k.inverse_storage.as_ptr().add(at)), source)
        };
        let content = of(0.5).mul_add(source, cell.rest + moving);
        let pressure = content * (inverse_storage * V::splat(k.flatness));
        // SAFETY: as above.
        let j = unsafe { flux::<T, V, FORCHHEIMER>(k, at, momentum) };
        let g = odd_part(k, j, momentum);

        // The rest population gives what the moving ones get beyond what they lose: as an
        // increment, which is far smaller than the content where little diffuses per step.
        let lost = omega.mul_add(moving, source);
        let three_p = of(3.0) * omega * pressure;
        if !INERTIA {
            let (even, got) = first_order(three_p);
            return relaxed(k, cell.rest + (lost - got), s, d, even, g);
        }
        // SAFETY: as above.
        let inverse_porosity = unsafe { V::load(k.inverse_porosity.as_ptr().add(at)) };
        let weight = of(18.0) - of(9.0) * omega;
        let mut v = j;
        for axis in 0..3 {
            let force = weight * (j[axis] - momentum[axis]);
            v[axis] = inverse_porosity * (of(4.5) * omega).mul_add(j[axis], force);
        }
        let (even, got) = second_order(three_p, j, v);
        relaxed(k, cell.rest + (lost - got), s, d, even, g)
    }

    #[inline(always)]
    unsafe fn moments<V: Lanes<T>>(k: &Coefficients<T>, at: usize, cell: &Cell<V>) -> Moments<V> {
        let (moving, momentum, _, _) = sums(cell);
        // SAFETY: the caller's promise.
        unsafe {
            let inverse_storage = V::load(k.inverse_storage.as_ptr().add(at));
            Moments {
                pressure: (cell.rest + moving) * (inverse_storage * V::splat(k.flatness)),
                flux: flux::<T, V, FORCHHEIMER>(k, at, momentum),
            }
        }
    }
}

/// The flux under drag and body force.
///
/// # Safety
/// `at` and the cells behind it are places of the lattice.
#[inline(always)]
unsafe fn flux<T: Real, V: Lanes<T>, const FORCHHEIMER: bool>(
    k: &Coefficients<T>,
    at: usize,
    momentum: [V; 3],
) -> [V; 3] {
    let one = V::splat(T::of(1.0));
    let n = forced(k, momentum);
    // SAFETY: the caller's promise.
    let half_drag = unsafe { V::load(k.half_drag.as_ptr().add(at)) };
    let mut across = half_drag.mul_add(V::splat(k.drag_stretch[0]), one);
    let mut along = half_drag.mul_add(V::splat(k.drag_stretch[1]), one);
    if FORCHHEIMER {
        // Only in cubes: `across` is `along`.
        // SAFETY: the caller's promise.
        let half_b = unsafe { V::load(k.half_forchheimer.as_ptr().add(at)) };
        let speed = super::dot(n, n).sqrt();
        let four_b = V::splat(T::of(4.0)) * half_b;
        let root = along.mul_add(along, four_b * speed).sqrt();
        let extra = half_b * (speed + speed) / (along + root);
        across = across + extra;
        along = along + extra;
    }
    let (across, along) = (one / across, one / along);
    [n[0] * across, n[1] * across, n[2] * along]
}
