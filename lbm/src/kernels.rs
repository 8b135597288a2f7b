//! The hot loops of a run, chosen once: by law, and by processor.

use crate::Model;
use crate::collide::{Cell, Coefficients, Free, Law, Moments, Porous};
use crate::lanes::private::Number;
use crate::lanes::{Lanes, Real};
use crate::lattice::PAIRS;
use crate::populations::{Populations, Span};

/// What the law of a run has in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Parts {
    pub porous: bool,
    pub inertia: bool,
    pub force: bool,
    pub forchheimer: bool,
    pub source: bool,
}

impl Parts {
    /// What the law of `model` has, but for sources, which may come and go.
    pub fn of(model: &Model) -> Self {
        let bed = model.bed.as_ref();
        Self {
            porous: bed.is_some(),
            inertia: model.inertia,
            force: model.acceleration != [0.0; 3],
            forchheimer: bed.is_some_and(|bed| bed.forchheimer.is_some()),
            source: false,
        }
    }
}

type Sweep<T> = unsafe fn(&Coefficients<T>, &Populations<T>, bool, &[Span]);
type Reading<T> = unsafe fn(&Coefficients<T>, usize, &Cell<T>) -> (T, [T; 3]);

/// The kernels of one law. They are unsafe because some need features of the processor, which
/// the constructor has asked for, and because they trust in the places that they get.
#[derive(Clone, Copy)]
pub(crate) struct Kernels<T> {
    /// Collide and stream the cells of some spans in step `odd`.
    pub sweep: Sweep<T>,
    /// Pressure and flux of a cell, from what arrived.
    pub reading: Reading<T>,
}

impl<T: Real> Kernels<T> {
    /// The kernels for a law with these parts.
    pub fn choose(parts: Parts) -> Self {
        by_law(parts, vectors())
    }
}

/// The kernels that run everywhere, or those of the processor's vectors.
fn by_law<T: Real>(parts: Parts, vectors: bool) -> Kernels<T> {
    match parts {
        Parts { porous: true, .. } => porous(parts, vectors),
        Parts { inertia, force, .. } => match (inertia, force) {
            (true, true) => of::<T, Free<true, true>>(vectors),
            (true, false) => of::<T, Free<true, false>>(vectors),
            (false, true) => of::<T, Free<false, true>>(vectors),
            (false, false) => of::<T, Free<false, false>>(vectors),
        },
    }
}

fn porous<T: Real>(parts: Parts, vectors: bool) -> Kernels<T> {
    match (parts.inertia, parts.forchheimer, parts.source) {
        (true, true, true) => of::<T, Porous<true, true, true>>(vectors),
        (true, true, false) => of::<T, Porous<true, true, false>>(vectors),
        (true, false, true) => of::<T, Porous<true, false, true>>(vectors),
        (true, false, false) => of::<T, Porous<true, false, false>>(vectors),
        (false, true, true) => of::<T, Porous<false, true, true>>(vectors),
        (false, true, false) => of::<T, Porous<false, true, false>>(vectors),
        (false, false, true) => of::<T, Porous<false, false, true>>(vectors),
        (false, false, false) => of::<T, Porous<false, false, false>>(vectors),
    }
}

#[cfg(target_arch = "x86_64")]
fn vectors() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

#[cfg(not(target_arch = "x86_64"))]
fn vectors() -> bool {
    false
}

