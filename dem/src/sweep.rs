//! The pair loop: forces and torques of all contacts between grains.
//!
//! Pairs stand in groups of four, one for each lane of a vector, touching ones before the
//! others. A round of groups goes through four short loops: choice (which groups have a
//! contact), geometry, law, and scatter (forces added to grains). One long loop would leave
//! the processor waiting for each group; short ones let it overlap groups. Groups without a
//! contact pay for the gap test alone.

use crate::Domain;
use crate::contact::{ContactLaw, Law, Losses, Memory, Response, Springs, Touch, Turn};
use crate::lanes::{Lanes, Place, Row, V3, row, row_mut};
use crate::slab::{Slab, Slots};

/// Groups in one round of the four loops; their scratch stays in the first-level cache.
const ROUND: usize = 16;

/// What the contact kernels read. Rows are in sorted order, followed by the dummies.
pub(crate) struct View<'a> {
    pub law: &'a ContactLaw,
    pub domain: Domain,
    /// Centre, radius.
    pub position: &'a [Row],
    /// Velocity half a step ago, 0.
    pub velocity: &'a [Row],
    /// Angular velocity half a step ago, radius; empty where grains do not spin.
    pub spin: &'a [Row],
    /// Time over which springs grow [s]; zero in the first evaluation.
    pub step: f64,
}

/// Dummies behind the grains: a pair that never touches, and a grain that touches no wall.
pub(crate) const DUMMIES: [Row; 3] = [
    Row([0.0, 0.0, 0.0, 0.0]),
    Row([0.0, 0.0, 1.0, 0.0]),
    Row([0.0, 0.0, 0.0, -1e30]),
];

/// Turns x_i - x_j into the difference of centres and the sum of radii.
const SUM_OF_RADII: Row = Row([1.0, 1.0, 1.0, -1.0]);
/// Reaction: the opposite vector, and no loss, which is booked on i alone.
const REACTION: Row = Row([-1.0, -1.0, -1.0, 0.0]);

/// Index without a check. All indices in the kernels come from the neighbour search, which
/// makes pairs of sorted grains and dummies only.
#[inline(always)]
pub(crate) fn at<T>(slice: &[T], k: usize) -> &T {
    debug_assert!(k < slice.len());
    // SAFETY: see above; checked in builds with debug assertions.
    unsafe { slice.get_unchecked(k) }
}

/// As [`at`], for writing.
#[inline(always)]
pub(crate) fn at_mut<T>(slice: &mut [T], k: usize) -> &mut T {
    debug_assert!(k < slice.len());
    // SAFETY: as in `at`.
    unsafe { slice.get_unchecked_mut(k) }
}

