// Positions in fixed point, and overlaps that are exact where it matters.
//
// Grains overlap by millionths of their radius, far below an f32 coordinate's last digit. So
// a coordinate is a two-word number of units (dem::wide), one power of two for all axes, and
// small against the radius. Differences are exact, and the overlap comes from
//   R - |d| = (R² - |d|²) / (R + |d|)
// whose numerator cancels almost wholly: that of the whole units is taken in integers, and
// only the small rest in f32.
//
// Ranges (dem/src/gpu/fixed.rs chooses the unit for them): |hi| < 2^30; reach, that is sum of
// radii + skin, below 2^23 units. Periodic lengths are whole units; 0 where an axis is open.
//
// WGSL leaves it to the compiler whether a * b + c is rounded once or twice. Nothing here
// depends on it: integers are exact, every f32 that must be exact is a whole number below
// 2^24 or that times a power of two, and what is rounded is small against the result.
// Twin: dem/src/gpu/fixed.rs

#define_import_path dem::fixed
#import dem::wide::{Wide, widen, add, PART, PARTS}

// A grain: centre in units, and radius = radius_hi + radius_lo units, radius_lo in
// [-1/2, 1/2).
struct Place {
    hi: vec3<i32>,
    radius_hi: i32,
    lo: vec3<u32>,
    radius_lo: f32,
}

// A difference of two coordinates: whole units and a rest in [-1/2, 1/2].
struct Offset {
    hi: i32,
    lo: f32,
}

// A difference of two places.
struct Apart {
    hi: vec3<i32>,
    lo: vec3<f32>,
}

// a - b. A rest of one half is rounded away from zero, so that b - a is the exact opposite.
fn offset(a: Wide, b: Wide) -> Offset {
    let parts = a.lo - b.lo;
    let below = a.hi - b.hi - select(0, 1, a.lo < b.lo);
    let up = parts > 0x80000000u || (parts == 0x80000000u && below >= 0);
    // As a signed number the parts are those of the nearer whole unit; the tie has two.
    let rest = f32(bitcast<i32>(parts)) * PART;
    return Offset(below + select(0, 1, up), select(rest, abs(rest), !up));
}

// From b to a along the shortest way: exchanging a and b gives the exact opposite.
fn difference(a_hi: vec3<i32>, a_lo: vec3<u32>, b_hi: vec3<i32>, b_lo: vec3<u32>, length: vec3<i32>) -> Apart {
    let x = offset(Wide(a_hi.x, a_lo.x), Wide(b_hi.x, b_lo.x));
    let y = offset(Wide(a_hi.y, a_lo.y), Wide(b_hi.y, b_lo.y));
    let z = offset(Wide(a_hi.z, a_lo.z), Wide(b_hi.z, b_lo.z));
    let hi = vec3<i32>(x.hi, y.hi, z.hi);
    // Whole units, so hi > length / 2 and hi > floor(length / 2) are the same.
    let half = length >> vec3<u32>(1u);
    let down = select(vec3<i32>(0), length, hi > half);
    let up = select(vec3<i32>(0), length, hi < -half);
    return Apart(hi - down + up, vec3<f32>(x.lo, y.lo, z.lo));
}

// From centre j to centre i.
fn apart(i: Place, j: Place, length: vec3<i32>) -> Apart {
    return difference(i.hi, i.lo, j.hi, j.lo, length);
}

// A difference as it is, in units.
fn in_units(d: Apart) -> vec3<f32> {
    return vec3<f32>(d.hi) + d.lo;
}

// R² - |d|² in units², for R = reach_hi + reach_lo units with |reach_lo| <= 1: positive where
// the way d is shorter than R. The same bits for d and -d.
//
// R_hi² - |d_hi|² as 32-bit integers is right but for a multiple of 2^32, and as f32 right to
// 2^-22 of R²: together they tell which multiple, for ways up to 2^24 units. The exact
// integer is then rounded once. Beyond 2^24 the result keeps its sign and f32's accuracy.
fn closeness(d: Apart, reach_hi: i32, reach_lo: f32) -> f32 {
    let h = vec3<f32>(d.hi);
    let r = f32(reach_hi);
    let squares = d.hi * d.hi;
    let residue = f32(reach_hi * reach_hi - squares.x - squares.y - squares.z);
    let about = r * r - dot(h, h);
    let exact = round((about - residue) * PART) * PARTS + residue;
    let rest = 2.0 * (r * reach_lo - dot(h, d.lo)) + (reach_lo * reach_lo - dot(d.lo, d.lo));
    return exact + rest;
}

// Where two grains touch.
struct Gap {
    normal: vec3<f32>, // unit vector along d
    distance: f32,     // |d| [m]
    overlap: f32,      // R - |d| [m], negative if apart
}

// The same reach as in `closeness`, and what that returned.
fn gap(d: Apart, reach_hi: i32, reach_lo: f32, closeness: f32, unit: f32) -> Gap {
    let way = in_units(d);
    let squared = dot(way, way);
    let inverse = inverseSqrt(squared);
    let distance = squared * inverse;
    let overlap = closeness / (f32(reach_hi) + reach_lo + distance);
    return Gap(way * inverse, distance * unit, overlap * unit);
}

// From `then` to `now`, in units, along the shortest way.
fn displacement(now_hi: vec3<i32>, now_lo: vec3<u32>, then_hi: vec3<i32>, then_lo: vec3<u32>, length: vec3<i32>) -> vec3<f32> {
    return in_units(difference(now_hi, now_lo, then_hi, then_lo, length));
}

// Overlap [m] of a grain and a wall across an axis, negative if apart: `x` and `wall` are
// coordinates on it, `side` is 1 if the grains lie above the wall, -1 if below.
fn wall_overlap(x: Wide, radius_hi: i32, radius_lo: f32, wall: Wide, side: i32, unit: f32) -> f32 {
    let d = offset(x, wall);
    let whole = radius_hi - side * d.hi;
    return (f32(whole) + (radius_lo - f32(side) * d.lo)) * unit;
}

// A place after a drift, and how often it left the box: 1 through the upper side, -1 through
// the lower one.
struct Drifted {
    hi: vec3<i32>,
    lo: vec3<u32>,
    image: vec3<i32>,
}

// Move by `way` units, less than 2^30 and than the length of a periodic axis, whose
// coordinates stay in [0, length).
fn drift(hi: vec3<i32>, lo: vec3<u32>, way: vec3<f32>, length: vec3<i32>) -> Drifted {
    let x = add(Wide(hi.x, lo.x), widen(way.x));
    let y = add(Wide(hi.y, lo.y), widen(way.y));
    let z = add(Wide(hi.z, lo.z), widen(way.z));
    let to = vec3<i32>(x.hi, y.hi, z.hi);
    let periodic = length > vec3<i32>(0);
    let over = periodic & (to >= length);
    let under = periodic & (to < vec3<i32>(0));
    let image = select(vec3<i32>(0), vec3<i32>(1), over) - select(vec3<i32>(0), vec3<i32>(1), under);
    return Drifted(to - image * length, vec3<u32>(x.lo, y.lo, z.lo), image);
}
