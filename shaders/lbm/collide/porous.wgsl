// Water in a porous bed, compressible or not, at any permeability. Twin of
// lbm/src/collide/porous.rs, which carries the formulas, their limits and sources.

#define_import_path lbm::collide::porous
#import lbm::collide::{Moments, sums, forced, odd_part, relaxed, first_order, second_order}
#import lbm::lattice::Cell
#import lbm::setting::setting

// One number for each place: 1 / content of a cube at unit pressure, half the drag.
@group(0) @binding(40) var<storage, read> inverse_storage: array<f32>;
@group(0) @binding(41) var<storage, read> half_drag: array<f32>;
#ifdef FORCHHEIMER
// Half the drag at unit speed.
@group(0) @binding(42) var<storage, read> half_forchheimer: array<f32>;
#endif
#ifdef INERTIA
// 1/φ
@group(0) @binding(43) var<storage, read> inverse_porosity: array<f32>;
#endif
#ifdef SOURCE
// Content that comes in per step.
@group(0) @binding(44) var<storage, read> sources: array<f32>;
#endif

fn collide(place: u32, cell: Cell) -> Cell {
    let found = sums(cell);
    let omega = setting.omega_even;
#ifdef SOURCE
    let source = sources[place];
#else
    let source = 0.0;
#endif
    let content = 0.5 * source + (cell.rest + found.moving);
    let pressure = content * (inverse_storage[place] * setting.flatness);
    let j = flux(place, found.momentum);
    let g = odd_part(j, found.momentum);

    // The rest population gives what the moving ones get beyond what they lose: as an
    // increment, which is far smaller than the content where little diffuses per step.
    let lost = omega * found.moving + source;
    let three_p = 3.0 * omega * pressure;
#ifdef INERTIA
    let force = (18.0 - 9.0 * omega) * (j - found.momentum);
    let v = inverse_porosity[place] * (4.5 * omega * j + force);
    let even = second_order(three_p, j, v);
#else
    let even = first_order(three_p);
#endif
    return relaxed(cell.rest + (lost - even.got), found, even.each, g);
}

// Pressure and flux between two steps; the source of the step to come is not in them.
fn moments(place: u32, cell: Cell) -> Moments {
    let found = sums(cell);
    let pressure = (cell.rest + found.moving) * (inverse_storage[place] * setting.flatness);
    return Moments(pressure, flux(place, found.momentum));
}

// The flux under drag and body force.
fn flux(place: u32, momentum: vec3<f32>) -> vec3<f32> {
    let n = forced(momentum);
    var hindered = 1.0 + half_drag[place] * setting.drag_stretch;
#ifdef FORCHHEIMER
    // Only in cubes: drag is the same along x, y and along z.
    let half_b = half_forchheimer[place];
    let speed = sqrt(dot(n, n));
    let along = hindered.y;
    let root = sqrt(along * along + 4.0 * half_b * speed);
    hindered += half_b * (speed + speed) / (along + root);
#endif
    let passing = 1.0 / hindered;
    return n * passing.xxy;
}
