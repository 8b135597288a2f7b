// The pressure, undrained since the last step of the lattice.

#define_import_path coupling::pressure
#import coupling::numbers::{numbers, span, at_cell}

// Flux of the lattice along x, y and z, and content; lattice units.
@group(0) @binding(22) var<storage, read> contents: array<vec4<f32>>;
// ∫Q dt since the last step of the lattice [m^3].
@group(0) @binding(23) var<storage, read_write> collected: array<f32>;
// Of a cell: volume of solid [m^3], permeability [m^2], 1/(β V_p) [Pa/m^3], porosity.
@group(0) @binding(24) var<storage, read_write> bed: array<vec4<f32>>;
#ifdef CAVITATION
// Volume of vapour [m^3]: it stands in the content of the lattice, but is no water.
@group(0) @binding(25) var<storage, read_write> vapour: array<f32>;

// Pressure at which the water of a layer breaks [Pa].
fn least(z: u32) -> f32 {
    let depth = (f32(numbers.cells.z - z) - 0.5) * span[0].height;
    return numbers.cavitation - abs(numbers.gravity) * numbers.density * depth;
}
#endif

// Content of the lattice [m^3].
fn content(cell: u32) -> f32 {
    return contents[cell].w * (numbers.spacing * numbers.spacing * numbers.spacing);
}

fn pressure(cell: u32) -> f32 {
#ifdef UNPREDICTED
    let gone = 0.0;
#else
    let gone = collected[cell];
#endif
#ifdef CAVITATION
    let water = content(cell) - vapour[cell] - gone;
    return max(water * bed[cell].z, least(at_cell(cell).z));
#else
    return (content(cell) - gone) * bed[cell].z;
#endif
}
