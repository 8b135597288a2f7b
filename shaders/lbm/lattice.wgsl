// D3Q19: a rest population, and nine pairs of opposite directions. Twin of lbm/src/lattice.rs.

#define_import_path lbm::lattice

// A number for each pair, by its forward direction: along x, y, z; along x + y, x + z, y + z;
// along x - y, x - z, y - z. (In the order of Rust: 0 1 2, 3 5 7, 4 6 8.)
struct Pairs {
    axis: vec3<f32>,
    plus: vec3<f32>,
    minus: vec3<f32>,
}

// The populations of a cell, as deviations from rest.
struct Cell {
    rest: f32,
    forward: Pairs,
    backward: Pairs,
}

const W_AXIS: f32 = 0.05555555555555555;  // 1/18
const W_DIAGONAL: f32 = 0.027777777777777776; // 1/36

// c · v for the forward directions.
fn project(v: vec3<f32>) -> Pairs {
    return Pairs(v, v.xxy + v.yzz, v.xxy - v.yzz);
}
