// Before a step of the lattice: what faces have collected becomes its source. One thread a cell.
// Twin of `drain` in coupling/src/water/mod.rs.

#import coupling::numbers::{numbers, course, is_made, thread, at_cell}
#import coupling::pressure::{content, collected, bed}
#ifdef THROUGH
#import coupling::pressure::contents
#import lbm::setting::as_rounded
#endif
#ifdef CAVITATION
#import coupling::pressure::{least, vapour}
#endif
#import lbm::setting::setting

@group(0) @binding(0) var<uniform> tick: u32;
// What comes into each place of the lattice in a step of it, over the volume of a cube.
@group(0) @binding(1) var<storage, read_write> sources: array<f32>;
// 0: the lattice is to make no step, since the grains have made none.
@group(0) @binding(2) var<storage, read_write> guard: array<u32>;
#ifdef THROUGH
// Both walls are open. What has flowed upward through each cell [m], and what this sum has rounded
// off so far.
@group(0) @binding(3) var<storage, read_write> through: array<vec2<f32>>;
#endif

@compute @workgroup_size(64)
fn drain(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    let going = is_made(tick);
    if cell == 0u {
        guard[0] = select(0u, 1u, going);
    }
    if !going || cell >= numbers.count {
        return;
    }
#ifdef THROUGH
    // With the flux at the end of the step before; the host adds that of the last one.
    let own = through[cell];
    let way = contents[cell].z * course[0].speed * course[0].passed - own.y;
    let sum = as_rounded(own.x + way);
    through[cell] = vec2<f32>(sum, as_rounded(sum - own.x) - way);
#endif
    let at = at_cell(cell);
    let gone = collected[cell];
    var opens = 0.0;
#ifdef CAVITATION
    // Vapour opens where the pressure would fall below the least, and closes again.
    let room = least(at.z) / bed[cell].z - (content(cell) - gone);
    opens = max(room, -vapour[cell]);
    vapour[cell] += opens;
#endif
    sources[(at.z * setting.extent.y + at.y) * setting.stride + at.x] = (opens - gone) * course[0].source_unit;
    collected[cell] = 0.0;
}
