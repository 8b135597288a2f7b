//! Contact laws: one file each; this is the menu, and what a law sees and answers.

pub mod linear;
pub mod linear_lammps;
mod normal;
#[doc(hidden)]
pub mod probe;
mod turning;

pub use linear::{Linear, Sliding, Tension};
pub(crate) use linear_lammps::Lammps;
pub use linear_lammps::LinearLammps;
pub use turning::Turning;

pub(crate) use linear::Frictional;
pub(crate) use normal::Normal;

use crate::lanes::{Lanes, V3};

/// The contact law of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactLaw {
    /// Linear spring and dashpot with static and dynamic friction.
    Linear(Linear),
    /// The linear law exactly as LAMMPS computes it, for comparisons.
    LinearLammps(LinearLammps),
}

impl ContactLaw {
    /// Normal stiffness k_n [N/m].
    pub fn normal_stiffness(&self) -> f64 {
        match self {
            Self::Linear(law) => law.normal_stiffness,
            Self::LinearLammps(law) => law.normal_stiffness,
        }
    }

    /// Normal damping γ_n [N s/m].
    pub fn normal_damping(&self) -> f64 {
        match self {
            Self::Linear(law) => law.normal_damping,
            Self::LinearLammps(law) => law.normal_damping,
        }
    }

    /// Tangential stiffness k_t [N/m]; zero for frictionless grains.
    pub fn tangential_stiffness(&self) -> f64 {
        match self {
            Self::Linear(law) => law.sliding.map_or(0.0, |sliding| sliding.stiffness),
            Self::LinearLammps(law) => law.tangential_stiffness,
        }
    }

    /// Do grains feel friction, so that contacts keep a spring and grains spin?
    pub fn slides(&self) -> bool {
        match self {
            Self::Linear(law) => law.sliding.is_some(),
            Self::LinearLammps(_) => true,
        }
    }

    /// Do grains resist rolling or twisting?
    pub fn turns(&self) -> bool {
        match self {
            Self::Linear(law) => law.rolling.is_some() || law.twisting.is_some(),
            Self::LinearLammps(_) => false,
        }
    }
}

/// Four contacts as a law sees them; the normal points from j to i.
///
/// Where bodies do not touch, all but the normal is zero. A law needs no case for this: a
/// contact that has parted is one without pressure, whose springs slip to zero and lose what
/// they held.
#[derive(Clone, Copy)]
pub(crate) struct Touch<V> {
    /// Unit normal.
    pub normal: V3<V>,
    /// Overlap d [m].
    pub overlap: V,
    /// Rate of separation v_n [m/s].
    pub separation: V,
    /// Tangential velocity of i's surface against j's [m/s].
    pub slip: V3<V>,
    /// 1 where they touch, else 0.
    pub closed: V,
}

impl<V: Lanes> Touch<V> {
    #[inline(always)]
    pub fn none() -> Self {
        let zero = V::splat(0.0);
        Self {
            normal: V3::zero(),
            overlap: zero,
            separation: zero,
            slip: V3::zero(),
            closed: zero,
        }
    }
}

/// Four contacts as resistance to rolling and twisting sees them.
#[derive(Clone, Copy)]
pub(crate) struct Turn<V> {
    /// Spin of i against j [rad/s].
    pub spin: V3<V>,
    /// R* [m].
    pub reduced_radius: V,
}

/// What four contacts remember, and the forces of the last step, with which the work of
/// a step is exact.
#[derive(Clone, Copy)]
pub(crate) struct Memory<V> {
    pub springs: Springs<V>,
    /// Force on i in the last step [N]; only with a ledger.
    pub force: V3<V>,
    /// Rolling and twisting torque on i in the last step [N m]; only with a ledger, where the
    /// law turns.
    pub couple: V3<V>,
}

/// The springs of four contacts.
#[derive(Clone, Copy)]
pub(crate) struct Springs<V> {
    /// Tangential spring [m]; `sliding` is 1 where the contact slides, else 0.
    pub tangential: V3<V>,
    pub sliding: V,
    /// Rolling and twisting springs [m]; only where the law turns.
    pub rolling: V3<V>,
    pub twisting: V,
}

