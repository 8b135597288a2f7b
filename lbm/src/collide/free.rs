//! Free water in the incompressible limit.
//!
//! f_i^eq = w_i [3 P + 3 c·u + 9/2 (c·u)² - 3/2 u²],   P = Σf / 3,   u = Σcf + F/2
//!
//! Pressure P and velocity u in lattice units; the density is 1 and does not vary with P.
//! The waves of P are numerical: flow must be slow against them (Mach number), the pressure
//! then is that of incompressible flow. Without inertia (Stokes flow) the squares are left out.
//!
//! Holds for |u| ≪ 1/√3 and ν = (1/ω⁺ - 1/2)/3. With a force F the even part also gets
//! (1 - ω⁺/2) w [9 (c·u)(c·F) - 3 u·F], as it should for the stress to be right.
//! Source: He and Luo (1997), J. Stat. Phys. 88, 927.
//! Twin: shaders/lbm/collide/free.wgsl. Proof: lbm/tests/verification/free.rs

use super::{
    Cell, Coefficients, Law, Moments, first_order, forced, odd_part, relaxed, second_order, sums,
};
use crate::lanes::{Lanes, Real};

/// With the squares of the velocity, or not; with a body force, or not.
pub(crate) struct Free<const INERTIA: bool, const FORCE: bool>;

impl<T: Real, const INERTIA: bool, const FORCE: bool> Law<T> for Free<INERTIA, FORCE> {
    #[inline(always)]
    unsafe fn collide<V: Lanes<T>>(k: &Coefficients<T>, _: usize, cell: Cell<V>) -> Cell<V> {
        let of = |x: f64| V::splat(T::of(x));
        let (moving, momentum, s, d) = sums(&cell);
        let omega = V::splat(k.omega_even);
        let pressure = (cell.rest + moving) * of(1.0 / 3.0);
        let u = velocity::<T, V, FORCE>(k, momentum);
        let g = odd_part(k, u, momentum);

        let three_p = of(3.0) * omega * pressure;
        // The rest population gives what the moving ones get beyond what they lose.
        let lost = omega.mul_add(moving, cell.rest);
        if !INERTIA {
            let (even, got) = first_order(three_p);
            return relaxed(k, lost - got, s, d, even, g);
        }
        let mut v = u;
        for axis in 0..3 {
            v[axis] = of(4.5) * omega * u[axis];
            if FORCE {
                let weight = of(18.0) - of(9.0) * omega;
                v[axis] = weight.mul_add(V::splat(k.half_force[axis]), v[axis]);
            }
        }
        let (even, got) = second_order(three_p, u, v);
        relaxed(k, lost - got, s, d, even, g)
    }

    #[inline(always)]
    unsafe fn moments<V: Lanes<T>>(k: &Coefficients<T>, _: usize, cell: &Cell<V>) -> Moments<V> {
        let (moving, momentum, _, _) = sums(cell);
        Moments {
            pressure: (cell.rest + moving) * V::splat(T::of(1.0 / 3.0)),
            flux: velocity::<T, V, FORCE>(k, momentum),
        }
    }
}

/// u = Σcf + F/2
#[inline(always)]
fn velocity<T: Real, V: Lanes<T>, const FORCE: bool>(
    k: &Coefficients<T>,
    momentum: [V; 3],
) -> [V; 3] {
    if FORCE { forced(k, momentum) } else { momentum }
}
