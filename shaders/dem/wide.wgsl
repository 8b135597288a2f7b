// Numbers of two words: hi whole units and lo parts of 2^-32 unit, hi + 2^-32 lo.
//
// Positions are such numbers (dem::fixed), and so are running sums: whole numbers add up to
// the same bits in any order, and lose nothing however many there are. Who uses them chooses
// the unit, a power of two, so that dividing by it rounds nothing.
// Twin: dem/src/gpu/wide.rs

#define_import_path dem::wide

struct Wide {
    hi: i32,
    lo: u32,
}

// 2^32 and its inverse, exact in f32.
const PARTS: f32 = 4294967296.0;
const PART: f32 = 2.3283064365386963e-10;
// Above this many units a number counts as overflowing: there is still room for one more.
const MOST: f32 = 1073741824.0;

// Can x units be widened, and added to a sum that fits? No for what is not a number.
fn fits(x: f32) -> bool {
    // As bits, what is no number is larger than all that are, whatever a compiler takes for granted.
    return (bitcast<u32>(x) & 0x7fffffffu) < bitcast<u32>(MOST);
}

// x units, to the nearest part: exact from 2^-8 units on, where f32 has no finer digits.
// Saturates where x does not fit.
//
// Should a compiler fuse the product that made x into the subtraction below, the remainder
// can come out as a tiny negative number; hence the max. Nothing else here is rounded.
fn widen(x: f32) -> Wide {
    let size = min(abs(x), MOST);
    let whole = floor(size);
    let up = Wide(i32(whole), u32(round(max(size - whole, 0.0) * PARTS)));
    if x < 0.0 {
        return opposite(up);
    }
    return up;
}

// Units, rounded to f32. The sign is taken off first: just below zero both words are large
// and all but cancel.
fn narrow(w: Wide) -> f32 {
    if w.hi < 0 {
        let up = opposite(w);
        return -(f32(up.lo) * PART + f32(up.hi));
    }
    return f32(w.lo) * PART + f32(w.hi);
}

fn opposite(w: Wide) -> Wide {
    return Wide(~w.hi + select(0, 1, w.lo == 0u), ~w.lo + 1u);
}

fn add(a: Wide, b: Wide) -> Wide {
    return Wide(a.hi + b.hi + i32(carry(a.lo, b.lo)), a.lo + b.lo);
}

// What adding `added` to the low word `before` carries into the high one.
fn carry(before: u32, added: u32) -> u32 {
    return select(0u, 1u, before > ~added);
}

// Running sums of all threads, two words each: hi, lo.
@group(0) @binding(63) var<storage, read_write> sums: array<atomic<u32>>;

// Add to running sum `slot`; false if it overflows. Two threads may carry in either order:
// each carry belongs to one addition to the low word, and none is lost.
fn add_to_sum(slot: u32, w: Wide) -> bool {
    let before = atomicAdd(&sums[2u * slot + 1u], w.lo);
    let high = bitcast<u32>(w.hi) + carry(before, w.lo);
    if high == 0u {
        return true;
    }
    let old = atomicAdd(&sums[2u * slot], high);
    return in_range(old + high);
}

// Is a sum with this high word still one that overflows nothing?
fn in_range(high: u32) -> bool {
    let now = bitcast<i32>(high);
    return now > -i32(MOST) && now < i32(MOST);
}
