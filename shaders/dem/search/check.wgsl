// Are the neighbour lists still good? Protocol: dem/src/gpu/control.rs
//
// settle   one thread     ends a group of steps
// measure  a grain each   farthest way since the last search, highest speed, extent
// decide   one thread     whether a search follows, and how far the lists then are good

#import dem::control::{control, UNSTABLE, GONE}
#import dem::fixed::Place
#import dem::scene::Motion
#import dem::search::plan::{plan, grid, thread, inside, nearest_image}

@group(0) @binding(0) var<storage, read> places: array<Place>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
// Where grains were in the last search [units], x, y, z.
@group(0) @binding(2) var<storage, read> searched: array<i32>;
// Lowest and highest x, y, z [units].
@group(0) @binding(3) var<storage, read_write> extent: array<atomic<i32>, 6>;
// Workgroups of the stages that follow, three numbers each: SIZES in search.rs.
@group(0) @binding(4) var<storage, read_write> sizes: array<u32, 15>;

// Grains stay within this [units], so that no difference overflows.
const FARTHEST: i32 = 0x3fffffff;
const LOWEST: i32 = 0x7fffffff;
const HIGHEST: i32 = -0x7fffffff;

@compute @workgroup_size(1)
fn settle() {
    let done = min(control.end, atomicLoad(&control.good));
    control.base = max(control.base, min(control.base + control.group, done));
}

var<workgroup> most: array<atomic<u32>, 2>;
var<workgroup> bounds: array<atomic<i32>, 6>;

@compute @workgroup_size(256)
fn measure(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if local < 3u {
        atomicStore(&bounds[local], LOWEST);
        atomicStore(&bounds[local + 3u], HIGHEST);
    }
    workgroupBarrier();
    let real = control.base >= atomicLoad(&control.good);
    let k = thread(group, groups, local, 256u);
    if real && k < plan.count {
        let row = (control.base & 1u) * plan.count + k;
        let hi = places[row].hi;
        if any(hi > vec3(FARTHEST)) || any(hi < vec3(-FARTHEST)) {
            atomicOr(&control.flags, GONE);
        }
        for (var axis = 0u; axis < 3u; axis++) {
            atomicMin(&bounds[axis], hi[axis]);
            atomicMax(&bounds[axis + 3u], hi[axis]);
        }
        let then = vec3(searched[3u * k], searched[3u * k + 1u], searched[3u * k + 2u]);
        let way = vec3<f32>(nearest_image(inside(hi) - then));
        atomicMax(&most[0], bitcast<u32>(dot(way, way)));
        let velocity = motions[row].velocity;
        atomicMax(&most[1], bitcast<u32>(dot(velocity, velocity)));
    }
    workgroupBarrier();
    if real && local == 0u {
        atomicMax(&control.farthest, atomicLoad(&most[0]));
        atomicMax(&control.fastest, atomicLoad(&most[1]));
        for (var axis = 0u; axis < 3u; axis++) {
            atomicMin(&extent[axis], atomicLoad(&bounds[axis]));
            atomicMax(&extent[axis + 3u], atomicLoad(&bounds[axis + 3u]));
        }
    }
}

