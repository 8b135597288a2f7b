// What all stages of the search share: its plan, its grid of cells, and who is where.
// Twin: dem/src/gpu/search/plan.rs

struct Plan {
    count: u32,          // grains
    cell_room: u32,      // most cells
    entry_room: u32,     // most entries of all lists
    touching_room: u32,  // most entries that touch
    lengths: vec2<i32>,  // units; periodic lengths along x and y, 0 where open
    diameter: i32,       // units; mean diameter, for the width of cells
    largest: i32,        // units; largest radius, rounded up
    unit: f32,           // m
    step: f32,           // s
    skins: vec2<f32>,    // m; smallest and largest skin
    every: f32,          // steps between searches that the skin aims at
}

// Cells lie along x slowest and along z fastest, so that neighbours along z are one run.
struct Grid {
    origin: vec3<i32>,   // units
    near: i32,           // units; gaps up to here are in the lists, rounding included
    width: vec3<u32>,    // units
    total: u32,          // cells
    cells: vec3<u32>,
}

@group(0) @binding(61) var<uniform> plan: Plan;
@group(0) @binding(62) var<storage, read_write> grid: Grid;

// Number of a thread in a dispatch over many workgroups of `size` threads.
fn thread(group: vec3<u32>, groups: vec3<u32>, local: u32, size: u32) -> u32 {
    return (group.x + group.y * groups.x) * size + local;
}

// Is there too little room for so many entries, of which the second number touch?
fn crowded(needed: vec2<u32>) -> bool {
    return needed.x > plan.entry_room || needed.y > plan.touching_room;
}

// `hi` brought back into the box along periodic sides.
fn inside(hi: vec3<i32>) -> vec3<i32> {
    var x = hi;
    if plan.lengths.x > 0 {
        x.x = (x.x % plan.lengths.x + plan.lengths.x) % plan.lengths.x;
    }
    if plan.lengths.y > 0 {
        x.y = (x.y % plan.lengths.y + plan.lengths.y) % plan.lengths.y;
    }
    return x;
}

// The shorter of the images of the difference `d` of two places inside the box.
fn nearest_image(d: vec3<i32>) -> vec3<i32> {
    return vec3(shorter(d.x, plan.lengths.x), shorter(d.y, plan.lengths.y), d.z);
}

fn shorter(d: i32, length: i32) -> i32 {
    if d > length - d && length > 0 {
        return d - length;
    }
    if -d > length + d && length > 0 {
        return d + length;
    }
    return d;
}

// The cell of a place inside the box.
fn cell_of(hi: vec3<i32>) -> u32 {
    let at = vec3<u32>(hi - grid.origin);
    return (locate(0u, at.x) * grid.cells.y + locate(1u, at.y)) * grid.cells.z + locate(2u, at.z);
}

// Number of the cell along `axis` at this way from the origin; the last one takes the rest.
fn locate(axis: u32, at: u32) -> u32 {
    return min(at / grid.width[axis], grid.cells[axis] - 1u);
}

// Cells along `axis` that reach from `x - reach` to `x + reach`: the first, and how many.
fn range(axis: u32, x: i32, reach: u32) -> vec2<u32> {
    let at = u32(x - grid.origin[axis]);
    var length = 0u;
    if axis < 2u {
        length = u32(plan.lengths[axis]);
    }
    if length == 0u {
        let first = locate(axis, at - min(at, reach));
        return vec2(first, locate(axis, at + reach) - first + 1u);
    }
    let cells = grid.cells[axis];
    if 2u * reach + grid.width[axis] >= length {
        return vec2(0u, cells);
    }
    let first = locate(axis, (at + length - reach) % length);
    let last = locate(axis, (at + reach) % length);
    return vec2(first, (last + cells - first) % cells + 1u);
}
