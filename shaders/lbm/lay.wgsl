// Populations in equilibrium with flux and content of each cell, before step zero. One thread a
// cell. Twin of `equilibrium` in lbm/src/collide/mod.rs, without squares of the flux.

#import lbm::lattice::{Cell, Pairs, W_AXIS, W_DIAGONAL, project}
#import lbm::setting::setting
#import lbm::populations::{places, leave}
#import lbm::collide::porous::{inverse_storage, half_drag}

// By cell: flux along x, y and z, and content; x fastest, then y, then z.
@group(0) @binding(36) var<storage, read_write> contents: array<vec4<f32>>;
// What fluxes are to be multiplied by.
@group(0) @binding(37) var<storage, read> factors: array<vec4<f32>>;

@compute @workgroup_size(#{GROUP_X}, #{GROUP_Y}, #{GROUP_Z})
fn lay(@builtin(global_invocation_id) at: vec3<u32>) {
    if any(at >= setting.cells) {
        return;
    }
    let here = places(at);
    let row = contents[at.x + setting.cells.x * (at.y + setting.cells.y * at.z)];
    let j = row.xyz * factors[0].xyz;
    let p = row.w * (inverse_storage[here.own] * setting.flatness);
    // The first moment that drag leaves of the flux.
    let m = project(j * (1.0 + half_drag[here.own] * setting.drag_stretch.xxy));
    let forward = Pairs(
        W_AXIS * 3.0 * (p + m.axis),
        W_DIAGONAL * 3.0 * (p + m.plus),
        W_DIAGONAL * 3.0 * (p + m.minus),
    );
    let backward = Pairs(
        W_AXIS * 3.0 * (p - m.axis),
        W_DIAGONAL * 3.0 * (p - m.plus),
        W_DIAGONAL * 3.0 * (p - m.minus),
    );
    // What arrives along a direction lies where the cell will leave what goes against it.
    leave(here, 0u, Cell(row.w - 2.0 * p, backward, forward));
}