@compute @workgroup_size(1)
fn decide() {
    for (var k = 0u; k < 15u; k++) {
        sizes[k] = 0u;
    }
    if control.base < atomicLoad(&control.good) && atomicLoad(&control.flags) == 0u {
        return;
    }
    let fastest = atomicExchange(&control.fastest, 0u);
    let farthest = atomicExchange(&control.farthest, 0u);
    if fastest > bitcast<u32>(control.limit * control.limit) {
        atomicOr(&control.flags, UNSTABLE);
    }
    atomicStore(&control.good, control.base);
    if atomicLoad(&control.flags) != 0u {
        // Nothing goes on until the host has seen it.
    } else if plan.count == 0u {
        atomicStore(&control.good, control.base + control.group);
        control.allowed = control.limit;
    } else {
        let speed = sqrt(bitcast<f32>(fastest));
        // Both ends of a way are known to a unit.
        let way = (1.00001 * sqrt(bitcast<f32>(farthest)) + 2.0) * plan.unit;
        var reserve = 0.5 * control.skin - way;
        var steps = steps_within(reserve, speed);
        let steps_fresh = max(steps_within(0.5 * control.wanted_skin, speed), 1u);
        if control.skin == 0.0 || steps < steps_fresh {
            adapt_skin();
            reserve = 0.5 * control.wanted_skin;
            steps = max(steps_within(reserve, speed), 1u);
            lay_grid(speed);
        }
        atomicStore(&control.good, control.base + steps);
        control.allowed = min(control.limit, 0.999 * reserve / (f32(steps) * plan.step));
    }
    for (var axis = 0u; axis < 3u; axis++) {
        atomicStore(&extent[axis], LOWEST);
        atomicStore(&extent[axis + 3u], HIGHEST);
    }
}

// Steps, at most those of a group, in which nothing that is a quarter faster than `speed`
// goes farther than `reserve` [m].
fn steps_within(reserve: f32, speed: f32) -> u32 {
    let steps = reserve / max(1.25 * speed * plan.step, 1e-30);
    return u32(clamp(steps, 0.0, f32(control.group)));
}

// Wider where searches follow each other fast, narrower where lists are good for long. Here
// and not on the host, so that it depends on the motion alone.
fn adapt_skin() {
    // A search that is repeated for want of room has adapted it already.
    if control.skin > 0.0 {
        let since = f32(control.base - control.searched_at);
        let skin = control.wanted_skin * clamp(plan.every / since, 0.5, 2.0);
        control.wanted_skin = clamp(skin, plan.skins.x, plan.skins.y);
    }
}

// Lay cells over the grains and let the search follow.
fn lay_grid(speed: f32) {
    // Contacts that touched in the last step may have parted since, by twice its way.
    let skin = control.wanted_skin + 2.001 * speed * plan.step;
    // Rounding of places, radii and products is below 4 units.
    grid.near = i32(ceil(skin / plan.unit)) + 4;
    var low = vec3<i32>();
    var high = vec3<i32>();
    for (var axis = 0u; axis < 3u; axis++) {
        low[axis] = atomicLoad(&extent[axis]);
        high[axis] = atomicLoad(&extent[axis + 3u]);
    }
    for (var axis = 0u; axis < 2u; axis++) {
        if plan.lengths[axis] > 0 {
            low[axis] = 0;
            high[axis] = plan.lengths[axis] - 1;
        }
    }
    let size = vec3<u32>(high - low) + 1u;
    // About as wide as a mean grain; wider where grains are few in much space.
    var width = u32(plan.diameter + grid.near);
    var cells = max(size / width, vec3(1u));
    while too_many(cells) {
        width += width / 4u + 1u;
        cells = max(size / width, vec3(1u));
    }
    grid.origin = low;
    grid.cells = cells;
    grid.width = (size + cells - 1u) / cells;
    grid.total = cells.x * cells.y * cells.z;

    set_size(0u, plan.count, 64u);
    set_size(1u, grid.total + 1u, 64u);
    set_size(2u, grid.total + 1u, 2048u);
    set_size(3u, plan.count + 1u, 2048u);
    set_size(4u, 1u, 1u);
}

// More than there is room for? Exactly: above 2^24 f32 rounds the product, and one cell too many
// would lie outside of its array.
fn too_many(cells: vec3<u32>) -> bool {
    let about = f32(cells.x) * f32(cells.y) * f32(cells.z);
    return about > 4e9 || cells.x * cells.y * cells.z > plan.cell_room;
}

// Workgroups of `share` elements for `count` elements, along x and y.
fn set_size(which: u32, count: u32, share: u32) {
    let groups = (count + share - 1u) / share;
    let y = (groups + 65534u) / 65535u;
    sizes[3u * which] = (groups + y - 1u) / y;
    sizes[3u * which + 1u] = y;
    sizes[3u * which + 2u] = 1u;
}
