// What faces push their grains with, and walls. One thread a cell, for its lower faces. Twin of
// `push` in coupling/src/faces.rs.
//
// push   pressure differences, over the weights of the faces
// widen  (wide kernel) the filter of the scatter, transposed: it is its own

#import coupling::numbers::{numbers, span, step_of, is_made, drags, thread, at_cell, cell_at, last, THREADS}
#import coupling::smooth::smoothed
#import dem::boundary::COMPANION
#import coupling::walls::{move_walls, leave_walls}
#import dem::scene::scene
#import dem::control::{control, UNSTABLE, FULL}
#import dem::wide::{Wide, widen as wide_of, carry, fits, in_range, add_to_sum}

@group(0) @binding(0) var<uniform> tick: u32;
@group(0) @binding(1) var<storage, read> inverse: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> ease: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> reactions: array<vec4<f32>>;
// Pressure that grains feel [Pa].
@group(0) @binding(5) var<storage, read> pressures: array<f32>;
// What faces push with per w V K, and s_f v_f.
@group(0) @binding(6) var<storage, read_write> pushes: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> easing: array<vec4<f32>>;
#ifdef WIDE
@group(0) @binding(9) var<storage, read> wall_shares: array<vec2<f32>>;
#endif

// Sums of a workgroup: force on the bottom and the top, two words each.
var<workgroup> gathered: array<atomic<u32>, 4>;

fn gather(side: u32, x: f32) {
    if x == 0.0 {
        return;
    }
    if !fits(x) {
        atomicOr(&control.flags, UNSTABLE);
        return;
    }
    let w = wide_of(x);
    let before = atomicAdd(&gathered[2u * side + 1u], w.lo);
    let high = bitcast<u32>(w.hi) + carry(before, w.lo);
    if high == 0u {
        return;
    }
    let old = atomicAdd(&gathered[2u * side], high);
    if !in_range(old + high) {
        atomicOr(&control.flags, FULL);
    }
}

@compute @workgroup_size(64)
fn push(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let going = is_made(tick);
    let step = step_of(tick);
    let cell = thread(group, groups, local);
    if local < 4u {
        atomicStore(&gathered[local], 0u);
    }
    if going && cell < THREADS {
        move_walls(local, step);
    }
    workgroupBarrier();
    if going && cell < numbers.count {
        let at = at_cell(cell);
        let p = pressures[cell];
        let left = pressures[cell_at(vec3<u32>(last(at.x, numbers.cells.x), at.yz))];
        let front = pressures[cell_at(vec3<u32>(at.x, last(at.y, numbers.cells.y), at.z))];
        var below = p;
        if at.z > 0u {
            below = pressures[cell_at(at - vec3<u32>(0u, 0u, 1u))];
        }
        let side = numbers.spacing * span[0].height;
        let floor = numbers.spacing * numbers.spacing;
        var force = vec3<f32>(side, side, floor) * (vec3<f32>(left, front, below) - p);
        if drags(step) {
            force += reactions[cell].xyz;
            var eased = ease[cell].xyz * velocities[cell].xyz;
            if at.z == 0u {
                eased.z = 0.0;
            }
            easing[cell] = vec4<f32>(eased, 0.0);
        }
        // The walls themselves have no grains.
        if at.z == 0u {
            force.z = 0.0;
        }
        pushes[cell] = vec4<f32>(force * inverse[cell].xyz, 0.0);
        var on_walls = vec2<f32>(0.0);
        if at.z == 0u {
            on_walls.x += floor * p;
        }
        if at.z + 1u == numbers.cells.z {
            on_walls.y += floor * p;
        }
#ifdef WIDE
        on_walls += vec2<f32>(-1.0, 1.0) * wall_shares[cell] * force.z;
#endif
        gather(0u, on_walls.x * scene.force_scale);
        gather(1u, on_walls.y * scene.force_scale);
        if cell == 0u {
            leave_walls();
        }
    }
    workgroupBarrier();
    if local < 2u && going {
        let w = Wide(bitcast<i32>(atomicLoad(&gathered[2u * local])), atomicLoad(&gathered[2u * local + 1u]));
        if (w.hi != 0 || w.lo != 0u) && !add_to_sum(COMPANION + numbers.walls[local], w) {
            atomicOr(&control.flags, FULL);
        }
    }
}

@compute @workgroup_size(64)
fn widen(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let cell = thread(group, groups, local);
    if is_made(tick) && cell < numbers.count {
        pushes[cell] = vec4<f32>(smoothed(at_cell(cell), 0.0).faces, 0.0);
    }
}
