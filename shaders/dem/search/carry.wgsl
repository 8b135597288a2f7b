// Arrays follow the new order, one at a time through `scratch`.
//
// take_rows, put_rows          rows of grains
// take_history, put_history    what touching entries remember; new ones begin at zero

#import dem::control::control
#import dem::search::plan::{plan, crowded, thread}

// How an array of rows lies.
struct Shape {
    width: u32,   // vectors a row
    halves: u32,  // 2 if even and odd steps have their own half, otherwise 1
}

@group(0) @binding(0) var<uniform> shape: Shape;
@group(0) @binding(1) var<storage, read> order: array<u32>;
@group(0) @binding(2) var<storage, read> heads: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> rows: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read_write> scratch: array<vec4<u32>>; // in parts
@group(0) @binding(5) var<storage, read_write> history: array<vec4<u32>>; // in parts
@group(0) @binding(6) var<storage, read> saved_entries: array<u32>; // in parts
@group(0) @binding(7) var<storage, read> origins: array<u32>; // in parts

const NONE: u32 = 0xffffffffu;

// The first vector of the half that holds.
fn half() -> u32 {
    return (control.base & (shape.halves - 1u)) * plan.count * shape.width;
}

@compute @workgroup_size(64)
fn take_rows(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let threads = groups.x * groups.y * 64u;
    let end = select(plan.count * shape.width, 0u, crowded(heads[plan.count]));
    for (var t = thread(group, groups, local, 64u); t < end; t += threads) {
        let old = order[t / shape.width];
        set_scratch(t, rows[half() + old * shape.width + t % shape.width]);
    }
}

@compute @workgroup_size(64)
fn put_rows(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let threads = groups.x * groups.y * 64u;
    let end = select(plan.count * shape.width, 0u, crowded(heads[plan.count]));
    for (var t = thread(group, groups, local, 64u); t < end; t += threads) {
        rows[half() + t] = scratch_at(t);
    }
}

@compute @workgroup_size(64)
fn take_history(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let threads = groups.x * groups.y * 64u;
    let end = select(heads[plan.count].y, 0u, crowded(heads[plan.count]));
    for (var k = thread(group, groups, local, 64u); k < end; k += threads) {
        set_scratch(k, history_at(saved_entries_at(k)));
    }
}

@compute @workgroup_size(64)
fn put_history(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let threads = groups.x * groups.y * 64u;
    let end = select(heads[plan.count].x, 0u, crowded(heads[plan.count]));
    for (var e = thread(group, groups, local, 64u); e < end; e += threads) {
        let origin = origins_at(e);
        if origin == NONE {
            set_history(e, vec4(0u));
        } else {
            set_history(e, scratch_at(origin));
        }
    }
}
