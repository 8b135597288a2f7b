// The neighbour lists, full: every pair stands in the lists of both grains. One thread, one
// grain of the new order, in the order of the cells around it.
//
// count  near grains, and old entries that touch (before the scan of `heads`)
// save   old entries that touch, while the old lists are still there
// fill   the new lists; entries that touched keep their flags, and know whose history is theirs
//
// If the lists need more room than there is, nothing is changed and CROWDED is set.

#import dem::control::{control, CROWDED}
#import dem::search::plan::{plan, crowded, grid, thread, nearest_image, range}

@group(0) @binding(0) var<storage, read> starts: array<u32>;
@group(0) @binding(1) var<storage, read> order: array<u32>;
// Position and radius in the new order [units].
@group(0) @binding(2) var<storage, read> scratch: array<vec4<i32>>; // in parts
// First entry, and number of entries, of each grain.
@group(0) @binding(3) var<storage, read_write> lists: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read_write> neighbours: array<u32>; // in parts
// Entries, and saved entries, of the grains before each; at the end those of all.
@group(0) @binding(5) var<storage, read_write> heads: array<vec2<u32>>;
// Saved entries: the word of the old neighbour, and the entry it was.
@group(0) @binding(6) var<storage, read_write> saved: array<u32>; // in parts
@group(0) @binding(8) var<storage, read_write> searched: array<i32>;
#ifdef HISTORY
@group(0) @binding(7) var<storage, read_write> saved_entries: array<u32>; // in parts
// The saved entry that each new one continues, or NONE.
@group(0) @binding(9) var<storage, read_write> origins: array<u32>; // in parts
#endif

const INDEX: u32 = 0x3fffffffu;
const TOUCHING: u32 = 0x80000000u;
const NONE: u32 = 0xffffffffu;

// Are grains at `a` and `b` so near that the lists must have them? Some that are a little
// farther may be let in, but always from both sides.
fn near(a: vec4<i32>, b: vec4<i32>) -> bool {
    let d = vec3<f32>(nearest_image(a.xyz - b.xyz));
    let reach = f32(a.w + b.w + grid.near);
    return dot(d, d) <= 1.000004 * reach * reach;
}

// Number of grains near `s`; they are entered into its list if `enter`.
fn walk(s: u32, enter: bool) -> u32 {
    let spot = scratch_at(s);
    let reach = u32(spot.w + plan.largest + grid.near);
    let along_x = range(0u, spot.x, reach);
    let along_y = range(1u, spot.y, reach);
    let along_z = range(2u, spot.z, reach);
    var found = 0u;
    var matched = 0u;
    for (var a = 0u; a < along_x.y; a++) {
        let x = (along_x.x + a) % grid.cells.x;
        for (var b = 0u; b < along_y.y; b++) {
            let y = (along_y.x + b) % grid.cells.y;
            let cell = (x * grid.cells.y + y) * grid.cells.z + along_z.x;
            let end = starts[cell + along_z.y];
            for (var j = starts[cell]; j < end; j++) {
                if j == s || !near(spot, scratch_at(j)) {
                    continue;
                }
                if enter {
                    matched += put(s, heads[s].x + found, j);
                }
                found++;
            }
        }
    }
    if enter && matched != heads[s + 1u].y - heads[s].y {
        atomicAdd(&control.lost, heads[s + 1u].y - heads[s].y - matched);
    }
    return found;
}

// Enter `j` into the list of `s`. Returns 1 if they touched.
fn put(s: u32, entry: u32, j: u32) -> u32 {
    let old = order[j];
    var word = j;
    var origin = NONE;
    for (var k = heads[s].y; k < heads[s + 1u].y; k++) {
        if (saved_at(k) & INDEX) == old {
            word |= saved_at(k) & ~INDEX;
            origin = k;
        }
    }
    set_neighbours(entry, word);
#ifdef HISTORY
    set_origins(entry, origin);
#endif
    return u32(origin != NONE);
}

@compute @workgroup_size(64)
fn count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let s = thread(group, groups, local, 64u);
    if s >= plan.count {
        return;
    }
    let old = lists[order[s]];
    var touching = 0u;
    for (var e = old.x; e < old.x + old.y; e++) {
        touching += neighbours_at(e) >> 31u;
    }
    heads[s] = vec2(walk(s, false), touching);
    if s == 0u {
        heads[plan.count] = vec2(0u, 0u);
    }
}

@compute @workgroup_size(64)
fn save(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let s = thread(group, groups, local, 64u);
    if s >= plan.count {
        return;
    }
    if s == 0u {
        report();
    }
    if crowded(heads[plan.count]) {
        return;
    }
    let old = lists[order[s]];
    var k = heads[s].y;
    for (var e = old.x; e < old.x + old.y; e++) {
        if (neighbours_at(e) & TOUCHING) != 0u {
            set_saved(k, neighbours_at(e));
#ifdef HISTORY
            set_saved_entries(k, e);
#endif
            k++;
        }
    }
}

fn report() {
    control.entries = heads[plan.count].x;
    control.touching = heads[plan.count].y;
    if crowded(heads[plan.count]) {
        atomicOr(&control.flags, CROWDED);
        atomicStore(&control.good, control.base);
        control.skin = 0.0;
    } else {
        control.skin = control.wanted_skin;
        control.searches += 1u;
        control.searched_at = control.base;
    }
}

@compute @workgroup_size(64)
fn fill(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let s = thread(group, groups, local, 64u);
    if s >= plan.count || crowded(heads[plan.count]) {
        return;
    }
    let found = walk(s, true);
    lists[s] = vec2(heads[s].x, found);
    for (var axis = 0u; axis < 3u; axis++) {
        searched[3u * s + axis] = scratch_at(s)[axis];
    }
}
