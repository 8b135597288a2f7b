// Numbers of some cells between the lattice and the host, each for all of them before the next
// one. Twin: lbm/src/gpu/slab.rs

#define_import_path lbm::slab
#import lbm::setting::setting
#import lbm::lattice::Cell
#import lbm::populations::{Places, arrived}
#ifdef LINKS
#import lbm::links::{word_of, answered, SOLID}
#endif

// A uniform of this name is the number of the step that is to come, as for the steps.
@group(0) @binding(31) var<uniform> tick: u32;
@group(0) @binding(32) var<storage, read_write> slab: array<f32>;

struct Range {
    first: u32, // cell
    count: u32,
    unused_a: u32,
    unused_b: u32,
}

@group(0) @binding(33) var<uniform> range: Range;

const THREADS: u32 = 64u;

// The cell of a thread, counted from the first of the slab.
fn number(group: vec3<u32>, groups: vec3<u32>, local: u32) -> u32 {
    return (group.x + group.y * groups.x) * THREADS + local;
}

// Where cell `k` of the slab lies in the box.
fn at_cell(k: u32) -> vec3<u32> {
    let cell = range.first + k;
    let line = cell / setting.cells.x;
    return vec3<u32>(cell % setting.cells.x, line % setting.cells.y, line / setting.cells.y);
}

fn is_solid(at: vec3<u32>, here: Places) -> bool {
#ifdef LINKS
    return word_of(at, here) == SOLID;
#else
    return false;
#endif
}

// What arrived at a cell, answers of the sides included.
fn arrived_at(at: vec3<u32>, here: Places) -> Cell {
#ifdef LINKS
    return answered(at, here, tick, word_of(at, here));
#else
    return arrived(here, tick & 1u, 0u);
#endif
}
