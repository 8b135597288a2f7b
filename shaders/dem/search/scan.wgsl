// Exclusive prefix sums of any length, in place: `sums` of blocks, `top` over the blocks,
// then `scan` within each. With PAIRS two sums run side by side.
// After Blelloch (1990), Prefix sums and their applications, CMU-CS-90-190.

#import dem::search::plan::{plan, grid}

#ifdef PAIRS
alias Item = vec2<u32>;
fn length() -> u32 { return plan.count + 1u; }
#else
alias Item = u32;
fn length() -> u32 { return grid.total + 1u; }
#endif

@group(0) @binding(0) var<storage, read_write> items: array<Item>;
@group(0) @binding(1) var<storage, read_write> blocks: array<Item>;

const THREADS: u32 = 256u;
// Items of a thread.
const EACH: u32 = 8u;
const BLOCK: u32 = 2048u;

var<workgroup> partial: array<Item, THREADS>;

// Sum over the threads before this one.
fn before(local: u32, own: Item) -> Item {
    partial[local] = own;
    workgroupBarrier();
    for (var stride = 1u; stride < THREADS; stride *= 2u) {
        var sum = partial[local];
        if local >= stride {
            sum += partial[local - stride];
        }
        workgroupBarrier();
        partial[local] = sum;
        workgroupBarrier();
    }
    return partial[local] - own;
}

@compute @workgroup_size(THREADS)
fn sums(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let block = group.x + group.y * groups.x;
    var sum = Item();
    for (var k = 0u; k < EACH; k++) {
        let at = block * BLOCK + k * THREADS + local;
        if at < length() {
            sum += items[at];
        }
    }
    let all = before(local, sum) + sum;
    if local == THREADS - 1u && block * BLOCK < length() {
        blocks[block] = all;
    }
}

@compute @workgroup_size(THREADS)
fn top(@builtin(local_invocation_index) local: u32) {
    let count = (length() + BLOCK - 1u) / BLOCK;
    let share = (count + THREADS - 1u) / THREADS;
    let first = min(local * share, count);
    let end = min(first + share, count);
    var sum = Item();
    for (var k = first; k < end; k++) {
        sum += blocks[k];
    }
    sum = before(local, sum);
    for (var k = first; k < end; k++) {
        let own = blocks[k];
        blocks[k] = sum;
        sum += own;
    }
}

@compute @workgroup_size(THREADS)
fn scan(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let block = group.x + group.y * groups.x;
    let first = block * BLOCK + local * EACH;
    let end = min(first + EACH, length());
    var sum = Item();
    for (var k = first; k < end; k++) {
        sum += items[k];
    }
    sum = before(local, sum);
    if first < end {
        sum += blocks[block];
    }
    for (var k = first; k < end; k++) {
        let own = items[k];
        items[k] = sum;
        sum += own;
    }
}
