//! The pair loop: forces and torques of all contacts between grains.
//!
//! A block of pairs goes through four short loops: gap test (which pairs touch), geometry,
//! law, and scatter (forces added to grains). One long loop would leave the processor
//! waiting for each batch of four; short ones let it overlap batches. Only touching pairs
//! pay for the law.

use crate::Domain;
use crate::contact::{ContactLaw, Law, Memory, Touch, Turn};
use crate::lanes::{Lanes, Place, Row, V3, row, row_mut};
use crate::slab::{Slab, Slots};
use std::mem::MaybeUninit;

/// Pairs in one round of the four loops; their scratch stays in the first-level cache.
const ROUND: usize = 128;

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
    Row([1.0, 0.0, 0.0, 0.0]),
    Row([0.0, 0.0, 0.0, -1e30]),
];

/// Turns x_i - x_j into the difference of centres and the sum of radii.
const SUM_OF_RADII: Row = Row([1.0, 1.0, 1.0, -1.0]);
/// Reaction: the opposite vector, and no loss, which is booked on i alone.
const REACTION: Row = Row([-1.0, -1.0, -1.0, 0.0]);

/// For each set of touching lanes, their numbers in ascending order.
const LANES: [[u32; 4]; 16] = lane_table();

const fn lane_table() -> [[u32; 4]; 16] {
    let mut table = [[0; 4]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut lane, mut n) = (0, 0);
        while lane < 4 {
            if mask >> lane & 1 == 1 {
                table[mask][n] = lane as u32;
                n += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
}

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
    let mut slots = [0u32; ROUND + 4];
    let mut touches = [const { MaybeUninit::<Touch<V>>::uninit() }; ROUND / 4];
    let mut turns = [const { MaybeUninit::<Turn<V>>::uninit() }; ROUND / 4];
    let mut levers = Levers {
        arm_i: [const { MaybeUninit::uninit() }; ROUND / 4],
        arm_j: [const { MaybeUninit::uninit() }; ROUND / 4],
        inverse_distance: [const { MaybeUninit::uninit() }; ROUND / 4],
        couple: [const { MaybeUninit::uninit() }; ROUND],
    };

    let groups = slab.pair_count.div_ceil(4);
    let dummy = slab.pairs.len() as u32 - 1;
    let mut first = 0;
    while first < groups {
        let last = (first + ROUND / 4).min(groups);
        let count = gap_test::<V, L, LEDGER>(view, &wrap, slab, first..last, &mut slots);
        slots[count..count + 4].fill(dummy);
        let batches = count.div_ceil(4);
        for batch in 0..batches {
            let (touch, turn) = geometry::<V, L>(view, &wrap, slab, &slots, batch, &mut levers);
            touches[batch].write(touch);
            if L::TURNS {
                turns[batch].write(turn);
            }
        }
        for batch in 0..batches {
            // SAFETY: both written just above, the turns where the law reads them.
            let touch = unsafe { touches[batch].assume_init_ref() };
            let none = Turn::none();
            let turn = match L::TURNS {
                true => unsafe { turns[batch].assume_init_ref() },
                false => &none,
            };
            let step = V::splat(view.step);
            respond::<V, L, LEDGER>(
                &law,
                touch,
                turn,
                &mut slab.slots,
                &slots,
                batch,
                step,
                &mut levers,
            );
        }
        for (k, slot) in slots[..count].iter().enumerate() {
            scatter::<V, L, LEDGER>(slab, *slot, k, &levers);
        }
        first = last;
    }
    // Booked now and not when they part: rounds begin elsewhere in other slabs, and the
    // order of sums must not depend on slabs.
    for (i, [sliding, rolling]) in slab.parted.drain(..) {
        slab.force[i.index()].0[3] += sliding;
        if L::TURNS {
            slab.rolling_loss[i.index()] += rolling;
        }
    }
}

/// What the torques of one round are made of.
struct Levers<V> {
    /// Arms of the tangential force [m], four contacts each.
    arm_i: [MaybeUninit<V>; ROUND / 4],
    arm_j: [MaybeUninit<V>; ROUND / 4],
    /// 1 / (arm_i + arm_j).
    inverse_distance: [MaybeUninit<V>; ROUND / 4],
    /// n x f of each contact [N], and minus its dashpot loss over the sum of the arms, so
    /// that the torques of both grains together book the loss once.
    couple: [MaybeUninit<Row>; ROUND],
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
fn apart<V: Lanes>(view: &View, wrap: &Wrap<V>, pairs: [[Place; 2]; 4]) -> (V3<V>, V) {
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

/// Which pairs of the groups touch: writes their slots and returns how many.
#[inline(always)]
fn gap_test<V: Lanes, L: Law, const LEDGER: bool>(
    view: &View,
    wrap: &Wrap<V>,
    slab: &mut Slab,
    groups: std::ops::Range<usize>,
    slots: &mut [u32; ROUND + 4],
) -> usize {
    let mut count = 0;
    for group in groups {
        let p = 4 * group;
        let pairs = [
            *at(&slab.pairs, p),
            *at(&slab.pairs, p + 1),
            *at(&slab.pairs, p + 2),
            *at(&slab.pairs, p + 3),
        ];
        let (d, radii) = apart(view, wrap, pairs);
        let now = V::bits((radii * radii).greater(d.dot(d)));
        let was = std::mem::replace(at_mut(&mut slab.touching, group), now as u8) as u32;
        if was & !now != 0 {
            part::<L, LEDGER>(view.law, slab, p, was & !now);
        }
        let lanes = at(&LANES, now as usize);
        for (k, lane) in lanes.iter().enumerate() {
            *at_mut(slots, count + k) = p as u32 + lane;
        }
        count += now.count_ones() as usize;
    }
    count
}

/// Contacts that have parted forget; what their springs still held will be lost.
#[cold]
#[inline(never)]
fn part<L: Law, const LEDGER: bool>(law: &ContactLaw, slab: &mut Slab, first: usize, lanes: u32) {
    for slot in (first..first + 4).filter(|slot| lanes >> (slot - first) & 1 == 1) {
        if LEDGER && L::SLIDES {
            let energies = slab.slots.get(slot).energies(law);
            slab.parted.push((slab.targets[slot][0], energies));
        }
        slab.slots.set(slot, Default::default());
    }
}

/// Normal, overlap and velocities of the touching pairs of one batch.
#[inline(always)]
fn geometry<V: Lanes, L: Law>(
    view: &View,
    wrap: &Wrap<V>,
    slab: &Slab,
    slots: &[u32; ROUND + 4],
    batch: usize,
    levers: &mut Levers<V>,
) -> (Touch<V>, Turn<V>) {
    let k = 4 * batch;
    let pairs = [
        *at(&slab.pairs, *at(slots, k) as usize),
        *at(&slab.pairs, *at(slots, k + 1) as usize),
        *at(&slab.pairs, *at(slots, k + 2) as usize),
        *at(&slab.pairs, *at(slots, k + 3) as usize),
    ];
    let (d, radii) = apart(view, wrap, pairs);
    let distance = d.dot(d).sqrt();
    let inverse_distance = V::splat(1.0) / distance;
    let normal = d.scale(inverse_distance);
    let overlap = radii - distance;

    let [vx, vy, vz, _] = V::transpose([
        relative(view.velocity, pairs[0]),
        relative(view.velocity, pairs[1]),
        relative(view.velocity, pairs[2]),
        relative(view.velocity, pairs[3]),
    ]);
    let velocity = V3(vx, vy, vz);
    let separation = velocity.dot(normal);
    let mut touch = Touch {
        normal,
        overlap,
        separation,
        slip: V3::zero(),
    };
    let mut turn = Turn::none();
    if L::SLIDES {
        let [a, b, c, d] = pairs;
        let spin = |place| row(view.spin, place);
        let (spin_i, radius_i) = columns([spin(a[0]), spin(b[0]), spin(c[0]), spin(d[0])]);
        let (spin_j, radius_j) = columns([spin(a[1]), spin(b[1]), spin(c[1]), spin(d[1])]);
        let surface = spin_i
            .scale(L::velocity_arm(radius_i, overlap))
            .plus(L::velocity_arm(radius_j, overlap), spin_j);
        let one = V::splat(1.0);
        touch.slip = velocity
            .minus(separation, normal)
            .minus(one, surface.cross(normal));
        at_mut(&mut levers.arm_i, batch).write(L::torque_arm::<V, false>(radius_i, overlap));
        at_mut(&mut levers.arm_j, batch).write(L::torque_arm::<V, false>(radius_j, overlap));
        at_mut(&mut levers.inverse_distance, batch).write(inverse_distance);
        if L::TURNS {
            turn.spin = spin_i.minus(one, spin_j);
            turn.reduced_radius = radius_i * radius_j / (radius_i + radius_j);
        }
    }
    (touch, turn)
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

/// The rows of four slots as columns.
#[inline(always)]
fn gather<V: Lanes>(rows: &[Row], four: [u32; 4]) -> (V3<V>, V) {
    let [a, b, c, d] = four.map(|slot| slot as usize);
    columns([at(rows, a), at(rows, b), at(rows, c), at(rows, d)])
}

/// The memories of four slots.
#[inline(always)]
pub(crate) fn recall<V: Lanes, L: Law, const LEDGER: bool>(
    slots: &Slots,
    four: [u32; 4],
) -> Memory<V> {
    let mut memory = Memory::none();
    if L::SLIDES {
        (memory.spring, memory.sliding) = gather(&slots.spring, four);
    }
    if LEDGER {
        (memory.force, _) = gather(&slots.force, four);
    }
    if L::TURNS {
        (memory.rolling, memory.twisting) = gather(&slots.rolling, four);
        if LEDGER {
            (memory.couple, _) = gather(&slots.couple, four);
        }
    }
    memory
}

/// Columns back to the rows of four slots.
#[inline(always)]
pub(crate) fn spread<V: Lanes>(rows: &mut [Row], four: [u32; 4], v: V3<V>, w: V) {
    let [a, b, c, d] = V::transpose([v.0, v.1, v.2, w]);
    a.store(at_mut(rows, four[0] as usize));
    b.store(at_mut(rows, four[1] as usize));
    c.store(at_mut(rows, four[2] as usize));
    d.store(at_mut(rows, four[3] as usize));
}

/// The law of one batch: new memories into the slots, n x f into `couples`.
#[inline(always)]
fn respond<V: Lanes, L: Law, const LEDGER: bool>(
    law: &L,
    touch: &Touch<V>,
    turn: &Turn<V>,
    memories: &mut Slots,
    slots: &[u32; ROUND + 4],
    batch: usize,
    step: V,
    levers: &mut Levers<V>,
) {
    let k = 4 * batch;
    let four = [
        *at(slots, k),
        *at(slots, k + 1),
        *at(slots, k + 2),
        *at(slots, k + 3),
    ];
    let memory = recall::<V, L, LEDGER>(memories, four);
    let response = law.respond::<V, LEDGER>(touch, turn, memory, step);
    let force = response
        .tangential
        .plus(response.normal_force, touch.normal);
    let after = response.memory;
    if L::SLIDES {
        spread(&mut memories.force, four, force, response.friction);
        spread(&mut memories.spring, four, after.spring, after.sliding);
        let couple = touch.normal.cross(response.tangential);
        let mut lost = V::splat(0.0);
        if LEDGER {
            // SAFETY: `geometry` has written it.
            let share = unsafe { at(&levers.inverse_distance, batch).assume_init() };
            lost = lost - response.viscosity * share;
        }
        let [a, b, c, d] = V::transpose([couple.0, couple.1, couple.2, lost]);
        a.store_new(at_mut(&mut levers.couple, k));
        b.store_new(at_mut(&mut levers.couple, k + 1));
        c.store_new(at_mut(&mut levers.couple, k + 2));
        d.store_new(at_mut(&mut levers.couple, k + 3));
    } else {
        spread(&mut memories.force, four, force, response.viscosity);
    }
    if L::TURNS {
        spread(&mut memories.rolling, four, after.rolling, after.twisting);
        spread(
            &mut memories.couple,
            four,
            response.couple,
            response.rolling_loss,
        );
    }
}

/// Add one contact to the sums of its grains; what is not ours goes to the spare row.
#[inline(always)]
fn scatter<V: Lanes, L: Law, const LEDGER: bool>(
    slab: &mut Slab,
    slot: u32,
    k: usize,
    levers: &Levers<V>,
) {
    let [i, j] = *at(&slab.targets, slot as usize);
    let reaction = V::load(&REACTION);

    let force = V::load(at(&slab.slots.force, slot as usize));
    add(row_mut(&mut slab.force, i), force);
    react(row_mut(&mut slab.force, j), force, reaction);
    if L::SLIDES {
        // SAFETY: `geometry` and `respond` have written the levers of this round.
        let couple = V::load(unsafe { at(&levers.couple, k).assume_init_ref() });
        let arm_i = V::splat(lane(&levers.arm_i, k));
        let arm_j = V::splat(lane(&levers.arm_j, k));
        let sum = row_mut(&mut slab.torque, i);
        arm_i.neg_mul_add(couple, V::load(sum)).store(sum);
        let sum = row_mut(&mut slab.torque, j);
        arm_j.neg_mul_add(couple, V::load(sum)).store(sum);
    }
    if L::TURNS {
        let turning = at(&slab.slots.couple, slot as usize);
        let loss = turning.w();
        let turning = V::load(turning);
        let vector = turning.with_last(V::splat(0.0));
        add(row_mut(&mut slab.torque, i), vector);
        react(row_mut(&mut slab.torque, j), vector, reaction);
        if LEDGER {
            *at_mut(&mut slab.rolling_loss, i.index()) += loss;
        }
    }
}

/// Number `k` of the doubles that make up vectors in memory.
#[inline(always)]
fn lane<V: Lanes>(vectors: &[MaybeUninit<V>], k: usize) -> f64 {
    debug_assert!(size_of::<V>() == 32 && k < 4 * vectors.len());
    // SAFETY: both implementations of `Lanes` are four doubles, written by `geometry`.
    unsafe { *vectors.as_ptr().cast::<f64>().add(k) }
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
