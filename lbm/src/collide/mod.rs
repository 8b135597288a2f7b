//! What happens inside a cell: relaxation towards an equilibrium, one law per file.
//!
//! Two relaxation times (TRT): the even part of the populations relaxes with ω⁺, which is
//! the viscosity, the odd part with ω⁻. With s = f + f̄ and d = f - f̄ of a pair of opposite
//! populations,
//!
//! f, f̄ ← ½(1 - ω⁺) s + ω⁺ e⁺  ±  (½(1 - ω⁻) d + 3 w c·g),   g = 2 j - (2 - ω⁻) Σcf
//!
//! where e⁺ is the even part of the equilibrium and j the flux. The odd term holds the
//! equilibrium 3 w c·j and the force F in the form of Guo, (1 - ω⁻/2) 3 w c·F, at once: the
//! flux is j = Σcf + F/2 whatever the force depends on, so F = 2 (j - Σcf).
//!
//! Sources: Ginzburg, Verhaeghe and d'Humières (2008), Commun. Comput. Phys. 3, 427 (TRT);
//! Guo, Zheng and Shi (2002), Phys. Rev. E 65, 046308 (force).
//! Proof: lbm/tests/verification.

mod coefficients;
mod free;
mod porous;

pub(crate) use free::Free;
pub(crate) use porous::Porous;

use crate::Model;
use crate::lanes::{Lanes, Real};
use crate::lattice::{Direction, PAIRS, W_AXIS, weight};

/// The populations that arrived at a cell, as deviations from rest.
#[derive(Clone, Copy)]
pub(crate) struct Cell<V> {
    pub rest: V,
    /// Along the forward direction of each pair.
    pub forward: [V; PAIRS],
    pub backward: [V; PAIRS],
}

impl<T: Real> Cell<T> {
    /// From the populations of a [`State`](crate::State).
    pub fn of_populations(populations: &[f64; 19]) -> Self {
        let mut next = populations.iter().map(|&f| T::of(f));
        let mut take = || next.next().expect("a cell has 19 populations");
        Self {
            rest: take(),
            forward: [(); PAIRS].map(|()| take()),
            backward: [(); PAIRS].map(|()| take()),
        }
    }

    /// The other way.
    pub fn populations(&self) -> [f64; 19] {
        let mut populations = [self.rest.double(); 19];
        let pairs = self.forward.iter().chain(&self.backward);
        for (to, f) in populations[1..].iter_mut().zip(pairs) {
            *to = f.double();
        }
        populations
    }
}

/// What a cell is told from outside, in lattice units. Arrays have one entry for each place of
/// the lattice, and are empty where the law has no use for them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coefficients<T> {
    pub omega_even: T,
    pub omega_odd: T,
    /// Half the body force.
    pub half_force: [T; 3],
    /// 1 / content of a cube at unit pressure.
    pub inverse_storage: Vec<T>,
    /// The same for cells that are no cubes, over it.
    pub flatness: T,
    /// Half the drag: σ/2.
    pub half_drag: Vec<T>,
    /// By how much the drag is stronger along x, y and along z, for cells that are no cubes.
    pub drag_stretch: [T; 2],
    /// Half the drag at unit speed: b/2.
    pub half_forchheimer: Vec<T>,
    /// 1/φ.
    pub inverse_porosity: Vec<T>,
    /// Content that comes in per step.
    pub source: Vec<T>,
}

/// Pressure and flux of a cell, lattice units.
#[derive(Clone, Copy)]
pub(crate) struct Moments<V> {
    pub pressure: V,
    pub flux: [V; 3],
}

/// A way to relax. `at`: the place of the first of the cells.
pub(crate) trait Law<T: Real>: 'static {
    /// # Safety
    /// `at` and the cells behind it are places of the lattice.
    unsafe fn collide<V: Lanes<T>>(k: &Coefficients<T>, at: usize, cell: Cell<V>) -> Cell<V>;

    /// Pressure and flux between two steps; the source of the step to come is not in them.
    ///
    /// # Safety
    /// As above.
    unsafe fn moments<V: Lanes<T>>(k: &Coefficients<T>, at: usize, cell: &Cell<V>) -> Moments<V>;
}

/// Σ over the moving populations, and Σcf.
#[inline(always)]
fn sums<T: Real, V: Lanes<T>>(cell: &Cell<V>) -> (V, [V; 3], [V; PAIRS], [V; PAIRS]) {
    let (f, b) = (&cell.forward, &cell.backward);
    let mut s = *f;
    let mut d = *f;
    for k in 0..PAIRS {
        s[k] = f[k] + b[k];
        d[k] = f[k] - b[k];
    }
    let moving = ((s[0] + s[1]) + (s[2] + s[3])) + (((s[4] + s[5]) + (s[6] + s[7])) + s[8]);
    let momentum = [
        (d[0] + (d[3] + d[4])) + (d[5] + d[6]),
        (d[1] + (d[3] - d[4])) + (d[7] + d[8]),
        (d[2] + (d[5] - d[6])) + (d[7] - d[8]),
    ];
    (moving, momentum, s, d)
}

/// c · v for the forward directions.
#[inline(always)]
fn project<T: Real, V: Lanes<T>>(v: [V; 3]) -> [V; PAIRS] {
    let [x, y, z] = v;
    [x, y, z, x + y, x - y, x + z, x - z, y + z, y - z]
}

/// v · w
#[inline(always)]
fn dot<T: Real, V: Lanes<T>>(v: [V; 3], w: [V; 3]) -> V {
    v[0].mul_add(w[0], v[1].mul_add(w[1], v[2] * w[2]))
}

