// What the kernels know of a lattice. Twin: lbm/src/gpu/setting.rs

#define_import_path lbm::setting

struct Setting {
    cells: vec3<u32>,
    stride: u32,             // from one row to the next, places
    extent: vec3<u32>,       // layers, those in walls included
    step: u32,               // from one population to the next, places
    walled: vec3<u32>,       // 3 where an axis has walls, 0 where it is periodic
    pressures: u32,          // a bit for each side that gives a pressure
    half_force: vec3<f32>,   // half the body force
    omega_even: f32,
    drag_stretch: vec2<f32>, // by how much drag is stronger along x, y and along z
    flatness: f32,           // content of a cube over that of a cell
    omega_odd: f32,
    nothing: u32,            // 0, of which a compiler knows nothing
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
}

@group(0) @binding(30) var<uniform> setting: Setting;

// `x`, of which a compiler knows nothing: it cannot shorten sums and products as if they did not
// round.
fn as_rounded(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) | setting.nothing);
}
