// Motion of the grains: one kick and one drift a step. Twin of dem/src/motion.rs.

#define_import_path dem::motion
#import dem::fixed::{Place, drift}
#import dem::wide::{Wide, widen, add, opposite, PARTS}
#import dem::scene::{scene, Motion, Own, HELD, DRIVEN, STILL}
#import dem::sweep::{places, motions}
#import dem::control::watch
#import dem::boundary::share_of_kick

@group(0) @binding(3) var<storage, read_write> owns: array<Own>;
// What velocities, rounded to f32, do not hold of all kicks so far, in scene.part: the weight of
// a short step is less than the last digit of a fast grain's velocity.
@group(0) @binding(18) var<storage, read_write> remains: array<vec4<i32>>;

// Kicks of more parts than this leave nothing over that would matter beside them, and neither
// does the last digit of a velocity of so many.
const MOST_PARTS: f32 = 1073741824.0;       // 2^30
const FASTEST: f32 = 9007199254740992.0;    // 2^53

// `velocity` after a kick, and what remains of it then. The rounding that the sum suffers is
// found in whole numbers: a compiler may take (a + b) - a for b.
fn kicked(velocity: f32, by: f32, rest: i32) -> Kicked {
    let whole = by + f32(rest) * scene.part;
    let sum = velocity + whole;
    if abs(whole) >= MOST_PARTS * scene.part || abs(sum) >= FASTEST * scene.part {
        return Kicked(sum, 0);
    }
    let units = scene.parts / PARTS;
    let gained = add(widen(sum * units), opposite(widen(velocity * units)));
    return Kicked(sum, i32(round(whole * scene.parts)) - bitcast<i32>(gained.lo));
}

struct Kicked {
    velocity: f32,
    rest: i32,
}

#ifdef SLIDES
// Rotation since it was last put into the orientation, parts of a radian: so small a range
// that each step's share of it keeps its digits.
@group(0) @binding(4) var<storage, read_write> turned: array<vec4<i32>>;
// Unit quaternions, x y z w.
@group(0) @binding(5) var<storage, read_write> orientations: array<vec4<f32>>;

const RADIAN: f32 = 274877906944.0; // 2^38 parts
const FOLD: f32 = 0.00390625;       // 2^-8 rad, 2^30 parts

// `orientation` after a further rotation by the vector `by` [rad]. Sine and cosine are their
// series, as good as f32 below a radian a step: the built-in ones may be wrong by 2^-11 of one.
fn turn(orientation: vec4<f32>, by: vec3<f32>) -> vec4<f32> {
    let s = 0.25 * dot(by, by);
    let axis = 0.5 * by * (1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s / 362880.0))));
    let c = 1.0 + s * (-0.5 + s * (1.0 / 24.0 + s * (-1.0 / 720.0 + s / 40320.0)));
    let q = orientation;
    return normalize(vec4<f32>(c * q.xyz + q.w * axis + cross(axis, q.xyz), c * q.w - dot(axis, q.xyz)));
}

fn rotate(g: u32, spin: vec3<f32>) {
    let by = spin * scene.step;
    if any(abs(by) >= vec3<f32>(FOLD)) {
        orientations[g] = turn(orientations[g], by);
        return;
    }
    let parts = turned[g].xyz + vec3<i32>(round(by * RADIAN));
    if any(abs(parts) >= vec3<i32>(1 << 30u)) {
        orientations[g] = turn(orientations[g], vec3<f32>(parts) / RADIAN);
        turned[g] = vec4<i32>(0);
    } else {
        turned[g] = vec4<i32>(parts, 0);
    }
}
#endif

// Two signed numbers of 16 bits, each a step further.
fn moved_image(image: u32, by: vec3<i32>) -> u32 {
    let x = (bitcast<i32>(image << 16u) >> 16u) + by.x;
    let y = (bitcast<i32>(image) >> 16u) + by.y;
    return (bitcast<u32>(x) & 0xffffu) | (bitcast<u32>(y) << 16u);
}

// Move grain `g` by `step` under `force` and `torque`; `driven` is the velocity of the driven
// layer after this kick. Returns the motion of the drift.
fn move_grain(
    g: u32,
    step: u32,
    place: Place,
    me: Motion,
    own: Own,
    force: vec3<f32>,
    torque: vec3<f32>,
    driven: f32,
) -> Motion {
    let share = share_of_kick(step);
    let by = share * (own.kick * force + scene.step * scene.gravity);
    let rest = remains[g];
    let x = kicked(me.velocity.x, by.x, rest.x);
    let y = kicked(me.velocity.y, by.y, rest.y);
    let z = kicked(me.velocity.z, by.z, rest.z);
    remains[g] = vec4<i32>(x.rest, y.rest, z.rest, 0);
    var velocity = vec3<f32>(x.velocity, y.velocity, z.velocity);
    if (own.flags & HELD) != 0u {
        velocity = vec3<f32>(0.0, 0.0, velocity.z);
    }
    if (own.flags & DRIVEN) != 0u {
        velocity = vec3<f32>(driven, 0.0, velocity.z);
    }
    watch(step, velocity);
    var spin = me.spin;
#ifdef SLIDES
    if (own.flags & STILL) == 0u {
        spin += share * own.twist * torque;
        rotate(g, spin);
    }
#endif
    let to = drift(place.hi, place.lo, velocity * scene.way, scene.length);
    let next = (1u - (step & 1u)) * scene.count + g;
    places[next] = Place(to.hi, place.radius_hi, to.lo, place.radius_lo);
    let moved = Motion(velocity, me.radius, spin, me.id);
    motions[next] = moved;
    let image = moved_image(own.image, to.image);
    if any(to.image != vec3<i32>(0)) {
        owns[g].image = image;
    }
    return moved;
}
