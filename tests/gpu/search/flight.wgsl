// Grains that fly without touching: the spin of a grain is the change of its velocity in a
// step [m/s].
#import dem::control::{control, may_step, watch}
#import dem::fixed::{Place, drift}
#import dem::scene::Motion
#import dem::search::plan::plan

@group(0) @binding(0) var<storage, read_write> places: array<Place>;
@group(0) @binding(1) var<storage, read_write> motions: array<Motion>;
@group(0) @binding(2) var<uniform> tick: u32;

@compute @workgroup_size(64)
fn fly(@builtin(global_invocation_id) id: vec3<u32>) {
    let step = control.base + tick;
    if id.x >= plan.count || !may_step(step) {
        return;
    }
    var place = places[(step & 1u) * plan.count + id.x];
    var motion = motions[(step & 1u) * plan.count + id.x];
    motion.velocity += motion.spin;
    watch(step, motion.velocity);
    let way = motion.velocity * plan.step / plan.unit;
    let moved = drift(place.hi, place.lo, way, vec3<i32>(plan.lengths, 0));
    place.hi = moved.hi;
    place.lo = moved.lo;
    places[(~step & 1u) * plan.count + id.x] = place;
    motions[(~step & 1u) * plan.count + id.x] = motion;
}
