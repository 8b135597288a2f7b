// How much of the skeleton each grain is, and where its row is. Twin of coupling/src/load.rs.
//
// number     a grain each     rows by identity
// relabel    a slot each      rows of the slots, after a search
// average    a grain each     loads averaged in time, by identity, and sums over workgroups
// mean       one workgroup    their mean, and where the bed is

#import dem::wide::{Wide, add, opposite}
#import dem::scene::Motion
#import dem::control::control
#import dem::boundary::now
#import coupling::numbers::{numbers, course, span, renews, thread}
#import coupling::walls::move_walls

@group(0) @binding(0) var<storage, read> motions: array<Motion>;
@group(0) @binding(1) var<storage, read_write> row_of: array<u32>;
@group(0) @binding(2) var<storage, read_write> slot_rows: array<u32>;
@group(0) @binding(3) var<storage, read> slot_ids: array<u32>;
// Of the contacts in the last step, by row [N].
@group(0) @binding(4) var<storage, read> loads: array<f32>;
// By identity [N].
@group(0) @binding(5) var<storage, read_write> mean_loads: array<f32>;
@group(0) @binding(6) var<storage, read_write> partial_loads: array<f32>;
// Extremes of the bed, to be found (bed.wgsl).
@group(0) @binding(7) var<storage, read_write> extremes: array<u32>;

var<workgroup> partial: array<f32, 64>;

fn add_up(local: u32) {
    for (var stride = 32u; stride > 0u; stride /= 2u) {
        workgroupBarrier();
        if local < stride {
            partial[local] += partial[local + stride];
        }
    }
    workgroupBarrier();
}

@compute @workgroup_size(64)
fn number(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if g < numbers.grains {
        row_of[motions[(control.base & 1u) * numbers.grains + g].id] = g;
    }
}

@compute @workgroup_size(64)
fn relabel(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let slot = thread(group, groups, local);
    if slot < numbers.grains {
        slot_rows[slot] = row_of[slot_ids[slot]];
    }
}

@compute @workgroup_size(64)
fn average(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let id = thread(group, groups, local);
    let going = renews() && id < numbers.grains;
    partial[local] = 0.0;
    if going {
        let before = mean_loads[id];
        let load = before + course[0].memory * (loads[row_of[id]] - before);
        mean_loads[id] = load;
        partial[local] = load;
    }
    add_up(local);
    if going && local == 0u {
        partial_loads[group.x + group.y * groups.x] = partial[0];
    }
}

@compute @workgroup_size(64)
fn mean(@builtin(local_invocation_index) local: u32) {
    let going = renews();
    let count = (numbers.grains + 63u) / 64u;
    partial[local] = 0.0;
    if going {
        for (var k = local; k < count; k += 64u) {
            partial[local] += partial_loads[k];
        }
        move_walls(local, control.base);
    }
    add_up(local);
    if going && local == 0u {
        let bottom = now[numbers.walls.x].offset;
        let bed = add(now[numbers.walls.y].offset, opposite(bottom));
        span[0].bottom = bottom;
        span[0].bed = bed.hi;
        span[0].height = f32(bed.hi) * numbers.unit / f32(numbers.cells.z);
        span[0].mean_load = partial[0] / f32(max(numbers.grains, 1u));
        span[0].half = numbers.loose * span[0].mean_load;
        for (var k = 0u; k < 3u; k++) {
            extremes[2u * k] = 0x7f7fffffu;
            extremes[2u * k + 1u] = 0u;
        }
        for (var k = 6u; k < 9u; k++) {
            extremes[k] = 0u;
        }
    }
}
