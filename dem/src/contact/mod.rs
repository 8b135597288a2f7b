//! Contact laws: one file each; this is the menu, and what a law sees and answers.

pub mod linear;
pub mod linear_lammps;
mod normal;
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
}

/// Four contacts as resistance to rolling and twisting sees them.
#[derive(Clone, Copy)]
pub(crate) struct Turn<V> {
    /// Spin of i against j [rad/s].
    pub spin: V3<V>,
    /// R* [m].
    pub reduced_radius: V,
}

/// What four contacts remember, and the force of the last step, with which the work of
/// a step is exact.
#[derive(Clone, Copy)]
pub(crate) struct Memory<V> {
    /// Tangential spring [m]; `sliding` is 1 where the contact slides, else 0.
    pub spring: V3<V>,
    pub sliding: V,
    /// Force of the last step [N]; only with a ledger.
    pub force: V3<V>,
    /// Rolling and twisting springs [m] and torque of the last step; only where the law turns.
    pub rolling: V3<V>,
    pub twisting: V,
    pub couple: V3<V>,
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

impl<V: Lanes> Memory<V> {
    #[inline(always)]
    pub fn none() -> Self {
        let zero = V3::zero();
        let w = V::splat(0.0);
        Self {
            spring: zero,
            sliding: w,
            force: zero,
            rolling: zero,
            twisting: w,
            couple: zero,
        }
    }
}

impl<V: Lanes> Memory<V> {
    /// Energy that the tangential contact took over the last drift [J]: the mean of its
    /// force before and after times the way, less what its spring of stiffness `k_t` kept.
    #[inline(always)]
    pub fn tangential_loss(&self, k_t: V, force: V3<V>, spring: V3<V>, slip: V3<V>, step: V) -> V {
        let work = step * (self.force.dot(slip) + force.dot(slip));
        let stored = k_t * (spring.dot(spring) - self.spring.dot(self.spring));
        V::splat(-0.5) * (work + stored)
    }
}

/// What a law answers for four contacts.
#[derive(Clone, Copy)]
pub(crate) struct Response<V> {
    /// Normal force along the normal [N].
    pub normal_force: V,
    /// Tangential force on i [N].
    pub tangential: V3<V>,
    /// Torque on i beyond that of the tangential force, its opposite acts on j [N m].
    pub couple: V3<V>,
    /// Springs after the step.
    pub memory: Memory<V>,
    /// Energy that went into sliding, dashpots, and rolling in this step [J]; only with a
    /// ledger.
    pub friction: V,
    pub viscosity: V,
    pub rolling_loss: V,
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
    fn respond<V: Lanes, const LEDGER: bool>(
        &self,
        touch: &Touch<V>,
        turn: &Turn<V>,
        memory: Memory<V>,
        step: V,
    ) -> Response<V>;
}
