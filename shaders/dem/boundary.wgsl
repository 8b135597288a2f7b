// Walls and driven layer: what moves by sums of forces. Twin of dem/src/boundary.rs.
//
// Step s needs the walls as moved by the forces of step s - 1, which are known only when all
// of that step is done: so every workgroup moves the walls by itself before it begins, and
// one of them keeps the result for the next step. Sums of forces lie in three slots in turn:
// one is read, one is filled, one is emptied.

#define_import_path dem::boundary
#import dem::wide::{Wide, widen, narrow, add, opposite, carry, sums, add_to_sum}
#import dem::scene::scene
#import dem::control::{control, UNSTABLE, FULL}

// A wall, and in the last row the driven layer (its velocity along x).
struct Body {
    offset: Wide,  // coordinate along the axis of the wall, units
    velocity: f32, // along the normal, m/s, half a step behind but for the start's
    unused: u32,
}

// Rows of even and odd steps.
@group(0) @binding(41) var<storage, read_write> bodies: array<Body>;

const WALLS: u32 = #{WALLS}u;
const BODIES: u32 = WALLS + 1u;
// Sums of forces of one step: of each wall, then x forces on the held and the driven layer.
const FORCES: u32 = WALLS + 2u;
const HELD_FORCE: u32 = WALLS;
const DRIVEN_FORCE: u32 = WALLS + 1u;
// The slot of a reading, which is no step.
const READING: u32 = 3u;
// Sums over steps: the same forces, then work of each wall, then the losses.
const TOTALS: u32 = 4u * FORCES;
const WORKS: u32 = TOTALS + FORCES;
// Friction, viscosity, rolling, work of outside forces: in many places, since all workgroups
// add to them and only the host reads them. Then those of a reading.
const LOSSES: u32 = WORKS + WALLS;
const SPREAD: u32 = #{SPREAD}u;
const LOSSES_READ: u32 = LOSSES + 4u * SPREAD;

#ifdef COMPANION
// Forces of what goes along with the grains on each wall, along minus its normal: those that are being
// added up, then those of its last exchange with the grains, which are held until the next one, then
// those of the one before.
const COMPANION: u32 = LOSSES_READ + 4u;
const HELD_COMPANION: u32 = COMPANION + WALLS;

// What of these moves a wall. Twin: dem/src/gpu/scene.rs
struct Relief {
    share: f32,  // of the force
    off: f32,    // N; taken off
    since: u32,  // step of the exchange
    unused: u32,
}

// Of the last exchange, then of the one before.
@group(0) @binding(42) var<storage, read_write> reliefs: array<Relief>;

// That which acts in `step`: walls are moved by the forces of the step before, so in the step after
// an exchange by those that were held until then.
fn companion_force(k: u32, step: u32) -> f32 {
    let row = select(k, WALLS + k, step < reliefs[k].since);
    let force = narrow(sum_of(HELD_COMPANION + row)) / scene.force_scale;
    return reliefs[row].share * force - reliefs[row].off;
}

// The exchange of `step` is over: hold what has been added up for wall `k`. For one thread, after all
// have added.
fn hold_companion(k: u32, step: u32, share: f32, off: f32) {
    reliefs[WALLS + k] = reliefs[k];
    reliefs[k] = Relief(share, off, step, 0u);
    for (var word = 0u; word < 2u; word++) {
        let adding = 2u * (COMPANION + k) + word;
        let held = 2u * (HELD_COMPANION + k) + word;
        atomicStore(&sums[held + 2u * WALLS], atomicLoad(&sums[held]));
        atomicStore(&sums[held], atomicLoad(&sums[adding]));
        atomicStore(&sums[adding], 0u);
    }
}
#endif

// As all threads of a workgroup see them in this step.
var<workgroup> now: array<Body, #{BODIES}>;

fn sum_of(slot: u32) -> Wide {
    return Wide(bitcast<i32>(atomicLoad(&sums[2u * slot])), atomicLoad(&sums[2u * slot + 1u]));
}

fn add_alone(slot: u32, w: Wide) {
    if !add_to_sum(slot, w) {
        atomicOr(&control.flags, FULL);
    }
}

// Velocities of the start belong to its places; those of all later steps stand half a step
// behind. So the first kick is half a one.
fn share_of_kick(step: u32) -> f32 {
    return select(1.0, 0.5, step == 0u);
}

