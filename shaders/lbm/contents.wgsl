// What a coupled bed must know of the cells, without the host: flux along x, y and z, and content,
// lattice units. One thread a cell; it changes nothing. Twin of `contents` and of the flux of a
// snapshot in lbm/src/reading.rs.

#import lbm::setting::setting
#import lbm::populations::places
#import lbm::slab::{tick, is_solid, arrived_at}
#ifdef POROUS
#import lbm::collide::porous as law
#else
#import lbm::collide::free as law
#endif

// By cell: x fastest, then y, then z.
@group(0) @binding(36) var<storage, read_write> contents: array<vec4<f32>>;
#ifdef GUARDED
// 0: nothing is to be done.
@group(0) @binding(35) var<storage, read> guard: array<u32>;
#endif

@compute @workgroup_size(#{GROUP_X}, #{GROUP_Y}, #{GROUP_Z})
fn tell(@builtin(global_invocation_id) at: vec3<u32>) {
#ifdef GUARDED
    if guard[0] == 0u {
        return;
    }
#endif
    if any(at >= setting.cells) {
        return;
    }
    let here = places(at);
    if is_solid(at, here) {
        return;
    }
    let cell = arrived_at(at, here);
    let f = law::moments(here.own, cell).flux;
    let s = cell.forward;
    let b = cell.backward;
    // What rests is most of it: the moving ones are added up before, so that little is rounded.
    let axis = s.axis + b.axis;
    let plus = s.plus + b.plus;
    let minus = s.minus + b.minus;
    let moving = ((axis.x + axis.y) + (axis.z + plus.x)) + ((plus.y + plus.z) + (minus.x + (minus.y + minus.z)));
    contents[at.x + setting.cells.x * (at.y + setting.cells.y * at.z)] = vec4<f32>(f, cell.rest + moving);
}
