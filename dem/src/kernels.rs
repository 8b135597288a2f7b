//! The hot loops of a scene, chosen once: by contact law, ledger, and processor.

use crate::contact::{ContactLaw, Frictional, Lammps, Law, Normal};
use crate::lanes::Portable;
use crate::motion::{Own, move_grains};
use crate::slab::Slab;
use crate::sweep::sweep_pairs;
use crate::view::View;
use crate::walls::sweep_wall;
use crate::{Surface, WallState};
use glam::DVec3;

type Pairs = unsafe fn(&View, &mut Slab);
type Wall = unsafe fn(&View, &mut Slab, usize, DVec3, WallState, &mut [f64]);
type Motion = unsafe fn(&mut Own, &mut Slab) -> f64;

/// The kernels of one scene. They are unsafe because some need processor features; the
/// constructor has asked for these.
#[derive(Clone, Copy)]
pub(crate) struct Kernels {
    pairs: Pairs,
    smooth_wall: Wall,
    full_wall: Wall,
    motion: Motion,
    /// Name of the vectors in use.
    pub vectors: &'static str,
}

impl Kernels {
    /// The kernels for `law`, with or without the sums of the ledger.
    pub fn choose(law: &ContactLaw, ledger: bool) -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            return match ledger {
                true => by_law::<avx2::Family, true>(law),
                false => by_law::<avx2::Family, false>(law),
            };
        }
        Self::portable(law, ledger)
    }

    /// The kernels that run everywhere.
    pub fn portable(law: &ContactLaw, ledger: bool) -> Self {
        match ledger {
            true => by_law::<PortableFamily, true>(law),
            false => by_law::<PortableFamily, false>(law),
        }
    }

    /// Forces of all pairs.
    ///
    /// # Safety
    /// The slab was cut for the rows of `view`.
    pub unsafe fn pairs(&self, view: &View, slab: &mut Slab) {
        // SAFETY: the caller's promise, and `choose` has seen that the processor has what the
        // kernel needs.
        unsafe { (self.pairs)(view, slab) }
    }

    /// Forces of one wall.
    pub fn wall(
        &self,
        view: &View,
        slab: &mut Slab,
        k: usize,
        wall: &crate::Wall,
        state: WallState,
        gauge: &mut [f64],
    ) {
        let kernel = match wall.surface {
            Surface::Frictionless => self.smooth_wall,
            Surface::Full => self.full_wall,
        };
        // SAFETY: `choose` has seen that the processor has what the kernel needs.
        unsafe { kernel(view, slab, k, wall.normal, state, gauge) }
    }

    /// Kick and drift; returns a bound on the speeds [m/s].
    pub fn motion(&self, own: &mut Own, slab: &mut Slab) -> f64 {
        // SAFETY: as above.
        unsafe { (self.motion)(own, slab) }
    }
}

/// Kernels compiled for one kind of processor.
trait Family {
    const VECTORS: &'static str;
    fn pairs<L: Law, const LEDGER: bool>() -> Pairs;
    fn wall<L: Law, const LEDGER: bool>() -> Wall;
    fn motion<const SPINS: bool>() -> Motion;
}

fn by_law<F: Family, const LEDGER: bool>(law: &ContactLaw) -> Kernels {
    match law {
        ContactLaw::LinearLammps(_) => kernels::<F, Lammps, LEDGER>(),
        ContactLaw::Linear(_) if law.turns() => kernels::<F, Frictional<true>, LEDGER>(),
        ContactLaw::Linear(_) if law.slides() => kernels::<F, Frictional<false>, LEDGER>(),
        ContactLaw::Linear(_) => kernels::<F, Normal, LEDGER>(),
    }
}

fn kernels<F: Family, L: Law, const LEDGER: bool>() -> Kernels {
    Kernels {
        pairs: F::pairs::<L, LEDGER>(),
        smooth_wall: F::wall::<Normal, LEDGER>(),
        full_wall: F::wall::<L, LEDGER>(),
        motion: if L::SLIDES {
            F::motion::<true>()
        } else {
            F::motion::<false>()
        },
        vectors: F::VECTORS,
    }
}

struct PortableFamily;