fn of<T: Real, L: Law<T>>(vectors: bool) -> Kernels<T> {
    #[cfg(target_arch = "x86_64")]
    if vectors {
        return Kernels {
            sweep: sweep_avx2::<T, L>,
            reading: reading::<T, L>,
        };
    }
    debug_assert!(!vectors);
    Kernels {
        sweep: sweep::<T, <T as Number>::Plain, <T as Number>::Plain, L>,
        reading: reading::<T, L>,
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn sweep_avx2<T: Real, L: Law<T>>(
    k: &Coefficients<T>,
    populations: &Populations<T>,
    odd: bool,
    spans: &[Span],
) {
    // SAFETY: the caller's promise.
    unsafe {
        sweep::<T, <T as Number>::Avx2, <T as Number>::Fused, L>(k, populations, odd, spans);
    }
}

/// Collide and stream the cells of some spans, by `V` where there are enough of them side by
/// side and by `S`, which is one cell, where there are not.
///
/// # Safety
/// The spans hold cells of the lattice, and nobody else touches the slots of these.
#[inline(always)]
unsafe fn sweep<T: Real, V: Lanes<T>, S: Lanes<T>, L: Law<T>>(
    k: &Coefficients<T>,
    populations: &Populations<T>,
    odd: bool,
    spans: &[Span],
) {
    let cells = populations.grid.cells[0];
    let periodic = populations.grid.extent[0] == cells;
    let slots = populations.slots(odd);
    for span in spans {
        let row = slots.row(span.y as usize, span.z as usize);
        let (mut x, end) = (span.begin as usize, span.end as usize);
        let wraps = periodic && end == cells;
        // SAFETY: the caller's promise.
        unsafe {
            if wraps {
                row.wrap(cells, false);
            }
            while x + V::COUNT <= end {
                let cell = L::collide(k, row.place + x, row.load::<V>(x));
                row.store(x, cell);
                x += V::COUNT;
            }
            while x < end {
                let cell = L::collide(k, row.place + x, row.load::<S>(x));
                row.store(x, cell);
                x += S::COUNT;
            }
            if wraps {
                row.wrap(cells, true);
            }
        }
    }
}

/// Pressure and flux of the cell at place `at`.
///
/// # Safety
/// `at` is a place of the lattice.
unsafe fn reading<T: Real, L: Law<T>>(
    k: &Coefficients<T>,
    at: usize,
    cell: &Cell<T>,
) -> (T, [T; 3]) {
    let load = |x: &T| {
        // SAFETY: a number that is borrowed.
        unsafe { <T as Number>::Plain::load(x) }
    };
    let cell = Cell {
        rest: load(&cell.rest),
        forward: pairs(&cell.forward, load),
        backward: pairs(&cell.backward, load),
    };
    // SAFETY: the caller's promise.
    let Moments { pressure, flux } = unsafe { L::moments(k, at, &cell) };
    let number = |lane: <T as Number>::Plain| {
        let mut x = T::default();
        // SAFETY: a number that is borrowed exclusively.
        unsafe { lane.store(&mut x) };
        x
    };
    (number(pressure), flux.map(number))
}

fn pairs<T, V>(values: &[T; PAIRS], load: impl Fn(&T) -> V) -> [V; PAIRS] {
    values.each_ref().map(load)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::equilibrium;
    use crate::grid::Grid;
    use crate::lattice::Direction;
    use crate::{Bed, Ends, Field, Fluid};

    /// Some steps in a periodic box of rough populations, for each law.
    fn run<T: Real>(parts: Parts, vectors: bool) -> Vec<f64> {
        let cells = [21, 3, 2];
        let model = Model {
            cells,
            spacing: 1.0,
            fluid: Fluid::COLD_WATER,
            bed: parts.porous.then_some(Bed {
                porosity: Field::Uniform(0.5),
                permeability: Field::Uniform(1.0),
                forchheimer: None,
            }),
            ends: [Ends::Periodic, Ends::Periodic, Ends::Periodic],
            solid: Vec::new(),
            acceleration: [0.0; 3],
            inertia: parts.inertia,
            regime: None,
            step: None,
            speed: 0.0,
        };
        let grid = Grid::new(cells, [false; 3]);
        let rough = |from: f64, by: f64| -> Vec<T> {
            let value = |at: usize| T::of(from + by * ((at * 7919) % 101) as f64 / 101.0);
            (0..grid.places()).map(value).collect()
        };
        let k = Coefficients {
            omega_even: T::of(1.3),
            omega_odd: T::of(0.9),
            half_force: [1e-4, -2e-4, 3e-4].map(T::of),
            inverse_storage: rough(0.1, 0.2),
            flatness: T::of(1.0),
            half_drag: rough(0.0, 2.0),
            drag_stretch: [T::of(1.0); 2],
            half_forchheimer: rough(0.0, 5.0),
            inverse_porosity: rough(1.0, 2.0),
            source: rough(-1e-4, 2e-4),
        };
        let mut populations = Populations::new(grid);
        for (cell, at) in grid.all().enumerate() {
            let [p, x, y] = [13, 17, 19].map(|prime| 1e-2 * ((cell * prime) % 7) as f64);
            let place = grid.place(at);
            let rough = equilibrium(&k, &model, place, p, [x, y, 0.5 * x]);
            populations.write(at, false, &rough);
        }
        let row = |y, z| Span {
            y,
            z,
            begin: 0,
            end: 21,
        };
        let spans: Vec<Span> = (0..2)
            .flat_map(|z| (0..3).map(move |y| row(y, z)))
            .collect();
        let kernels = by_law::<T>(parts, vectors);
        for step in 0..10 {
            // SAFETY: the vectors were asked for; these are all cells, and one thread.
            unsafe { (kernels.sweep)(&k, &populations, step % 2 == 1, &spans) };
        }
        let all = grid
            .all()
            .flat_map(|at| Direction::all().map(move |direction| (at, direction)));
        // SAFETY: slots of the lattice, which nobody writes.
        all.map(|(at, d)| unsafe { (*populations.slot(at, d, false)).double() })
            .collect()
    }

    #[test]
    fn portable_kernels_follow_those_of_the_processor() {
        if !vectors() {
            // Then there are no others.
            return;
        }
        for flags in 0..32 {
            let flag = |bit: u32| flags >> bit & 1 == 1;
            let parts = Parts {
                porous: flag(0),
                inertia: flag(1),
                force: flag(2),
                forchheimer: flag(3),
                source: flag(4),
            };
            let close = |fast: &[f64], portable: &[f64], epsilon: f64| {
                assert!(fast.iter().any(|f| f.abs() > 1e-3));
                for (a, b) in fast.iter().zip(portable) {
                    // Rounding of fused multiplications over ten steps.
                    assert!((a - b).abs() < 3.0 * epsilon, "{parts:?}: {a} and {b}");
                }
            };
            close(
                &run::<f64>(parts, true),
                &run::<f64>(parts, false),
                f64::EPSILON,
            );
            let single = f64::from(f32::EPSILON);
            close(&run::<f32>(parts, true), &run::<f32>(parts, false), single);
        }
    }
}
