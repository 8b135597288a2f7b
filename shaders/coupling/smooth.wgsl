// The filter 1/4, 1/2, 1/4 along each axis, which makes of the kernel of half width one cell that of
// two. Since images in a wall stay images, it may come after sums were folded: cells and faces along
// a wall are even about it; faces across are odd, but for weights, of which images count too.

#define_import_path coupling::smooth
#import coupling::numbers::numbers
#import coupling::sums::beside

// One number at faces, or cells, of normal x, y and z.
@group(0) @binding(21) var<storage, read> rough: array<vec4<f32>>;

// Over x and y, in layer `z`.
fn across(at: vec3<u32>, z: u32) -> vec4<f32> {
    var sum = vec4<f32>(0.0);
    for (var j = 0u; j < 3u; j++) {
        for (var i = 0u; i < 3u; i++) {
            let weight = select(0.25, 0.5, i == 1u) * select(0.25, 0.5, j == 1u);
            sum += weight * rough[beside(at, vec2<u32>(i, j), z)];
        }
    }
    return sum;
}

// At the lower faces of a cell. `behind`: what faces at walls count for, 0 where what is behind
// is the opposite, 2 where it is the same. w: the part of z that is of the bottom's images and of
// the top's, where the faces at walls are 2.
struct Smooth {
    faces: vec3<f32>,
    walls: vec2<f32>,
}

fn smoothed(at: vec3<u32>, behind: f32) -> Smooth {
    let top = numbers.cells.z - 1u;
    let here = across(at, at.z);
    let below = across(at, select(at.z, 1u, at.z == 0u) - 1u);
    let above = across(at, min(at.z + 1u, top));
    let along = 0.5 * here.xy + 0.25 * (below.xy + above.xy);
    // Below face 1 lies the bottom, above the last one the top.
    let under = select(below.z, behind * below.z, at.z == 1u);
    let over = select(above.z, behind * here.w, at.z == top);
    var z = 0.5 * here.z + 0.25 * (under + over);
    if at.z == 0u {
        z = 0.0;
    }
    var walls = vec2<f32>(0.0);
    if behind > 0.0 {
        if at.z == 1u { walls.x = 0.5 * below.z; }
        if at.z == top { walls.y = 0.5 * here.w; }
    }
    return Smooth(vec3<f32>(along, z), walls);
}

// At a cell, of the first number.
fn smoothed_cell(at: vec3<u32>) -> f32 {
    let top = numbers.cells.z - 1u;
    let below = across(at, select(at.z, 1u, at.z == 0u) - 1u);
    let above = across(at, min(at.z + 1u, top));
    return 0.5 * across(at, at.z).x + 0.25 * (below.x + above.x);
}
