// What the kernels know of a bed and its water. Twin: coupling/src/gpu/numbers.rs

#define_import_path coupling::numbers
#import dem::wide::Wide
#import dem::control::{control, may_step}

struct Numbers {
    cells: vec3<u32>,
    count: u32,            // cells
    lengths: vec2<u32>,    // units; of the box along x and y
    grains: u32,
    unit: f32,             // m
    step: f32,             // s
    spacing: f32,          // m; of a cell along x and y
    compressibility: f32,  // 1/Pa
    viscosity: f32,        // Pa s
    density: f32,          // kg/m^3; of the water
    gravity: f32,          // m/s^2; along z
    solid_density: f32,    // kg/m^3; mean of the grains
    loose: f32,            // load over the mean one at which a grain counts half
    cavitation: f32,       // Pa; where the water breaks at the top
    flow_a: f32,           // of the law of resistance
    flow_b: f32,
    flow_c: f32,
    walls: vec2<u32>,      // bottom, top
    shares: vec2<f32>,     // of the force on each that moves it
}

// What follows from the lattice of the water, and from where the bed is.
struct Course {
    storage_unit: f32, // S of a cube over its porosity
    drag_unit: f32,    // half the drag times k, m^2
    speed: f32,        // m/s; of a cell per step
    source_unit: f32,  // 1/m^3; from a volume to the source of a step of the lattice
    renew_at: u32,     // the step at which weights are renewed
    memory: f32,       // share of the present load in the mean one
    stretch: f32,      // height of a cell of the lattice over the spacing
    passed: f32,       // s; from one step of the fluid to the next
    exchange: u32,     // steps from one exchange to the next
    drag_every: u32,   // steps from one drag of loose grains to the next, a multiple of these
    share: f32,        // part of a drag that each of the steps until the next exchange takes
    towed: f32,        // part of their drag that loose grains get
}

// Of the bed at the last renewal.
struct Span {
    bottom: Wide,      // units
    height: f32,       // m; of a cell
    bed: i32,          // units; of all cells
    mean_load: f32,    // N
    half: f32,         // N; load that counts half
    unused_a: u32,
    unused_b: u32,
}

@group(0) @binding(70) var<uniform> numbers: Numbers;
@group(0) @binding(71) var<storage, read> course: array<Course>;
@group(0) @binding(72) var<storage, read_write> span: array<Span>;

const THREADS: u32 = 64u;
// Vectors that are kept for each grain: where it is in its cell, and the cell; w V [m^3], γ [N s/m],
// lift [N], and what is the renewal's; grip along x, y and z; where it was at the last exchange,
// whole units and parts; its mean velocity [m/s] from the one before until then.
const KEPT: u32 = 6u;
// Number of a thread in a dispatch over many workgroups.
fn thread(group: vec3<u32>, groups: vec3<u32>, local: u32) -> u32 {
    return (group.x + group.y * groups.x) * THREADS + local;
}

// The step whose motion the water follows: with tick 0 the last one made, else one of a group. Is
// it made?
fn step_of(tick: u32) -> u32 {
    return control.base + tick;
}

fn is_made(tick: u32) -> bool {
    return tick == 0u || may_step(control.base + tick - 1u);
}

// Are weights to be renewed now?
fn renews() -> bool {
    return control.base == course[0].renew_at && atomicLoad(&control.flags) == 0u;
}

// Are loose grains dragged at the exchange of this step? Not with weights that faces had not when
// they took.
fn drags(step: u32) -> bool {
    return step > 0u && step % course[0].drag_every == 0u && step != course[0].renew_at;
}

// Where cell `cell` lies: x fastest, then y, then z.
fn at_cell(cell: u32) -> vec3<u32> {
    let line = cell / numbers.cells.x;
    return vec3<u32>(cell % numbers.cells.x, line % numbers.cells.y, line / numbers.cells.y);
}

fn cell_at(at: vec3<u32>) -> u32 {
    return at.x + numbers.cells.x * (at.y + numbers.cells.y * at.z);
}

// One on and one back along x and y, around the end of the box if there.
fn next(at: u32, count: u32) -> u32 {
    return select(at + 1u, 0u, at + 1u == count);
}

fn last(at: u32, count: u32) -> u32 {
    return select(at, count, at == 0u) - 1u;
}

// Volume of a cell [m^3].
fn cell_volume() -> f32 {
    return numbers.spacing * numbers.spacing * span[0].height;
}

// Volume of a grain [m^3].
fn ball(radius: f32) -> f32 {
    return 4.1887902047863905 * radius * radius * radius;
}
