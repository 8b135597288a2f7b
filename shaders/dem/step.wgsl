// One time step is one dispatch: forces at x(t) with the velocities half a step behind, kick,
// drift. Twin of dem/src/step.rs.
//
// time_step    LANES threads a grain  a time step; under a shear stress its first half
// move_all     a thread a grain       the second half, once the force on the driven layer is
//                                     known
// measure_all  LANES threads a grain  forces and histories of this instant, changing nothing
//
// With COMPANION something goes along with the grains (dem/src/gpu/companion.rs): its forces are
// there before a step is dispatched. With LOADS the step tells how hard each grain is pressed.

#import dem::wide::{Wide, widen, carry, fits, in_range, add_to_sum}
#import dem::fixed::Place
#import dem::control::{control, may_step, FULL, UNSTABLE}
#import dem::scene::{scene, Motion, Own, HELD, DRIVEN, STILL}
#import dem::boundary::{move_body, turn_sums, driven_velocity, WALLS, BODIES, FORCES, HELD_FORCE, DRIVEN_FORCE, READING, LOSSES, SPREAD, LOSSES_READ}
#import dem::sweep::{places, motions, meet, Sum}
#import dem::walls::touch_wall
#import dem::motion::{owns, move_grain}

@group(0) @binding(0) var<uniform> tick: u32;
// First entry, and number of entries, of each grain.
@group(0) @binding(6) var<storage, read> lists: array<vec2<u32>>;
#ifdef APART
// Force and torque of the contacts of each grain.
@group(0) @binding(16) var<storage, read_write> pushes: array<vec4<f32>>;
#endif
#ifdef OUTSIDE
// Force and torque from outside, by identity; behind those of all grains, what belongs to the
// first kick after they have changed: half of what they were more before.
@group(0) @binding(17) var<storage, read> outside: array<vec4<f32>>;
// Number of that step.
@group(0) @binding(19) var<storage, read> changed: array<u32>;
#endif
#ifdef COMPANION
// What goes along with the grains pushes each of them with [N].
@group(0) @binding(27) var<storage, read> companions: array<vec4<f32>>;
#endif
#ifdef LOADS
// How hard each grain is pressed by its contacts: the sum of their normal forces [N].
@group(0) @binding(28) var<storage, read_write> loads: array<f32>;
#endif

const THREADS: u32 = 64u;
const LANES: u32 = #{LANES}u;
// Sums of a workgroup: forces, and losses (friction, viscosity, rolling, work from outside or of a
// companion).
const GATHERED: u32 = FORCES + 4u;

var<workgroup> partial: array<Sum, #{PARTIALS}>;
var<workgroup> gathered: array<atomic<u32>, #{GATHERED_WORDS}>;

// Add `x` units to sum `k` of the workgroup. Whole numbers: the order does not matter.
fn gather(k: u32, x: f32) {
    if x == 0.0 {
        return;
    }
    if !fits(x) {
        atomicOr(&control.flags, UNSTABLE);
        return;
    }
    let w = widen(x);
    let before = atomicAdd(&gathered[2u * k + 1u], w.lo);
    let high = bitcast<u32>(w.hi) + carry(before, w.lo);
    if high == 0u {
        return;
    }
    let old = atomicAdd(&gathered[2u * k], high);
    if !in_range(old + high) {
        atomicOr(&control.flags, FULL);
    }
}

// Sum `k` of the workgroup to those of all.
fn deliver(k: u32, slot: u32) {
    let w = Wide(bitcast<i32>(atomicLoad(&gathered[2u * k])), atomicLoad(&gathered[2u * k + 1u]));
    if w.hi == 0 && w.lo == 0u {
        return;
    }
    if !add_to_sum(slot, w) {
        atomicOr(&control.flags, FULL);
    }
}

// Move grain `g` under the `force` and `torque` of its contacts, and those from outside.
fn move_one(g: u32, now_step: u32, place: Place, me: Motion, own: Own, force: vec3<f32>, torque: vec3<f32>) {
    let driven = driven_velocity(now_step);
#ifdef OUTSIDE
    let pushed = outside[2u * me.id].xyz;
    let turned = outside[2u * me.id + 1u].xyz;
    var push = force + pushed;
    var turn = torque + turned;
    if now_step == changed[0] {
        push += outside[2u * (scene.count + me.id)].xyz;
        turn += outside[2u * (scene.count + me.id) + 1u].xyz;
    }
    let moved = move_grain(g, now_step, place, me, own, push, turn, driven);
    let work = scene.step * (dot(pushed, moved.velocity) + dot(turned, moved.spin));
    gather(FORCES + 3u, work * scene.energy_scale);
#else
    let moved = move_grain(g, now_step, place, me, own, force, torque, driven);
#ifdef COMPANION
#ifdef LEDGER
    // The force lies between two drifts: half of it belongs to each. There is none before the first.
    let drifts = select(me.velocity, vec3<f32>(0.0), now_step == 0u) + moved.velocity;
    gather(FORCES + 3u, 0.5 * scene.step * dot(companions[g].xyz, drifts) * scene.energy_scale);
#endif
#endif
#endif
}

