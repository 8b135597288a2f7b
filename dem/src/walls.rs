//! Contacts of grains with walls.
//!
//! The wall is the body j: its surface has no curvature and no spin. Arms and reduced
//! radius are those of the grain alone. All near grains of a wall go through the law,
//! touching or not: they are few.

use crate::WallState;
use crate::contact::{Law, Losses, Touch, Turn};
use crate::lanes::{Lanes, Place, Row, V3};
use crate::slab::Slab;
use crate::sweep::add;
use crate::view::{View, columns};
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
    let one = V::splat(1.0);
    let n = V3(V::splat(normal.x), V::splat(normal.y), V::splat(normal.z));
    let step = V::splat(view.step);

    for group in 0..wall.count.div_ceil(4) {
        let grains = &wall.grains[4 * group..4 * group + 4];
        let (x, radius) = columns::<V>(rows(view.position, grains));
        let overlap = radius - (x.dot(n) - V::splat(state.offset));
        // A grain that just touches counts: its dashpot does, as in the reference trajectories.
        let touches = overlap.greater(V::splat(-f64::MIN_POSITIVE));
        let now = V::bits(touches);
        let was = std::mem::replace(&mut wall.touching[group], now as u8) as u32;
        if now | was == 0 {
            gauge[4 * group..wall.count.min(4 * group + 4)].fill(0.0);
            continue;
        }

        let (v, _) = columns::<V>(rows(view.velocity, grains));
        let velocity = v.minus(V::splat(state.velocity), n);
        let separation = velocity.dot(n);
        let mut touch = Touch {
            normal: n,
            overlap: overlap.keep(touches),
            separation: separation.keep(touches),
            slip: V3::zero(),
            closed: one.keep(touches),
        };
        let mut turn = Turn::none();
        if L::SLIDES {
            let (spin, _) = columns::<V>(rows(view.spin, grains));
            let surface = spin.scale(L::velocity_arm(radius, overlap));
            let slip = velocity.minus(separation, n).minus(one, surface.cross(n));
            touch.slip = slip.keep(touches);
            turn = Turn {
                spin: spin.keep(touches),
                reduced_radius: radius,
            };
        }
        let before = wall.slots.memory::<V, L>(group);
        let response = law.respond(&touch, &turn, &before.springs, step);
        let mut lost = Losses::none();
        if LEDGER {
            lost = law.losses(&touch, &turn, &before, &response, step);
        }
        let force = response.tangential.plus(response.normal, n);
        wall.slots.remember::<V, L>(group, force, &response);

        // Where grains do not spin there are no torques: dashpot losses go with the force.
        let booked = if spins { lost.friction } else { lost.viscosity };
        let forces = V::transpose([force.0, force.1, force.2, booked]);
        let arm = L::torque_arm::<V, true>(radius, overlap);
        let torque = response.couple.minus(arm, n.cross(response.tangential));
        let torques = V::transpose([torque.0, torque.1, torque.2, lost.viscosity]);
        let (mut pressed, mut rolled) = (Row::ZERO, Row::ZERO);
        response.normal.store(&mut pressed);
        lost.rolling.store(&mut rolled);
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

#[inline(always)]
fn rows<'a>(rows: &'a [Row], grains: &[Place]) -> [&'a Row; 4] {
    [0, 1, 2, 3].map(|lane| &rows[grains[lane].index()])
}