impl Family for PortableFamily {
    const VECTORS: &'static str = "portable";
    fn pairs<L: Law, const LEDGER: bool>() -> Pairs {
        sweep_pairs::<Portable, L, LEDGER>
    }
    fn wall<L: Law, const LEDGER: bool>() -> Wall {
        sweep_wall::<Portable, L, LEDGER>
    }
    fn motion<const SPINS: bool>() -> Motion {
        move_grains::<Portable, SPINS>
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::*;
    use crate::lanes::Avx2;

    pub(super) struct Family;

    impl super::Family for Family {
        const VECTORS: &'static str = "avx2";
        fn pairs<L: Law, const LEDGER: bool>() -> Pairs {
            pairs::<L, LEDGER>
        }
        fn wall<L: Law, const LEDGER: bool>() -> Wall {
            wall::<L, LEDGER>
        }
        fn motion<const SPINS: bool>() -> Motion {
            motion::<SPINS>
        }
    }

    #[target_feature(enable = "avx2,fma")]
    unsafe fn pairs<L: Law, const LEDGER: bool>(view: &View, slab: &mut Slab) {
        // SAFETY: the caller's promise.
        unsafe { sweep_pairs::<Avx2, L, LEDGER>(view, slab) }
    }

    #[target_feature(enable = "avx2,fma")]
    fn wall<L: Law, const LEDGER: bool>(
        view: &View,
        slab: &mut Slab,
        k: usize,
        normal: DVec3,
        state: WallState,
        gauge: &mut [f64],
    ) {
        sweep_wall::<Avx2, L, LEDGER>(view, slab, k, normal, state, gauge)
    }

    #[target_feature(enable = "avx2,fma")]
    fn motion<const SPINS: bool>(own: &mut Own, slab: &mut Slab) -> f64 {
        move_grains::<Avx2, SPINS>(own, slab)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Linear, LinearLammps, Sliding, Tension, Turning};
    use crate::{Domain, Grains, Model, Solver, State, WallMotion};

    /// Grains on a lattice that overlap a little, thrown about, between a smooth and a full wall.
    fn case(law: ContactLaw) -> (Model, State) {
        let mut grains = Grains::default();
        for k in 0..150 {
            let (x, y, z) = (k % 5, k / 5 % 5, k / 25);
            let jitter = f64::from(k * 7919 % 101) * 1e-5;
            let position = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * 0.0199 + jitter;
            grains.add_sphere(position + 0.0099, 0.0095 + jitter, 2600.0);
            let spin = f64::from(k * 104_729 % 97) - 48.0;
            grains.velocity[k as usize] = DVec3::new(spin, 17.0 - spin, 0.5 * spin) * 1e-2;
            grains.angular_velocity[k as usize] = DVec3::new(-spin, 0.3 * spin, spin);
        }
        let wall = |normal, surface| crate::Wall {
            name: "wall".into(),
            normal,
            surface,
            motion: WallMotion::Held,
        };
        let at = |offset| WallState {
            offset,
            velocity: 0.0,
        };
        let model = Model {
            domain: Domain {
                size: [0.1, 0.1],
                periodic: [true, true],
            },
            gravity: DVec3::new(0.0, 0.0, -9.81),
            law,
            walls: vec![
                wall(DVec3::Z, Surface::Full),
                wall(DVec3::NEG_Z, Surface::Frictionless),
            ],
            drive: None,
            step: 1e-5,
            skin: None,
            ledger: true,
        };
        let state = State {
            grains,
            walls: vec![at(0.0), at(-0.13)],
            ..State::default()
        };
        (model, state)
    }

    #[test]
    fn portable_kernels_follow_those_of_the_processor() {
        let turning = Turning {
            stiffness: 1e4,
            damping: 0.5,
            friction: 0.1,
        };
        let sliding = Sliding {
            stiffness: 1e5,
            damping: 3.0,
            friction_static: 0.6,
            friction_dynamic: 0.4,
        };
        let linear = |sliding, turning| {
            ContactLaw::Linear(Linear {
                normal_stiffness: 4e5,
                normal_damping: 5.0,
                tension: Tension::Clip,
                sliding,
                rolling: turning,
                twisting: turning,
            })
        };
        let lammps = ContactLaw::LinearLammps(LinearLammps {
            normal_stiffness: 4e5,
            normal_damping: 5.0,
            tangential_stiffness: 1e5,
            tangential_damping: 3.0,
            friction: 0.5,
        });
        let laws = [
            linear(None, None),
            linear(Some(sliding), None),
            linear(Some(sliding), Some(turning)),
            lammps,
        ];
        for law in laws {
            let (model, state) = case(law);
            let mut fast = Solver::new(model.clone(), state.clone(), 1).unwrap();
            let mut portable = Solver::new(model, state, 1).unwrap();
            portable.kernels = Kernels::portable(&law, true);
            fast.advance(100).unwrap();
            portable.advance(100).unwrap();
            let (fast, portable) = (fast.snapshot(), portable.snapshot());
            assert!(
                fast.state.contacts.len() > 100,
                "{} contacts",
                fast.state.contacts.len()
            );
            // Rounding of fused multiplications, amplified by a few collisions.
            for (a, b) in fast
                .state
                .grains
                .position
                .iter()
                .zip(&portable.state.grains.position)
            {
                assert!(a.distance(*b) < 1e-12, "{law:?}: {a} and {b}");
            }
            let (a, b) = (fast.ledger, portable.ledger);
            let scale = a.stored() + a.dissipated();
            for (a, b) in [
                (a.stored(), b.stored()),
                (a.dissipated_friction, b.dissipated_friction),
                (a.dissipated_viscosity, b.dissipated_viscosity),
                (a.dissipated_rolling, b.dissipated_rolling),
            ] {
                assert!((a - b).abs() < 1e-9 * scale, "{law:?}: {a} J and {b} J");
            }
        }
    }
}
