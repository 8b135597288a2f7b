// What a contact law is, sees, remembers, and answers. Twin of dem/src/contact/mod.rs, one
// contact instead of four; of the constants: dem/src/gpu/law.rs.

#define_import_path dem::contact::types

// Constants of all parts that a law can have; those it lacks are not read.
struct Law {
    normal: Normal,
    sliding: Sliding,
    rolling: Turning,
    twisting: Turning,
}

struct Normal {
    stiffness: f32, // N/m
    damping: f32,   // N s/m
    floor: f32,     // smallest force allowed, N
    unused: f32,
}

struct Sliding {
    stiffness: f32, // N/m
    damping: f32,   // N s/m
    friction_static: f32,
    friction_dynamic: f32,
}

struct Turning {
    stiffness: f32, // N/m
    damping: f32,   // N s/m
    friction: f32,
    unused: f32,
}

// The normal points from j to i.
struct Touch {
    normal: vec3<f32>,
    overlap: f32,    // m
    slip: vec3<f32>, // tangential velocity of i's surface against j's, m/s
    separation: f32, // rate of separation, m/s
}

struct Turn {
    spin: vec3<f32>,     // of i against j, rad/s
    reduced_radius: f32, // m
}

struct Memory {
    spring: vec3<f32>,  // m
    sliding: bool,
    force: vec3<f32>,   // on i in the last step, N; only with a ledger
    rolling: vec3<f32>, // m; this and the next two only where the law turns
    twisting: f32,      // m
    couple: vec3<f32>,  // on i in the last step, N m
}

struct Response {
    normal_force: f32,     // N
    tangential: vec3<f32>, // on i, N
    couple: vec3<f32>,     // on i beyond that of the tangential force, N m
    memory: Memory,        // springs after the step
    friction: f32,         // losses of this step, J; only with a ledger
    viscosity: f32,
    rolling_loss: f32,
}

fn no_turn() -> Turn {
    return Turn(vec3<f32>(0.0), 0.0);
}

fn no_memory() -> Memory {
    let zero = vec3<f32>(0.0);
    return Memory(zero, false, zero, zero, 0.0, zero);
}

// Energy in the tangential spring, and in the rolling and twisting ones, J: lost when the
// contact parts. Twin of Kept::energies in dem/src/slab.rs.
fn energies(law: Law, memory: Memory) -> vec2<f32> {
    let sliding = law.sliding.stiffness * dot(memory.spring, memory.spring);
    let rolling = law.rolling.stiffness * dot(memory.rolling, memory.rolling);
    let twisting = law.twisting.stiffness * memory.twisting * memory.twisting;
    return 0.5 * vec2<f32>(sliding, rolling + twisting);
}

// Energy that the tangential contact took over the last drift, J. The squares of the springs
// differ by 1e-4 of themselves: (a - b)·(a + b) keeps the digits that a² - b² would lose.
fn tangential_loss(memory: Memory, k_t: f32, force: vec3<f32>, spring: vec3<f32>, slip: vec3<f32>, step: f32) -> f32 {
    let work = step * dot(memory.force + force, slip);
    let stored = k_t * dot(spring - memory.spring, spring + memory.spring);
    return -0.5 * (work + stored);
}
