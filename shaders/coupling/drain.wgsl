// Before a step of the lattice: what faces have collected becomes its source. One thread a cell.
// Twin of `drain` in coupling/src/water/mod.rs.

#import coupling::numbers::{numbers, course, is_made, thread, at_cell}
#import coupling::pressure::{content, collected, bed}
#ifdef CAVITATION
#import coupling::pressure::{least, vapour}
#endif
#import lbm::setting::setting

@group(0) @binding(0) var<uniform> tick: u32;
// What comes into each place of the lattice in a step of it, over the volume of a cube.
@group(0) @binding(1) var<storage, read_write> sources: array<f32>;
// 0: the lattice is to make no step, since the grains have made none.
@group(0) @binding(2) var<storage, read_write> guard: array<u32>;

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
