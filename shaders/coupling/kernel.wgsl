// The kernel through which a grain meets the lattice, along one axis: a hat of half width one cell.
// Twin of coupling/src/kernel.rs, which has the wider one as well: that is this one after the filter
// 1/4, 1/2, 1/4 of smooth.wgsl, for cells and for faces, and at walls too.

#define_import_path coupling::kernel

// Coefficients of 1, t and t^2, t being how far a grain is into its cell: of the share of cell
// k - 1 from there, k = 0, 1, 2.
fn of_cell(k: u32) -> vec3<f32> {
    if k == 0u {
        return vec3<f32>(0.5, -1.0, 0.5);
    }
    if k == 1u {
        return vec3<f32>(0.5, 1.0, -1.0);
    }
    return vec3<f32>(0.0, 0.0, 0.5);
}

// The same of the weight of the lower face of the cell, k = 0, and of the upper one, k = 1.
fn of_face(k: u32) -> vec3<f32> {
    if k == 0u {
        return vec3<f32>(1.0, -1.0, 0.0);
    }
    return vec3<f32>(0.0, 1.0, 0.0);
}

fn value(c: vec3<f32>, t: f32) -> f32 {
    return c.x + t * (c.y + t * c.z);
}

// Shares of the three cells along each axis, and weights of the two faces, of a grain at t.
struct Weights {
    cells: array<vec3<f32>, 3>, // by cell: along x, y, z
    faces: array<vec3<f32>, 2>,
}

fn weights(t: vec3<f32>) -> Weights {
    var w: Weights;
    w.cells[0] = 0.5 * (1.0 - t) * (1.0 - t);
    w.cells[1] = 0.5 + t * (1.0 - t);
    w.cells[2] = 0.5 * t * t;
    w.faces[0] = 1.0 - t;
    w.faces[1] = t;
    return w;
}
