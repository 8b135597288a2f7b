// From the faces to the grains: the transpose of the scatter. One thread a grain. Twin of `gather` in
// coupling/src/faces.rs.
//
// gather   what pushes each grain in a step
// grip     (renewal) the part of its drag that faces along each axis take

#import dem::scene::Motion
#import dem::control::control
#import coupling::numbers::{numbers, step_of, is_made, renews, drags, thread, at_cell, cell_at}
#import coupling::sums::beside
#import coupling::kernel::weights

@group(0) @binding(0) var<uniform> tick: u32;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
// Of each grain: where it is in its cell, and the cell; w V [m^3], γ [N s/m], lift [N], and what is
// the renewal's; grip along x, y and z.
@group(0) @binding(2) var<storage, read_write> kept: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> pushes: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> easing: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> companions: array<vec4<f32>>;

// Sum of what faces have, times the weights; `eased`: of `easing` instead of `pushes`.
fn sum_of(touch: vec4<u32>, eased: bool) -> vec3<f32> {
    let w = weights(bitcast<vec3<f32>>(touch.xyz));
    let at = at_cell(touch.w);
    let top = numbers.cells.z - 1u;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < 3u; k++) {
        var z = at.z;
        if k == 0u { z = select(at.z, 1u, at.z == 0u) - 1u; }
        if k == 2u { z = min(at.z + 1u, top); }
        // Faces behind the top have nothing.
        let is_face = k == 1u || (k == 2u && at.z < top);
        for (var j = 0u; j < 3u; j++) {
            for (var i = 0u; i < 3u; i++) {
                let node = beside(at, vec2<u32>(i, j), z);
                var value: vec3<f32>;
                if eased {
                    value = easing[node].xyz;
                } else {
                    value = pushes[node].xyz;
                }
                if i > 0u {
                    sum.x += value.x * w.faces[i - 1u].x * w.cells[j].y * w.cells[k].z;
                }
                if j > 0u {
                    sum.y += value.y * w.cells[i].x * w.faces[j - 1u].y * w.cells[k].z;
                }
                if is_face {
                    sum.z += value.z * w.cells[i].x * w.cells[j].y * w.faces[k - 1u].z;
                }
            }
        }
    }
    return sum;
}

@compute @workgroup_size(64)
fn gather(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if !is_made(tick) || g >= numbers.grains {
        return;
    }
    let touch = kept[3u * g];
    let own = bitcast<vec4<f32>>(kept[3u * g + 1u]);
    var force = own.x * sum_of(touch, false) + vec3<f32>(0.0, 0.0, own.z);
    let step = step_of(tick);
    if drags(step) && own.y > 0.0 {
        let velocity = motions[(step & 1u) * numbers.grains + g].velocity;
        let grip = bitcast<vec3<f32>>(kept[3u * g + 2u].xyz);
        force += own.y * (sum_of(touch, true) - grip * velocity);
    }
    companions[g] = vec4<f32>(force, 0.0);
}

@compute @workgroup_size(64)
fn grip(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let g = thread(group, groups, local);
    if renews() && g < numbers.grains {
        let gripped = sum_of(kept[3u * g], true);
        kept[3u * g + 2u] = vec4<u32>(bitcast<vec3<u32>>(gripped), 0u);
    }
}
