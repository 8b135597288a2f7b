//! Contacts of grains with walls.
//!
//! The wall is the body j: its surface has no curvature and no spin. Arms and reduced
//! radius are those of the grain alone. All near grains of a wall go through the law,
//! touching or not: they are few.

use crate::WallState;
use crate::contact::{Law, Memory, Touch, Turn};
use crate::lanes::{Lanes, Row, V3, row};
use crate::slab::{Kept, Slab};
use crate::sweep::{View, add, columns, recall, spread};
use glam::DVec3;

/// Forces of wall `k` on the grains of `slab`, added to their sums.
///
/// `gauge` receives the normal force of each near grain [N].
#[inline(always)]
pub(crate) fn sweep_wall<V: Lanes, L: Law, const LEDGER: bool>(
    view: &View,
    slab: &mut Slab,
    k: usize,
    normal: DVec3,
    state: WallState,
    gauge: &mut [f64],
) {
    let law = L::of(view.law);
    let mut wall = std::mem::take(&mut slab.walls[k]);
    let spins = !view.spin.is_empty();
    let (zero, one) = (V::splat(0.0), V::splat(1.0));
    let n = V3(V::splat(normal.x), V::splat(normal.y), V::splat(normal.z));
    let step = V::splat(view.step);

    for group in 0..wall.count.div_ceil(4) {
        let g = &wall.grains[4 * group..4 * group + 4];
        let rows = |rows| {
            [
                row(rows, g[0]),
                row(rows, g[1]),
                row(rows, g[2]),
                row(rows, g[3]),
            ]
        };
        let (x, radius) = columns::<V>(rows(view.position));
        let overlap = radius - (x.dot(n) - V::splat(state.offset));
        // A grain that just touches counts: its dashpot does, as in the reference trajectories.
        let touches = overlap.greater(V::splat(-f64::MIN_POSITIVE));
        let now = V::bits(touches);
        let was = std::mem::replace(&mut wall.touching[group], now as u8) as u32;
        let slots = [0, 1, 2, 3].map(|lane| 4 * group as u32 + lane);
        for lane in (0..4).filter(|lane| (was & !now) >> lane & 1 == 1) {
            let slot = 4 * group + lane;
            if LEDGER && L::SLIDES {
                let own = wall.grains[slot].index() - slab.own.start;
                let [sliding, rolling] = wall.slots.get(slot).energies(view.law);
                slab.force[own].0[3] += sliding;
                if L::TURNS {
                    slab.rolling_loss[own] += rolling;
                }
            }
            wall.slots.set(slot, Kept::default());
        }
        if now == 0 {
            gauge[4 * group..wall.count.min(4 * group + 4)].fill(0.0);
            continue;
        }

        let (v, _) = columns::<V>(rows(view.velocity));
        let velocity = v.minus(V::splat(state.velocity), n);
        let separation = velocity.dot(n);
        let mut touch = Touch {
            normal: n,
            overlap,
            separation,
            slip: V3::zero(),
        };
        let mut turn = Turn {
            spin: V3::zero(),
            reduced_radius: radius,
        };
        if L::SLIDES {
            let (spin, _) = columns::<V>(rows(view.spin));
            let surface = spin.scale(L::velocity_arm(radius, overlap));
            touch.slip = velocity.minus(separation, n).minus(one, surface.cross(n));
            turn.spin = spin;
        }
        let memory: Memory<V> = recall::<V, L, LEDGER>(&wall.slots, slots);
        let response = law.respond::<V, LEDGER>(&touch, &turn, memory, step);

        let pick = |v: V3<V>| V3::select(touches, v, V3::zero());
        let press = V::select(touches, response.normal_force, zero);
        let tangential = pick(response.tangential);
        let force = tangential.plus(press, n);
        let friction = V::select(touches, response.friction, zero);
        let viscosity = V::select(touches, response.viscosity, zero);
        let after = response.memory;
        spread(&mut wall.slots.force, slots, force, zero);
        if L::SLIDES {
            let sliding = V::select(touches, after.sliding, zero);
            spread(&mut wall.slots.spring, slots, pick(after.spring), sliding);
        }
        let couple = pick(response.couple);
        let rolling_loss = V::select(touches, response.rolling_loss, zero);
        if L::TURNS {
            let twisting = V::select(touches, after.twisting, zero);
            spread(
                &mut wall.slots.rolling,
                slots,
                pick(after.rolling),
                twisting,
            );
            spread(&mut wall.slots.couple, slots, couple, zero);
        }

        // Where grains do not spin there are no torques: dashpot losses go with the force.
        let booked = if spins { friction } else { viscosity };
        let forces = V::transpose([force.0, force.1, force.2, booked]);
        let arm = L::torque_arm::<V, true>(radius, overlap);
        let torque = couple.minus(arm, n.cross(tangential));
        let torques = V::transpose([torque.0, torque.1, torque.2, viscosity]);
        let (mut pressed, mut rolled) = (Row::ZERO, Row::ZERO);
        press.store(&mut pressed);
        rolling_loss.store(&mut rolled);
        for lane in 0..4.min(wall.count - 4 * group) {
            let own = wall.grains[4 * group + lane].index() - slab.own.start;
            add(&mut slab.force[own], forces[lane]);
            if spins {
                add(&mut slab.torque[own], torques[lane]);
            }
            if L::TURNS && LEDGER {
                slab.rolling_loss[own] += rolled.0[lane];
            }
            gauge[4 * group + lane] = pressed.0[lane];
        }
    }
    slab.walls[k] = wall;
}
