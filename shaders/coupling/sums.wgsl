// What the grains of all cells have left at the faces and cells, added up in one order. Twin of
// `add_up` in coupling/src/faces.rs: what falls behind a wall is folded back.

#define_import_path coupling::sums
#import coupling::numbers::{numbers, cell_at, next, last}

// 54 numbers a cell (scatter.wgsl).
@group(0) @binding(20) var<storage, read> shares: array<f32>;

const FACES: u32 = 54u;

// The cell at `d` from `at`, d = 0, 1, 2 standing for one back, here and one on, along each axis,
// around the sides of the box; along z `at.z` is that of the cell.
fn beside(at: vec3<u32>, d: vec2<u32>, z: u32) -> u32 {
    var x = at.x;
    var y = at.y;
    if d.x == 0u { x = last(at.x, numbers.cells.x); }
    if d.x == 2u { x = next(at.x, numbers.cells.x); }
    if d.y == 0u { y = last(at.y, numbers.cells.y); }
    if d.y == 2u { y = next(at.y, numbers.cells.y); }
    return cell_at(vec3<u32>(x, y, z));
}

// A layer of cells whose grains reach a node, and at which of their places along z (0, 1, 2: one
// below, here, one above) it is.
struct Layer {
    z: u32,
    place: u32,
    // Behind a wall: its images count for cells, and not for faces across.
    image: bool,
}

// The layer below, at, or above layer `z`.
fn layer(z: u32, k: u32) -> Layer {
    if k == 0u {
        if z == 0u { return Layer(0u, 0u, true); }
        return Layer(z - 1u, 2u, false);
    }
    if k == 2u {
        if z + 1u == numbers.cells.z { return Layer(z, 2u, true); }
        return Layer(z + 1u, 0u, false);
    }
    return Layer(z, 1u, false);
}

// Sums at the lower faces of a cell along x, y and z; w: at its upper face along z, if that is the
// upper wall.
fn at_faces(at: vec3<u32>) -> vec4<f32> {
    var sum = vec4<f32>(0.0);
    for (var k = 0u; k < 3u; k++) {
        let source = layer(at.z, k);
        for (var j = 0u; j < 3u; j++) {
            for (var i = 0u; i < 3u; i++) {
                let first = FACES * beside(at, vec2<u32>(i, j), source.z);
                // What is one back reaches here with its place one on.
                if i < 2u {
                    sum.x += shares[first + (1u - i) + 2u * (2u - j) + 6u * source.place];
                }
                if j < 2u {
                    sum.y += shares[first + 18u + (1u - j) + 2u * (2u - i) + 6u * source.place];
                }
                if k < 2u && !source.image {
                    sum.z += shares[first + 36u + (1u - k) + 2u * (2u - i) + 6u * (2u - j)];
                }
                if k == 1u && at.z + 1u == numbers.cells.z {
                    sum.w += shares[first + 36u + 1u + 2u * (2u - i) + 6u * (2u - j)];
                }
            }
        }
    }
    return sum;
}

// Sum at a cell.
fn at_cells(at: vec3<u32>) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let source = layer(at.z, k);
        for (var j = 0u; j < 3u; j++) {
            for (var i = 0u; i < 3u; i++) {
                let first = FACES * beside(at, vec2<u32>(i, j), source.z);
                sum += shares[first + (2u - i) + 3u * (2u - j) + 9u * source.place];
            }
        }
    }
    return sum;
}
