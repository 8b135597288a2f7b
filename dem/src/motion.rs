//! Motion of the grains: one kick and one drift a step (velocity Verlet as leapfrog).
//!
//! v(t + dt/2) = v(t - dt/2) + F(t)/m dt,   x(t + dt) = x(t) + v(t + dt/2) dt,
//! and the same for angular velocities. Between steps velocities stand half a step behind
//! positions; readers get them at the time of the positions.
//! Source: Verlet (1967), Phys. Rev. 159, 98-103.

use crate::lanes::{Lanes, Row};
use crate::slab::{BLOCK, Slab};
use glam::{DQuat, DVec3};

/// Rows and constants of the grains that one slab moves.
pub(crate) struct Own<'a> {
    pub position: &'a mut [Row],
    pub velocity: &'a mut [Row],
    /// Empty where grains do not spin, as the next two.
    pub spin: &'a mut [Row],
    /// Rotation since it was last put into the orientation [rad].
    pub turned: &'a mut [Row],
    /// dt/I [s/(kg m²)].
    pub twist: &'a [f64],
    /// dt/m [s/kg].
    pub kick: &'a [f64],
    /// Mass [kg].
    pub mass: &'a [f64],
    pub gravity: DVec3,
    pub step: f64,
    /// Forces and torques from outside, one row a grain.
    pub outside: Option<(&'a [Row], &'a [Row])>,
}

/// Move the grains of a slab by one step, start their sums anew with their weight, and
/// return a bound on their speeds [m/s].
#[inline(always)]
pub(crate) fn move_grains<V: Lanes, const SPINS: bool>(own: &mut Own, slab: &mut Slab) -> f64 {
    // The fourth place of a force is a loss, not part of the motion.
    let vector = V::load(&Row([1.0, 1.0, 1.0, 0.0]));
    let gravity = V::load(&Row::new(own.gravity, 0.0));
    let (zero, step) = (V::splat(0.0), V::splat(own.step));
    let mut bound: f64 = 0.0;
    let grains = own.position.len();
    for (block, loss) in slab.losses.iter_mut().enumerate() {
        let range = block * BLOCK..((block + 1) * BLOCK).min(grains);
        if let Some((force, torque)) = own.outside {
            for g in range.clone() {
                push::<SPINS>(own, g, force[g], torque[g]);
            }
        }
        let (mut forces, mut torques, mut fastest) = (zero, zero, zero);
        // Slices of one length each: then their indices need no checks.
        let count = range.len();
        let (mass, kick) = (
            &own.mass[range.clone()][..count],
            &own.kick[range.clone()][..count],
        );
        let sums = &mut slab.force[range.clone()][..count];
        let velocities = &mut own.velocity[range.clone()][..count];
        let positions = &mut own.position[range.clone()][..count];
        for g in 0..count {
            let force = V::load(&sums[g]);
            (gravity * V::splat(mass[g])).store(&mut sums[g]);
            forces = forces + force;
            let kicked = (force * vector).mul_add(V::splat(kick[g]), V::load(&velocities[g]));
            kicked.store(&mut velocities[g]);
            fastest = kicked.abs().max(fastest);
            let moved = kicked.mul_add(step, V::load(&positions[g]));
            moved.store(&mut positions[g]);
        }
        if SPINS {
            let twist = &own.twist[range.clone()][..count];
            let sums = &mut slab.torque[range.clone()][..count];
            let spins = &mut own.spin[range.clone()][..count];
            let angles = &mut own.turned[range.clone()][..count];
            for g in 0..count {
                let torque = V::load(&sums[g]);
                zero.store(&mut sums[g]);
                torques = torques + torque;
                let kicked = (torque * vector).mul_add(V::splat(twist[g]), V::load(&spins[g]));
                kicked.store(&mut spins[g]);
                let turned = kicked.mul_add(step, V::load(&angles[g]));
                turned.store(&mut angles[g]);
            }
        }
        let (mut force_sum, mut torque_sum) = (Row::ZERO, Row::ZERO);
        forces.store(&mut force_sum);
        torques.store(&mut torque_sum);
        // Block by block, as losses are: the bound, and with it the moment of the next search
        // and the order of sums, must not depend on which thread moves which grains.
        let mut speeds = Row::ZERO;
        fastest.store(&mut speeds);
        // The largest of several numbers may hide one that is none; a sum does not.
        let speed = match force_sum.xyz().is_finite() {
            true => speeds.xyz().length(),
            false => f64::INFINITY,
        };
        bound = bound.max(speed);
        if SPINS {
            loss.friction += force_sum.w();
            loss.viscosity += torque_sum.w();
        } else {
            loss.viscosity += force_sum.w();
        }
        if !slab.rolling_loss.is_empty() {
            loss.rolling += slab.rolling_loss[range.clone()].iter().sum::<f64>();
            slab.rolling_loss[range.clone()].fill(0.0);
        }
        if let Some((force, torque)) = own.outside {
            for g in range {
                loss.outside += own.step * force[g].xyz().dot(own.velocity[g].xyz());
                if SPINS {
                    loss.outside += own.step * torque[g].xyz().dot(own.spin[g].xyz());
                }
            }
        }
    }
    bound
}

/// Kick grain `g` by an outside force and torque.
#[inline(always)]
fn push<const SPINS: bool>(own: &mut Own, g: usize, force: Row, torque: Row) {
    for axis in 0..3 {
        own.velocity[g].0[axis] += own.kick[g] * force.0[axis];
        if SPINS {
            own.spin[g].0[axis] += own.twist[g] * torque.0[axis];
        }
    }
}

/// Steps between two updates of the orientations. The rotation in between, well below a
/// thousandth of a radian, is a sum of vectors; a fixed number keeps it independent of
/// when outputs are read.
pub(crate) const TURN_EVERY: u64 = 64;

/// `orientation` after a further rotation by the vector `turned` [rad].
pub(crate) fn turned(orientation: DQuat, turned: DVec3) -> DQuat {
    (DQuat::from_scaled_axis(turned) * orientation).normalize()
}
