// What is told of the cells of a slab: pressure, flux along x, y and z, and content in two
// parts, the second of which is what the first, rounded, does not hold. One thread a cell; it
// changes nothing. Twin: lbm/src/gpu/reading.rs

#import lbm::lattice::Pairs
#import lbm::setting::as_rounded
#import lbm::populations::places
#import lbm::slab::{slab, range, number, at_cell, is_solid, arrived_at, THREADS}
#ifdef POROUS
#import lbm::collide::porous as law
#else
#import lbm::collide::free as law
#endif

struct Sum {
    high: f32,
    low: f32,
}

// After Knuth (1969), The Art of Computer Programming 2, 4.2.2, theorem B.
fn plus(sum: Sum, x: f32) -> Sum {
    let high = as_rounded(sum.high + x);
    let added = as_rounded(high - sum.high);
    let before = as_rounded(high - added);
    return Sum(high, sum.low + ((sum.high - before) + (x - added)));
}

fn plus_three(sum: Sum, x: vec3<f32>) -> Sum {
    return plus(plus(plus(sum, x.x), x.y), x.z);
}

fn plus_pairs(sum: Sum, pairs: Pairs) -> Sum {
    return plus_three(plus_three(plus_three(sum, pairs.axis), pairs.plus), pairs.minus);
}

@compute @workgroup_size(THREADS)
fn see(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let k = number(group, groups, local);
    if k >= range.count {
        return;
    }
    let at = at_cell(k);
    let here = places(at);
    if is_solid(at, here) {
        return;
    }
    let cell = arrived_at(at, here);
    let now = law::moments(here.own, cell);
    let content = plus_pairs(plus_pairs(Sum(cell.rest, 0.0), cell.forward), cell.backward);
    let n = range.count;
    slab[k] = now.pressure;
    slab[n + k] = now.flux.x;
    slab[2u * n + k] = now.flux.y;
    slab[3u * n + k] = now.flux.z;
    slab[4u * n + k] = content.high;
    slab[5u * n + k] = content.low;
}