fn all_of_step(
    group: vec3<u32>,
    groups: vec3<u32>,
    local: u32,
    now_step: u32,
    going: bool,
) {
    let number = group.x + group.y * groups.x;
#ifdef READ
    let keeps = false;
#else
    let keeps = number == 0u;
#endif
    if local < BODIES && going {
        move_body(local, now_step, keeps);
    }
    if local < FORCES && going && keeps {
        turn_sums(local, now_step);
    }
    if local < GATHERED {
        atomicStore(&gathered[2u * local], 0u);
        atomicStore(&gathered[2u * local + 1u], 0u);
    }
    workgroupBarrier();

    let g = (number * THREADS + local) / LANES;
    let lane = local % LANES;
    let half = (now_step & 1u) * scene.count;
    let first = now_step == 0u;
    let acts = going && g < scene.count;
    var sum = Sum();
    var place: Place;
    var me: Motion;
    if acts {
        place = places[half + g];
        me = motions[half + g];
        let list = lists[g];
        for (var e = list.x + lane; e < list.x + list.y; e += LANES) {
            meet(e, half, place, me, first, &sum);
        }
    }
#ifdef SHARED_GRAINS
    partial[local] = sum;
    workgroupBarrier();
    if lane == 0u {
        for (var l = 1u; l < LANES; l++) {
            let other = partial[local + l];
            sum.force += other.force;
            sum.torque += other.torque;
            sum.lost += other.lost;
#ifdef LOADS
            sum.load += other.load;
#endif
        }
    }
#endif
    if acts && lane == 0u {
        let own = owns[g];
        var flags = own.flags;
        for (var k = 0u; k < WALLS; k++) {
            let pressed = touch_wall(k, g, place, me, first, &flags, &sum);
            gather(k, pressed * scene.force_scale);
#ifdef LOADS
            sum.load += max(pressed, 0.0);
#endif
        }
#ifdef LOADS
        loads[g] = sum.load;
#endif
#ifdef COMPANION
        sum.force += companions[g].xyz;
#ifdef READ
#ifdef LEDGER
        // What the step to come has not booked yet of the drift before.
        if !first {
            gather(FORCES + 3u, 0.5 * scene.step * dot(companions[g].xyz, me.velocity) * scene.energy_scale);
        }
#endif
#endif
#endif
        if (own.flags & HELD) != 0u {
            gather(HELD_FORCE, sum.force.x * scene.force_scale);
        }
        if (own.flags & DRIVEN) != 0u {
            gather(DRIVEN_FORCE, sum.force.x * scene.force_scale);
        }
#ifdef LEDGER
        for (var l = 0u; l < 3u; l++) {
            gather(FORCES + l, sum.lost[l] * scene.energy_scale);
        }
#endif
#ifdef APART
        pushes[2u * g] = vec4<f32>(sum.force, 0.0);
        pushes[2u * g + 1u] = vec4<f32>(sum.torque, 0.0);
#else
        move_one(g, now_step, place, me, own, sum.force, sum.torque);
#endif
#ifndef READ
        if flags != own.flags {
            owns[g].flags = flags;
        }
#endif
    }
    workgroupBarrier();
    if local < GATHERED && going {
#ifdef READ
        deliver(local, select(READING * FORCES + local, LOSSES_READ + local - FORCES, local >= FORCES));
#else
        let loss = LOSSES + 4u * (number % SPREAD) + local - FORCES;
        deliver(local, select((now_step % 3u) * FORCES + local, loss, local >= FORCES));
#endif
    }
}

#ifdef READ
@compute @workgroup_size(64)
fn measure_all(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    all_of_step(group, groups, local, control.base, true);
}
#else
@compute @workgroup_size(64)
fn time_step(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let now_step = control.base + tick;
    all_of_step(group, groups, local, now_step, may_step(now_step));
}

#ifdef SHEAR_STRESS
@compute @workgroup_size(64)
fn move_all(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let now_step = control.base + tick;
    if local < GATHERED {
        atomicStore(&gathered[2u * local], 0u);
        atomicStore(&gathered[2u * local + 1u], 0u);
    }
    workgroupBarrier();
    let g = (group.x + group.y * groups.x) * THREADS + local;
    let going = may_step(now_step);
    if going && g < scene.count {
        let row = (now_step & 1u) * scene.count + g;
        move_one(g, now_step, places[row], motions[row], owns[g], pushes[2u * g].xyz, pushes[2u * g + 1u].xyz);
    }
    workgroupBarrier();
    if local == FORCES + 3u && going {
        deliver(local, LOSSES + 4u * (group.x % SPREAD) + 3u);
    }
}
#endif
#endif
