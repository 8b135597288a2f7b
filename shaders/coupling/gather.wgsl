// From the faces to the grains: the transpose of the scatter. One thread a grain. Twin of `gather` in
// coupling/src/faces.rs.
//
// gather   what pushes each grain until the next exchange, and that the walls are pushed so, too
// grip     (renewal) the part of its drag that faces along each axis take

#import dem::control::control
#import coupling::numbers::{numbers, course, step_of, is_made, renews, drags, thread, at_cell, cell_at, KEPT}
#import coupling::sums::beside
#import coupling::kernel::weights
#import dem::boundary::hold_companion

@group(0) @binding(0) var<uniform> tick: u32;
@group(0) @binding(2) var<storage, read_write> kept: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> pushes: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> easing: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> companions: array<vec4<f32>>;
// What the walls do not feel of the force [N], by number of the step in a group: bottom, top.
@group(0) @binding(6) var<storage, read> taken_off: array<vec2<f32>>;

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
    if !is_made(tick) {
        return;
    }
    if g < 2u {
        hold_companion(numbers.walls[g], step_of(tick), numbers.shares[g], taken_off[tick][g]);
    }
    if g >= numbers.grains {
        return;
    }
    let touch = kept[KEPT * g];
    let own = bitcast<vec4<f32>>(kept[KEPT * g + 1u]);
    var force = own.x * sum_of(touch, false) + vec3<f32>(0.0, 0.0, own.z);
    let step = step_of(tick);
    if drags(step) && own.y > 0.0 {
        let velocity = bitcast<vec3<f32>>(kept[KEPT * g + 5u].xyz);
        let grip = bitcast<vec3<f32>>(kept[KEPT * g + 2u].xyz);
        force += course[0].share * own.y * (sum_of(touch, true) - grip * velocity);
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
        let gripped = sum_of(kept[KEPT * g], true);
        kept[KEPT * g + 2u] = vec4<u32>(bitcast<vec3<u32>>(gripped), 0u);
    }
}
