// The populations of a slab: 19 numbers a cell, in the order of Rust. Twin: lbm/src/gpu/state.rs
//
// take   a thread a cell   what arrived, walls included; changes nothing
// give   a thread a cell   the other way, before an even step

#import lbm::lattice::{Cell, Pairs}
#import lbm::populations::{places, leave}
#import lbm::slab::{slab, range, number, at_cell, is_solid, arrived_at, THREADS}

fn write(k: u32, first: u32, pairs: Pairs) {
    let n = range.count;
    let start = first * n + k;
    slab[start] = pairs.axis.x;
    slab[start + n] = pairs.axis.y;
    slab[start + 2u * n] = pairs.axis.z;
    slab[start + 3u * n] = pairs.plus.x;
    slab[start + 4u * n] = pairs.minus.x;
    slab[start + 5u * n] = pairs.plus.y;
    slab[start + 6u * n] = pairs.minus.y;
    slab[start + 7u * n] = pairs.plus.z;
    slab[start + 8u * n] = pairs.minus.z;
}

fn read(k: u32, first: u32) -> Pairs {
    let n = range.count;
    let start = first * n + k;
    return Pairs(
        vec3<f32>(slab[start], slab[start + n], slab[start + 2u * n]),
        vec3<f32>(slab[start + 3u * n], slab[start + 5u * n], slab[start + 7u * n]),
        vec3<f32>(slab[start + 4u * n], slab[start + 6u * n], slab[start + 8u * n]),
    );
}

@compute @workgroup_size(THREADS)
fn take(
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
    slab[k] = cell.rest;
    write(k, 1u, cell.forward);
    write(k, 10u, cell.backward);
}

@compute @workgroup_size(THREADS)
fn give(
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
    // What arrives along a direction lies where the cell will leave what goes against it.
    leave(here, 0u, Cell(slab[k], read(k, 10u), read(k, 1u)));
}