impl<V: Lanes> Turn<V> {
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            spin: V3::zero(),
            reduced_radius: V::splat(0.0),
        }
    }
}

impl<V: Lanes> Springs<V> {
    #[inline(always)]
    pub fn none() -> Self {
        let (zero, w) = (V3::zero(), V::splat(0.0));
        Self {
            tangential: zero,
            sliding: w,
            rolling: zero,
            twisting: w,
        }
    }
}

/// What a law answers for four contacts.
#[derive(Clone, Copy)]
pub(crate) struct Response<V> {
    /// Normal force along the normal [N].
    pub normal: V,
    /// Tangential force on i [N].
    pub tangential: V3<V>,
    /// Torque on i beyond that of the tangential force, its opposite acts on j [N m].
    pub couple: V3<V>,
    /// Springs after the step.
    pub springs: Springs<V>,
}

impl<V: Lanes> Response<V> {
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            normal: V::splat(0.0),
            tangential: V3::zero(),
            couple: V3::zero(),
            springs: Springs::none(),
        }
    }
}

/// Energy that four contacts lost in a step [J].
#[derive(Clone, Copy)]
pub(crate) struct Losses<V> {
    pub friction: V,
    pub viscosity: V,
    pub rolling: V,
}

impl<V: Lanes> Losses<V> {
    #[inline(always)]
    pub fn none() -> Self {
        let zero = V::splat(0.0);
        Self {
            friction: zero,
            viscosity: zero,
            rolling: zero,
        }
    }

    /// Those of a linear normal force and a tangential spring of stiffness `k_t` with a
    /// dashpot, which is cut to a limit where the contact slides.
    ///
    /// The tangential part is the mean of the force before and after times the way, less
    /// what the spring kept. It goes into the dashpot of a contact that sticks, else into
    /// friction; so does what was in the spring of a contact that has parted.
    #[inline(always)]
    pub fn of_sliding(
        normal: &Normal,
        k_t: V,
        touch: &Touch<V>,
        before: &Memory<V>,
        after: &Response<V>,
        step: V,
    ) -> Self {
        let u = touch.slip;
        let work = step * (before.force.dot(u) + after.tangential.dot(u));
        let (old, new) = (before.springs.tangential, after.springs.tangential);
        let stored = k_t * (new.dot(new) - old.dot(old));
        let tangential = V::splat(-0.5) * (work + stored);
        let dashpot = tangential * (touch.closed - after.springs.sliding);
        let pushed = before.force.dot(touch.normal);
        Self {
            friction: tangential - dashpot,
            viscosity: dashpot + normal.loss(touch, pushed, after.normal, step),
            rolling: V::splat(0.0),
        }
    }
}

/// A contact law ready for the kernel: the scene's choices are types, not branches.
pub(crate) trait Law: Copy + Send + Sync {
    /// Is there a tangential force, so that there are springs and grains spin?
    const SLIDES: bool;
    /// Is there resistance to rolling or twisting?
    const TURNS: bool;

    /// Take the numbers out of the scene's law.
    fn of(law: &ContactLaw) -> Self;

    /// Arm of the surface velocity for a grain of `radius` at `overlap`.
    fn velocity_arm<V: Lanes>(radius: V, overlap: V) -> V;

    /// Arm of the tangential force in the torque.
    fn torque_arm<V: Lanes, const WALL: bool>(radius: V, overlap: V) -> V;

    /// Forces of four contacts after a step of `step` seconds, zero in the first evaluation.
    /// `turn` is read only where the law turns.
    fn respond<V: Lanes>(
        &self,
        touch: &Touch<V>,
        turn: &Turn<V>,
        springs: &Springs<V>,
        step: V,
    ) -> Response<V>;

    /// What went into sliding, dashpots and rolling in that step, in which the contacts went
    /// from `before` to `after`.
    fn losses<V: Lanes>(
        &self,
        touch: &Touch<V>,
        turn: &Turn<V>,
        before: &Memory<V>,
        after: &Response<V>,
        step: V,
    ) -> Losses<V>;
}
