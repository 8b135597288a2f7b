// Are all populations at rest numbers? A moving one that is none spreads to these. One thread
// a place. Twin of Populations::finite in lbm/src/populations.rs.

#import lbm::setting::setting
#import lbm::populations::fetch_rest

@group(0) @binding(34) var<storage, read_write> wrong: array<atomic<u32>>;

@compute @workgroup_size(64)
fn finite(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let place = (group.x + group.y * groups.x) * 64u + local;
    if place >= setting.step {
        return;
    }
    // In bits: a compiler may take it that there are no others than numbers.
    let exponent = bitcast<u32>(fetch_rest(place)) & 0x7f800000u;
    if exponent == 0x7f800000u {
        atomicOr(&wrong[0], 1u);
    }
}