// Share of a turn of the load of wall `k` at `step`: whole turns fall off the upper word.
fn phase(k: u32, step: u32) -> f32 {
    let wall = scene.walls[k];
    // step * turn as 32-bit words: the parts that reach the upper word.
    let a = wall.turn_lo & 0xffffu;
    let b = wall.turn_lo >> 16u;
    let c = step & 0xffffu;
    let d = step >> 16u;
    let low = a * c;
    let middle = b * c + (low >> 16u);
    let cross = a * d + (middle & 0xffffu);
    let high = b * d + (middle >> 16u) + (cross >> 16u);
    let lo = (cross << 16u) | (low & 0xffffu);
    let hi = wall.turn_hi * step + high + wall.start_hi + carry(lo, wall.start_lo);
    return f32(hi) * 2.3283064365386963e-10;
}

// Sine of a share of a turn, 0 to 1. The built-in one may be wrong by 2^-11 of one, and is so on
// some hardware.
fn sine(share: f32) -> f32 {
    // To -1/4 .. 1/4 of a turn, where the sine is the same; then its series, to 4e-8.
    let centred = share - round(share);
    let folded = select(centred, select(-0.5, 0.5, centred > 0.0) - centred, abs(centred) > 0.25);
    let x = 6.283185307179586 * folded;
    let s = x * x;
    return x * (1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s * (1.0 / 362880.0 - s / 39916800.0)))));
}

fn load(k: u32, step: u32) -> f32 {
    let wall = scene.walls[k];
    if wall.amplitude == 0.0 {
        return wall.push;
    }
    return wall.push + wall.amplitude * sine(phase(k, step));
}

// Bring body `k` to `step`. Where `keep` holds the result is stored for the next step.
fn move_body(k: u32, step: u32, keep: bool) {
    if step == 0u {
        now[k] = bodies[k];
        return;
    }
    let last = step - 1u;
    var body = bodies[(last & 1u) * BODIES + k];
    let slot = (last % 3u) * FORCES;
    if k < WALLS {
        let wall = scene.walls[k];
        if wall.kick > 0.0 {
            let force = narrow(sum_of(slot + k)) / scene.force_scale;
            let before = body.velocity;
            var pushed = load(k, last) - force - wall.damping * before;
#ifdef COMPANION
            pushed -= companion_force(k, last);
#endif
            body.velocity += share_of_kick(last) * wall.kick * pushed;
            if keep {
                // F(s) lies between two drifts: half of it belongs to each.
                let drifts = select(before, 0.0, last == 0u) + body.velocity;
                let work = 0.5 * scene.step * force * drifts;
                add_alone(WORKS + k, widen(work * scene.work_scale));
            }
        }
        body.offset = add(body.offset, widen(f32(wall.side) * body.velocity * scene.way));
        // As bits, a speed that is no number is larger than all that are.
        if bitcast<u32>(abs(body.velocity)) > bitcast<u32>(control.limit) {
            atomicOr(&control.flags, UNSTABLE);
        }
    } else if scene.drive_kick > 0.0 {
        let force = narrow(sum_of(slot + DRIVEN_FORCE)) / scene.force_scale;
        body.velocity += share_of_kick(last) * scene.drive_kick * (scene.drive_force + force);
    }
    now[k] = body;
    if keep {
        bodies[(step & 1u) * BODIES + k] = body;
    }
}

// After the last of `move_body`: add the forces of the step before to the sums over steps,
// and empty the slot of the step after.
fn turn_sums(f: u32, step: u32) {
    if step > 0u {
        add_alone(TOTALS + f, sum_of(((step - 1u) % 3u) * FORCES + f));
    }
    let next = ((step + 1u) % 3u) * FORCES + f;
    atomicStore(&sums[2u * next], 0u);
    atomicStore(&sums[2u * next + 1u], 0u);
}

// Velocity of the driven layer after the kick of `step`. A shear stress is known to act only
// when all of the step's forces are, in a dispatch of its own.
fn driven_velocity(step: u32) -> f32 {
#ifdef SHEAR_STRESS
    let slot = (step % 3u) * FORCES + DRIVEN_FORCE;
    let force = narrow(sum_of(slot)) / scene.force_scale;
    let body = bodies[(step & 1u) * BODIES + WALLS];
    return body.velocity + share_of_kick(step) * scene.drive_kick * (scene.drive_force + force);
#else
    return scene.drive_velocity;
#endif
}
