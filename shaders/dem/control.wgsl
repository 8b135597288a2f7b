// What the device decides for itself while it makes steps. Twin: dem/src/gpu/control.rs,
// which carries the protocol.

struct Control {
    // Written by the host.
    end: u32,            // the first step that is not asked for
    group: u32,          // steps recorded between two checks
    limit: f32,          // m/s; a body that is faster has run away
    // The skin.
    wanted_skin: f32,    // m; of the next search, unless that adapts it
    // Progress.
    base: u32,           // steps made, and number of the first step of the group
    good: atomic<u32>,   // the first step for which the neighbour lists may miss a pair
    flags: atomic<u32>,
    allowed: f32,        // m/s; up to this speed `good` holds
    // The neighbour lists.
    skin: f32,           // m; gaps up to here are in the lists, 0: no lists yet
    searches: u32,
    searched_at: u32,    // step of the last search
    entries: u32,        // neighbours of all grains, also those that found no room
    touching: u32,       // entries that touched when the last search began
    lost: atomic<u32>,   // of these, those that the new lists lack: 0, or lists are wrong
    // Since the last check, as bits of f32 that are not negative.
    farthest: atomic<u32>, // units squared; way since the last search
    fastest: atomic<u32>,  // m^2/s^2
}

// A body was faster than `limit`, or nowhere.
const UNSTABLE: u32 = 1u;
// The lists need more room than there is.
const CROWDED: u32 = 2u;
// A grain has left the range of positions.
const GONE: u32 = 4u;
// A running sum overflows.
const FULL: u32 = 8u;

@group(0) @binding(60) var<storage, read_write> control: Control;

// May step `step` be made?
fn may_step(step: u32) -> bool {
    return step < min(control.end, atomicLoad(&control.good));
}

// To be told by the dispatch of `step` of the velocity by which a grain moves: an earlier
// number would stop some threads of that dispatch and not others.
fn watch(step: u32, velocity: vec3<f32>) {
    // As bits, a speed that is no number is larger than all that are.
    let speed = bitcast<u32>(dot(velocity, velocity));
    if speed > bitcast<u32>(control.allowed * control.allowed) {
        // This step may still be made: lists matter when forces are next computed.
        atomicMin(&control.good, step + 1u);
        if speed > bitcast<u32>(control.limit * control.limit) {
            atomicOr(&control.flags, UNSTABLE);
        }
    }
}