/// Forces of all pairs of `slab`, added to the sums of its own grains.
#[inline(always)]
pub(crate) fn sweep_pairs<V: Lanes, L: Law, const LEDGER: bool>(view: &View, slab: &mut Slab) {
    let law = L::of(view.law);
    let wrap = Wrap::<V>::new(view.domain);
    let step = V::splat(view.step);
    let mut round = Round::<V>::new();
    let mut next = 0;
    while next < slab.pairs.len() {
        let count = choose(view, &wrap, slab, &mut next, &mut round);
        for k in 0..count {
            geometry::<V, L>(view, slab, &mut round, k);
        }
        for k in 0..count {
            respond::<V, L>(&law, &slab.slots, step, &mut round, k);
        }
        for k in 0..count {
            book::<V, L, LEDGER>(&law, &mut slab.slots, step, &mut round, k);
        }
        for k in 0..count {
            scatter::<V, L, LEDGER>(slab, &round, k);
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

/// Where the grains of four pairs are to each other.
#[derive(Clone, Copy)]
struct Apart<V: Lanes> {
    /// From centre j to centre i [m], and its square.
    d: V3<V>,
    squared: V,
    /// Sum of radii [m].
    radii: V,
    touches: V::Mask,
}

impl<V: Lanes> Apart<V> {
    #[inline(always)]
    fn none() -> Self {
        let zero = V::splat(0.0);
        Self {
            d: V3::zero(),
            squared: zero,
            radii: zero,
            touches: zero.greater(zero),
        }
    }
}

/// Shortest image along periodic sides: the box, or nothing where it is open.
struct Wrap<V> {
    length: [V; 2],
    inverse: [V; 2],
}

impl<V: Lanes> Wrap<V> {
    #[inline(always)]
    fn new(domain: Domain) -> Self {
        let inverse = |axis: usize| {
            let periodic = domain.periodic[axis];
            V::splat(if periodic {
                1.0 / domain.size[axis]
            } else {
                0.0
            })
        };
        Self {
            length: [V::splat(domain.size[0]), V::splat(domain.size[1])],
            inverse: [inverse(0), inverse(1)],
        }
    }

    #[inline(always)]
    fn nearest(&self, d: V, axis: usize) -> V {
        (d * self.inverse[axis])
            .round()
            .neg_mul_add(self.length[axis], d)
    }
}

/// From centre j to centre i, and the sum of radii.
#[inline(always)]
fn apart<V: Lanes>(view: &View, wrap: &Wrap<V>, pairs: &[[Place; 2]; 4]) -> (V3<V>, V) {
    let signs = V::load(&SUM_OF_RADII);
    let d0 = difference(view, signs, pairs[0]);
    let d1 = difference(view, signs, pairs[1]);
    let d2 = difference(view, signs, pairs[2]);
    let d3 = difference(view, signs, pairs[3]);
    let [x, y, z, radii] = V::transpose([d0, d1, d2, d3]);
    (V3(wrap.nearest(x, 0), wrap.nearest(y, 1), z), radii)
}

#[inline(always)]
fn difference<V: Lanes>(view: &View, signs: V, [i, j]: [Place; 2]) -> V {
    let x_i = V::load(row(view.position, i));
    V::load(row(view.position, j)).neg_mul_add(signs, x_i)
}

/// Gap test: the next groups, from `next` on, in which a pair touches or did so a step ago;
/// returns how many.
#[inline(always)]
fn choose<V: Lanes>(
    view: &View,
    wrap: &Wrap<V>,
    slab: &mut Slab,
    next: &mut usize,
    round: &mut Round<V>,
) -> usize {
    let mut count = 0;
    while count < ROUND && *next < slab.pairs.len() {
        let group = *next;
        *next += 1;
        let (d, radii) = apart(view, wrap, at(&slab.pairs, group));
        let squared = d.dot(d);
        let touches = (radii * radii).greater(squared);
        round.groups[count] = group as u32;
        round.apart[count] = Apart {
            d,
            radii,
            squared,
            touches,
        };
        let now = V::bits(touches) as u8;
        let was = std::mem::replace(at_mut(&mut slab.touching, group), now);
        count += (now | was != 0) as usize;
    }
    count
}

/// Normal, overlap and velocities of one group. For pairs that do not touch all but the
/// normal is zero: to the law a contact that has parted is one without any pressure.
#[inline(always)]
fn geometry<V: Lanes, L: Law>(view: &View, slab: &Slab, round: &mut Round<V>, k: usize) {
    let pairs = at(&slab.pairs, round.groups[k] as usize);
    let Apart {
        d,
        radii,
        squared,
        touches,
    } = round.apart[k];
    let distance = squared.sqrt();
    let inverse_distance = V::splat(1.0) / distance;
    let normal = d.scale(inverse_distance);
    let overlap = (radii - distance).keep(touches);

    let [vx, vy, vz, _] = V::transpose([
        relative(view.velocity, pairs[0]),
        relative(view.velocity, pairs[1]),
        relative(view.velocity, pairs[2]),
        relative(view.velocity, pairs[3]),
    ]);
    let velocity = V3(vx, vy, vz);
    let separation = velocity.dot(normal);
    let one = V::splat(1.0);
    let mut slip = V3::zero();
    if L::SLIDES {
        let [a, b, c, d] = *pairs;
        let spin = |place| row(view.spin, place);
        let (spin_i, radius_i) = columns([spin(a[0]), spin(b[0]), spin(c[0]), spin(d[0])]);
        let (spin_j, radius_j) = columns([spin(a[1]), spin(b[1]), spin(c[1]), spin(d[1])]);
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

#[inline(always)]
fn relative<V: Lanes>(rows: &[Row], [i, j]: [Place; 2]) -> V {
    V::load(row(rows, i)) - V::load(row(rows, j))
}

/// Four rows as columns.
#[inline(always)]
pub(crate) fn columns<V: Lanes>([a, b, c, d]: [&Row; 4]) -> (V3<V>, V) {
    let [x, y, z, w] = V::transpose([V::load(a), V::load(b), V::load(c), V::load(d)]);
    (V3(x, y, z), w)
}

/// The springs of one group.
#[inline(always)]
pub(crate) fn springs<V: Lanes, L: Law>(slots: &Slots, group: usize) -> Springs<V> {
    let mut springs = Springs::none();
    if L::SLIDES {
        let [x, y, z, sliding] = at(&slots.spring, group);
        springs.tangential = V3::load([x, y, z]);
        springs.sliding = V::load(sliding);
    }
    if L::TURNS {
        let [x, y, z, twisting] = at(&slots.rolling, group);
        springs.rolling = V3::load([x, y, z]);
        springs.twisting = V::load(twisting);
    }
    springs
}

/// What one group lost in the step that led to `after`; its memory is that before it.
#[inline(always)]
pub(crate) fn losses<V: Lanes, L: Law>(
    law: &L,
    touch: &Touch<V>,
    turn: &Turn<V>,
    slots: &Slots,
    group: usize,
    after: &Response<V>,
    step: V,
) -> Losses<V> {
    let [x, y, z] = at(&slots.force, group);
    let mut before = Memory {
        springs: springs::<V, L>(slots, group),
        force: V3::load([x, y, z]),
        couple: V3::zero(),
    };
    if L::TURNS {
        let [x, y, z] = at(&slots.couple, group);
        before.couple = V3::load([x, y, z]);
    }
    law.losses(touch, turn, &before, after, step)
}

/// Springs and forces after the step, for the next one.
#[inline(always)]
pub(crate) fn remember<V: Lanes, L: Law>(
    slots: &mut Slots,
    group: usize,
    force: V3<V>,
    response: &Response<V>,
) {
    let [x, y, z] = at_mut(&mut slots.force, group);
    force.store([x, y, z]);
    if L::SLIDES {
        let [x, y, z, sliding] = at_mut(&mut slots.spring, group);
        response.springs.tangential.store([x, y, z]);
        response.springs.sliding.store(sliding);
    }
    if L::TURNS {
        let [x, y, z, twisting] = at_mut(&mut slots.rolling, group);
        response.springs.rolling.store([x, y, z]);
        response.springs.twisting.store(twisting);
        let [x, y, z] = at_mut(&mut slots.couple, group);
        response.couple.store([x, y, z]);
    }
}

/// The law of one group.
#[inline(always)]
fn respond<V: Lanes, L: Law>(law: &L, slots: &Slots, step: V, round: &mut Round<V>, k: usize) {
    let springs = springs::<V, L>(slots, round.groups[k] as usize);
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
        lost = losses(law, touch, turn, slots, group, response, step);
    }
    let force = response.tangential.plus(response.normal, touch.normal);
    remember::<V, L>(slots, group, force, response);
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
fn scatter<V: Lanes, L: Law, const LEDGER: bool>(slab: &mut Slab, round: &Round<V>, k: usize) {
    let targets = at(&slab.targets, round.groups[k] as usize);
    let reaction = V::load(&REACTION);
    for lane in 0..4 {
        let [i, j] = targets[lane];
        let force = V::load(&round.force[k][lane]);
        add(row_mut(&mut slab.force, i), force);
        react(row_mut(&mut slab.force, j), force, reaction);
        if L::SLIDES {
            let couple = V::load(&round.couple[k][lane]);
            let arm_i = V::splat(round.arms[k][0].0[lane]);
            let arm_j = V::splat(round.arms[k][1].0[lane]);
            let sum = row_mut(&mut slab.torque, i);
            arm_i.neg_mul_add(couple, V::load(sum)).store(sum);
            let sum = row_mut(&mut slab.torque, j);
            arm_j.neg_mul_add(couple, V::load(sum)).store(sum);
        }
        if L::TURNS {
            let turning = &round.turning[k][lane];
            let loss = turning.w();
            let vector = V::load(turning).with_last(V::splat(0.0));
            add(row_mut(&mut slab.torque, i), vector);
            react(row_mut(&mut slab.torque, j), vector, reaction);
            if LEDGER {
                *at_mut(&mut slab.rolling_loss, i.index()) += loss;
            }
        }
    }
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
