//! What is read from a solver: the state, the forces and the running sums at one instant.

use crate::State;
use glam::DVec3;

/// A copy of all that outputs are made from. Reading one never changes the trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// State with velocities at the same instant as positions.
    pub state: State,
    /// Net force on each grain [N]: contacts, gravity, and forces from outside; x and y are
    /// zero on held and driven grains, whose share is in `held_force` and `driven_force`.
    pub force: Vec<DVec3>,
    /// Net torque on each grain [N m].
    pub torque: Vec<DVec3>,
    /// Force of the grains on each wall along minus its normal [N]: positive when they push.
    pub wall_force: Vec<f64>,
    /// Sum of the x forces of contacts on the held layer [N], without its weight.
    pub held_force: f64,
    /// Sum of the x forces of contacts on the driven layer [N], without its weight.
    pub driven_force: f64,
    /// Running sums since the solver began.
    pub sums: Sums,
    /// Energy ledger since the solver began.
    pub ledger: Ledger,
}

/// Sums over time steps since the solver began. The difference of two of them, over the
/// difference of `steps`, is an interval mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sums {
    /// Number of steps.
    pub steps: u64,
    /// Σ force of the grains on each wall [N].
    pub wall_force: Vec<f64>,
    /// Σ x force on the held layer [N].
    pub held_force: f64,
    /// Σ x force on the driven layer [N].
    pub driven_force: f64,
}

/// Where the energy is and where it went [J]. State terms are instants, the others sums
/// since the solver began.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Kinetic energy of translation.
    pub kinetic: f64,
    /// Kinetic energy of rotation.
    pub rotational: f64,
    /// Normal springs.
    pub elastic_normal: f64,
    /// Tangential springs.
    pub elastic_tangential: f64,
    /// Rolling and twisting springs.
    pub elastic_rolling: f64,
    /// Lost in sliding.
    pub dissipated_friction: f64,
    /// Lost in dashpots.
    pub dissipated_viscosity: f64,
    /// Lost in rolling and twisting.
    pub dissipated_rolling: f64,
    /// Work of the walls on the grains.
    pub work_walls: f64,
    /// Work of the drive on the grains.
    pub work_drive: f64,
    /// Work of gravity on the grains.
    pub work_gravity: f64,
    /// Work of outside forces on the grains.
    pub work_outside: f64,
    /// Work on the grains of what goes along with them, such as pore water (CPU).
    pub work_companion: f64,
    /// Work that arrived and is not found: work - change of energy - dissipation.
    pub residual: f64,
}