/// Σcf + G/2 for the body force G.
#[inline(always)]
fn forced<T: Real, V: Lanes<T>>(k: &Coefficients<T>, momentum: [V; 3]) -> [V; 3] {
    let mut n = momentum;
    for axis in 0..3 {
        n[axis] = momentum[axis] + V::splat(k.half_force[axis]);
    }
    n
}

/// g = 2 j - (2 - ω⁻) Σcf
#[inline(always)]
fn odd_part<T: Real, V: Lanes<T>>(k: &Coefficients<T>, j: [V; 3], momentum: [V; 3]) -> [V; 3] {
    let two = V::splat(T::of(2.0));
    let weight = two - V::splat(k.omega_odd);
    let mut g = j;
    for axis in 0..3 {
        g[axis] = two * j[axis] - weight * momentum[axis];
    }
    g
}

/// The relaxed pairs: `even` is ω⁺ e⁺ of each pair, `g` as above.
#[inline(always)]
fn relaxed<T: Real, V: Lanes<T>>(
    k: &Coefficients<T>,
    rest: V,
    s: [V; PAIRS],
    d: [V; PAIRS],
    even: [V; PAIRS],
    g: [V; 3],
) -> Cell<V> {
    let of = |x: f64| V::splat(T::of(x));
    let half = of(0.5);
    let keep_even = half - half * V::splat(k.omega_even);
    let keep_odd = half - half * V::splat(k.omega_odd);
    // 3 w, the one for the axes and the one for the diagonals.
    let g_axis = [
        of(1.0 / 6.0) * g[0],
        of(1.0 / 6.0) * g[1],
        of(1.0 / 6.0) * g[2],
    ];
    let g_diagonal = [half * g_axis[0], half * g_axis[1], half * g_axis[2]];
    let (axis, diagonal) = (project(g_axis), project(g_diagonal));
    let mut cell = Cell {
        rest,
        forward: even,
        backward: even,
    };
    for pair in 0..PAIRS {
        let odd = if pair < 3 { axis[pair] } else { diagonal[pair] };
        let s = keep_even.mul_add(s[pair], even[pair]);
        let d = keep_odd.mul_add(d[pair], odd);
        cell.forward[pair] = s + d;
        cell.backward[pair] = s - d;
    }
    cell
}

/// w a of each pair, and what all moving populations get together: 2/3 a, but with the very
/// weights that they get. The third part of a rounding that these are off would else change
/// the content, in the same sense at every step.
#[inline(always)]
fn first_order<T: Real, V: Lanes<T>>(a: V) -> ([V; PAIRS], V) {
    let axis = V::splat(T::of(W_AXIS)) * a;
    let mut even = [V::splat(T::of(0.5)) * axis; PAIRS];
    even[..3].fill(axis);
    (even, V::splat(T::of(12.0)) * axis)
}

/// w (a + (c·u)(c·v) - u·v/3) of each pair, and what all moving populations get together.
#[inline(always)]
fn second_order<T: Real, V: Lanes<T>>(a: V, u: [V; 3], v: [V; 3]) -> ([V; PAIRS], V) {
    let uv = dot(u, v);
    let minus_third = V::splat(T::of(-1.0 / 3.0)) * uv;
    let (even, got) = first_order(a);
    let (cu, cv) = (project(u), project(v));
    let mut more = even;
    for pair in 0..PAIRS {
        let w = V::splat(T::of(weight(pair)));
        more[pair] = w.mul_add(cu[pair].mul_add(cv[pair], minus_third), even[pair]);
    }
    (more, V::splat(T::of(1.0 / 9.0)).mul_add(uv, got))
}

/// Populations in equilibrium at a pressure and a flux, but with the first moment that the
/// forces ask for; lattice units.
pub(crate) fn equilibrium<T: Real>(
    k: &Coefficients<T>,
    model: &Model,
    at: usize,
    pressure: f64,
    flux: [f64; 3],
) -> Cell<T> {
    let get = |values: &[T], otherwise: f64| values.get(at).map_or(otherwise, |x| x.double());
    let content = match k.inverse_storage.get(at) {
        Some(inverse) => pressure / (inverse.double() * k.flatness.double()),
        None => 3.0 * pressure,
    };
    let square: f64 = flux.iter().map(|j| j * j).sum();
    let inertia = match model.inertia {
        true => get(&k.inverse_porosity, 1.0),
        false => 0.0,
    };
    let drag = get(&k.half_drag, 0.0);
    let extra = get(&k.half_forchheimer, 0.0) * square.sqrt();
    let momentum = [0, 1, 2].map(|axis| {
        let stretch = k.drag_stretch[usize::from(axis == 2)].double();
        flux[axis] * (1.0 + drag * stretch + extra) - k.half_force[axis].double()
    });
    let moving = |pair: usize, forward: bool| {
        let direction = Direction { pair, forward };
        let (cj, cm) = (direction.dot(flux), direction.dot(momentum));
        let squares = inertia * (4.5 * cj * cj - 1.5 * square);
        T::of(weight(pair) * (3.0 * pressure + 3.0 * cm + squares))
    };
    let all = |forward: bool| {
        let mut cells = [T::default(); PAIRS];
        for (pair, f) in cells.iter_mut().enumerate() {
            *f = moving(pair, forward);
        }
        cells
    };
    Cell {
        rest: T::of(content - 2.0 * pressure - inertia * 0.5 * square),
        forward: all(true),
        backward: all(false),
    }
}
