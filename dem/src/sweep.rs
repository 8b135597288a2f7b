//! The pair loop: forces and torques of all contacts between grains.
//!
//! Pairs stand in groups of four, one for each lane of a vector, touching ones before the
//! others. A round of groups goes through five short loops: choice (which groups have a
//! contact), geometry, law, books (losses and memory), and scatter (forces added to grains). One long loop would leave
//! the processor waiting for each group; short ones let it overlap groups. Groups without a
//! contact pay for the gap test alone.

use crate::contact::{Law, Losses, Response, Touch, Turn};
use crate::lanes::{Lanes, Row, V3, row_mut};
use crate::slab::Slab;
use crate::slots::Slots;
use crate::view::{Apart, View, Wrap};

/// Groups in one round of the loops; their scratch stays in the first-level cache.
const ROUND: usize = 16;

/// Reaction: the opposite vector, and no loss, which is booked on i alone.
const REACTION: Row = Row([-1.0, -1.0, -1.0, 0.0]);

/// Forces of all pairs of `slab`, added to the sums of its own grains.
///
/// # Safety
/// The slab was cut for the rows of `view`: its places lie in them. The same holds for the
/// loops below.
#[inline(always)]
pub(crate) unsafe fn sweep_pairs<V: Lanes, L: Law, const LEDGER: bool>(
    view: &View,
    slab: &mut Slab,
) {
    let law = L::of(view.law);
    let wrap = Wrap::<V>::new(view.domain);
    let step = V::splat(view.step);
    let mut round = Round::<V>::new();
    let mut next = 0;
    while next < slab.pairs.len() {
        // SAFETY: the caller's promise, as for the other loops.
        let count = unsafe { choose(view, &wrap, slab, &mut next, &mut round) };
        for k in 0..count {
            unsafe { geometry::<V, L>(view, slab, &mut round, k) };
        }
        for k in 0..count {
            respond::<V, L>(&law, &slab.slots, step, &mut round, k);
        }
        for k in 0..count {
            book::<V, L, LEDGER>(&law, &mut slab.slots, step, &mut round, k);
        }
        for k in 0..count {
            unsafe { scatter::<V, L, LEDGER>(slab, &round, k) };
        }
    }
}

/// The groups of one round, and what the loops hand on to each other.
struct Round<V: Lanes> {
    groups: [u32; ROUND],
    apart: [Apart<V>; ROUND],
    touch: [Touch<V>; ROUND],
    turn: [Turn<V>; ROUND],
    response: [Response<V>; ROUND],
    /// 1 / distance.
    inverse_distance: [V; ROUND],
    /// Arms of the tangential force on i and j [m].
    arms: [[Row; 2]; ROUND],
    /// Force on i [N], and friction loss [J]; one row a contact, as in the next two.
    force: [[Row; 4]; ROUND],
    /// n x f [N], and minus the dashpot loss over the sum of the arms, so that the torques
    /// of both grains together book the loss once.
    couple: [[Row; 4]; ROUND],
    /// Rolling and twisting torque on i [N m], and their loss [J].
    turning: [[Row; 4]; ROUND],
}

impl<V: Lanes> Round<V> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            groups: [0; ROUND],
            apart: [Apart::none(); ROUND],
            touch: [Touch::none(); ROUND],
            turn: [Turn::none(); ROUND],
            response: [Response::none(); ROUND],
            inverse_distance: [V::splat(0.0); ROUND],
            arms: [[Row::ZERO; 2]; ROUND],
            force: [[Row::ZERO; 4]; ROUND],
            couple: [[Row::ZERO; 4]; ROUND],
            turning: [[Row::ZERO; 4]; ROUND],
        }
    }
}

/// Gap test: the next groups, from `next` on, in which a pair touches or did so a step ago;
/// returns how many.
#[inline(always)]
unsafe fn choose<V: Lanes>(
    view: &View,
    wrap: &Wrap<V>,
    slab: &mut Slab,
    next: &mut usize,
    round: &mut Round<V>,
) -> usize {
    let mut count = 0;
    let first = *next;
    let groups = slab.pairs[first..].iter().zip(&mut slab.touching[first..]);
    for (group, (pairs, touching)) in groups.enumerate() {
        if count == ROUND {
            break;
        }
        // SAFETY: the slab was cut for these rows.
        let apart = unsafe { view.apart(wrap, pairs) };
        round.groups[count] = (first + group) as u32;
        round.apart[count] = apart;
        let now = V::bits(apart.touches) as u8;
        let was = std::mem::replace(touching, now);
        count += (now | was != 0) as usize;
        *next += 1;
    }
    count
}

