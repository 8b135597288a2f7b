// Counting sort of the grains along the cells.
//
// clear    a cell each    no grain in any cell
// bin      a grain each   its cell, and a place in it: whichever comes first
// scatter  a grain each   into the lists of cells (after the scan of `starts`)
// rank     a grain each   within a cell by identity, so that the order does not depend on
//                         who came first

#import dem::control::control
#import dem::fixed::Place
#import dem::scene::Motion
#import dem::search::plan::{plan, grid, thread, inside, cell_of}

@group(0) @binding(0) var<storage, read> places: array<Place>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
// Number of grains in each cell, then the place of its first one.
@group(0) @binding(2) var<storage, read_write> starts: array<atomic<u32>>;
// Cell of each grain, and its place among those of the cell.
@group(0) @binding(3) var<storage, read_write> bins: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read_write> members: array<u32>;
// Old place of each grain in the new order.
@group(0) @binding(5) var<storage, read_write> order: array<u32>;
// Position inside the box, and radius, in the new order [units].
@group(0) @binding(6) var<storage, read_write> scratch: array<vec4<i32>>; // in parts

@compute @workgroup_size(64)
fn clear(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let c = thread(group, groups, local, 64u);
    if c <= grid.total {
        atomicStore(&starts[c], 0u);
    }
}

@compute @workgroup_size(64)
fn bin(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let k = thread(group, groups, local, 64u);
    if k >= plan.count {
        return;
    }
    let c = cell_of(inside(places[(control.base & 1u) * plan.count + k].hi));
    bins[k] = vec2(c, atomicAdd(&starts[c], 1u));
}

@compute @workgroup_size(64)
fn scatter(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let k = thread(group, groups, local, 64u);
    if k >= plan.count {
        return;
    }
    let bin = bins[k];
    members[atomicLoad(&starts[bin.x]) + bin.y] = k;
}

@compute @workgroup_size(64)
fn rank(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let k = thread(group, groups, local, 64u);
    if k >= plan.count {
        return;
    }
    let half = (control.base & 1u) * plan.count;
    let id = motions[half + k].id;
    let cell = bins[k].x;
    let first = atomicLoad(&starts[cell]);
    let end = atomicLoad(&starts[cell + 1u]);
    var place = first;
    for (var m = first; m < end; m++) {
        place += u32(motions[half + members[m]].id < id);
    }
    let row = places[half + k];
    order[place] = k;
    set_scratch(place, vec4(inside(row.hi), row.radius_hi));
}