/// Normal, overlap and velocities of one group. For pairs that do not touch all but the
/// normal is zero: to the law a contact that has parted is one without any pressure.
#[inline(always)]
unsafe fn geometry<V: Lanes, L: Law>(view: &View, slab: &Slab, round: &mut Round<V>, k: usize) {
    let pairs = &slab.pairs[round.groups[k] as usize];
    let Apart {
        d,
        squared,
        radii,
        touches,
    } = round.apart[k];
    let distance = squared.sqrt();
    let inverse_distance = V::splat(1.0) / distance;
    let normal = d.scale(inverse_distance);
    let overlap = (radii - distance).keep(touches);

    // SAFETY: the slab was cut for these rows.
    let velocity = unsafe { view.relative_velocity::<V>(pairs) };
    let separation = velocity.dot(normal);
    let one = V::splat(1.0);
    let mut slip = V3::zero();
    if L::SLIDES {
        // SAFETY: as above, and a law that slides has grains that spin.
        let (spin_i, radius_i) = unsafe { view.spins(pairs, 0) };
        let (spin_j, radius_j) = unsafe { view.spins(pairs, 1) };
        let surface = spin_i
            .scale(L::velocity_arm(radius_i, overlap))
            .plus(L::velocity_arm(radius_j, overlap), spin_j);
        slip = velocity
            .minus(separation, normal)
            .minus(one, surface.cross(normal));
        let arms = &mut round.arms[k];
        L::torque_arm::<V, false>(radius_i, overlap).store(&mut arms[0]);
        L::torque_arm::<V, false>(radius_j, overlap).store(&mut arms[1]);
        round.inverse_distance[k] = inverse_distance;
        if L::TURNS {
            round.turn[k] = Turn {
                spin: spin_i.minus(one, spin_j).keep(touches),
                reduced_radius: radius_i * radius_j / (radius_i + radius_j),
            };
        }
    }
    round.touch[k] = Touch {
        normal,
        overlap,
        separation: separation.keep(touches),
        slip: slip.keep(touches),
        closed: one.keep(touches),
    };
}

/// The law of one group.
#[inline(always)]
fn respond<V: Lanes, L: Law>(law: &L, slots: &Slots, step: V, round: &mut Round<V>, k: usize) {
    let springs = slots.springs::<V, L>(round.groups[k] as usize);
    let response = law.respond(&round.touch[k], &round.turn[k], &springs, step);
    // Not the whole: parts that the law does not use would cost a store each.
    let kept = &mut round.response[k];
    kept.normal = response.normal;
    if L::SLIDES {
        kept.tangential = response.tangential;
        kept.springs.tangential = response.springs.tangential;
        kept.springs.sliding = response.springs.sliding;
    }
    if L::TURNS {
        kept.couple = response.couple;
        kept.springs.rolling = response.springs.rolling;
        kept.springs.twisting = response.springs.twisting;
    }
}

/// Losses, memories and rows for the scatter of one group.
#[inline(always)]
fn book<V: Lanes, L: Law, const LEDGER: bool>(
    law: &L,
    slots: &mut Slots,
    step: V,
    round: &mut Round<V>,
    k: usize,
) {
    let group = round.groups[k] as usize;
    let (touch, turn, response) = (&round.touch[k], &round.turn[k], &round.response[k]);
    let mut lost = Losses::none();
    if LEDGER {
        let before = slots.memory::<V, L>(group);
        lost = law.losses(touch, turn, &before, response, step);
    }
    let force = response.tangential.plus(response.normal, touch.normal);
    slots.remember::<V, L>(group, force, response);
    if L::SLIDES {
        force.store_rows(lost.friction, &mut round.force[k]);
        let share = V::splat(0.0) - lost.viscosity * round.inverse_distance[k];
        let couple = touch.normal.cross(response.tangential);
        couple.store_rows(share, &mut round.couple[k]);
    } else {
        force.store_rows(lost.viscosity, &mut round.force[k]);
    }
    if L::TURNS {
        response
            .couple
            .store_rows(lost.rolling, &mut round.turning[k]);
    }
}

/// Add the contacts of one group to the sums of their grains; what is not ours goes to the
/// spare row.
#[inline(always)]
unsafe fn scatter<V: Lanes, L: Law, const LEDGER: bool>(
    slab: &mut Slab,
    round: &Round<V>,
    k: usize,
) {
    let targets = &slab.targets[round.groups[k] as usize];
    let reaction = V::load(&REACTION);
    for (lane, &[i, j]) in targets.iter().enumerate() {
        let force = V::load(&round.force[k][lane]);
        // SAFETY: targets are own grains or the spare row; so below.
        unsafe {
            add(row_mut(&mut slab.force, i), force);
            react(row_mut(&mut slab.force, j), force, reaction);
        }
        if L::SLIDES {
            let couple = V::load(&round.couple[k][lane]);
            let [arm_i, arm_j] = &round.arms[k];
            // SAFETY: as above, and a law that slides has torques.
            unsafe {
                twist(row_mut(&mut slab.torque, i), arm_i.0[lane], couple);
                twist(row_mut(&mut slab.torque, j), arm_j.0[lane], couple);
            }
        }
        if L::TURNS {
            let turning = &round.turning[k][lane];
            let loss = turning.w();
            let vector = V::load(turning).with_last(V::splat(0.0));
            // SAFETY: as above.
            unsafe {
                add(row_mut(&mut slab.torque, i), vector);
                react(row_mut(&mut slab.torque, j), vector, reaction);
            }
            if LEDGER {
                slab.rolling_loss[i.index()] += loss;
            }
        }
    }
}

/// Subtract the torque of `couple` on `arm`.
#[inline(always)]
fn twist<V: Lanes>(sum: &mut Row, arm: f64, couple: V) {
    V::splat(arm).neg_mul_add(couple, V::load(sum)).store(sum);
}

/// Add the reaction to `what`.
#[inline(always)]
fn react<V: Lanes>(sum: &mut Row, what: V, reaction: V) {
    what.mul_add(reaction, V::load(sum)).store(sum);
}

#[inline(always)]
pub(crate) fn add<V: Lanes>(sum: &mut Row, what: V) {
    (V::load(sum) + what).store(sum);
}
