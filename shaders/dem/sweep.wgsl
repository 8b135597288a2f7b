// The contact of a grain with one of its neighbours. Twin of dem/src/sweep.rs.
//
// A contact stands in the lists of both grains, and both compute it. They do so with the same
// numbers in the same order, as the grain of the smaller identity sees it (i), so that action
// and reaction are opposite to the last bit; the other takes the opposite. Losses are booked
// by i alone.

#define_import_path dem::sweep
#import dem::fixed::{Place, apart, closeness, gap, Apart}
#import dem::scene::{scene, Motion}
#import dem::contact::types::{Law, Touch, Turn, Memory, Response, no_turn, no_memory, energies}
#import dem::contact::law

@group(0) @binding(1) var<storage, read_write> places: array<Place>;
@group(0) @binding(2) var<storage, read_write> motions: array<Motion>;
@group(0) @binding(7) var<storage, read_write> neighbours: array<u32>; // in parts
#ifdef SLIDES
// Tangential spring [m]; w: twisting spring [m].
@group(0) @binding(8) var<storage, read_write> springs: array<vec4<f32>>; // in parts
#endif
#ifdef LEDGER
// Force on i in the last step [N].
@group(0) @binding(9) var<storage, read_write> forces: array<vec4<f32>>; // in parts
#endif
#ifdef TURNS
// Rolling spring [m].
@group(0) @binding(10) var<storage, read_write> rollings: array<vec4<f32>>; // in parts
#ifdef LEDGER
// Torque on i of rolling and twisting in the last step [N m].
@group(0) @binding(11) var<storage, read_write> couples: array<vec4<f32>>; // in parts
#endif
#endif

#ifdef READ
// What a reading leaves: words of the neighbours, and history and force of each entry.
@group(0) @binding(20) var<storage, read_write> words_read: array<u32>; // in parts
@group(0) @binding(21) var<storage, read_write> forces_read: array<vec4<f32>>; // in parts
#ifdef SLIDES
@group(0) @binding(22) var<storage, read_write> springs_read: array<vec4<f32>>; // in parts
#endif
#ifdef TURNS
@group(0) @binding(23) var<storage, read_write> rollings_read: array<vec4<f32>>; // in parts
#endif
#endif

const INDEX: u32 = 0x3fffffffu;
const SLIDING: u32 = 0x40000000u;
const TOUCHING: u32 = 0x80000000u;

// Force and torque on a grain, and what its contacts lost: friction, viscosity, rolling.
struct Sum {
    force: vec3<f32>,  // N
    torque: vec3<f32>, // N m
    lost: vec3<f32>,   // J
#ifdef LOADS
    load: f32,         // N; of normal forces that push
#endif
}

// What entry `e` remembers.
fn recall(e: u32, word: u32, books: bool) -> Memory {
    var memory = no_memory();
    if (word & TOUCHING) == 0u {
        return memory;
    }
#ifdef SLIDES
    memory.spring = springs_at(e).xyz;
    memory.sliding = (word & SLIDING) != 0u;
#endif
#ifdef TURNS
    memory.twisting = springs_at(e).w;
    memory.rolling = rollings_at(e).xyz;
#endif
#ifdef LEDGER
    if books {
        memory.force = forces_at(e).xyz;
#ifdef TURNS
        memory.couple = couples_at(e).xyz;
#endif
    }
#endif
    return memory;
}

// Keep what entry `e` is to remember: its springs, and the force and couple of this step.
fn remember(e: u32, j: u32, was: u32, memory: Memory, force: vec3<f32>, couple: vec3<f32>, books: bool) {
    let word = j | TOUCHING | select(0u, SLIDING, memory.sliding);
#ifdef READ
    set_words_read(e, word);
    set_forces_read(e, vec4<f32>(force, 0.0));
#ifdef SLIDES
    set_springs_read(e, vec4<f32>(memory.spring, memory.twisting));
#endif
#ifdef TURNS
    set_rollings_read(e, vec4<f32>(memory.rolling, 0.0));
#endif
#else
    if word != was {
        set_neighbours(e, word);
    }
#ifdef SLIDES
    set_springs(e, vec4<f32>(memory.spring, memory.twisting));
#endif
#ifdef TURNS
    set_rollings(e, vec4<f32>(memory.rolling, 0.0));
#endif
#ifdef LEDGER
    if books {
        set_forces(e, vec4<f32>(force, 0.0));
#ifdef TURNS
        set_couples(e, vec4<f32>(couple, 0.0));
#endif
    }
#endif
#endif
}

// Add entry `e` of grain `me` to `sum`. Grains lie from row `half` on.
fn meet(e: u32, half: u32, my_place: Place, me: Motion, first: bool, sum: ptr<function, Sum>) {
    let word = neighbours_at(e);
    let j = word & INDEX;
    let place = places[half + j];
    let reach_hi = my_place.radius_hi + place.radius_hi;
    let reach_lo = my_place.radius_lo + place.radius_lo;
    let away = apart(my_place, place, scene.length);
    let close = closeness(away, reach_hi, reach_lo);
    if close <= 0.0 {
        if (word & TOUCHING) != 0u {
            part(e, j, word, me.id < motions[half + j].id, first, sum);
        }
#ifdef READ
        set_words_read(e, j);
#endif
        return;
    }
    let other = motions[half + j];
    let books = me.id < other.id;
    let sign = select(-1.0, 1.0, books);
    let whole = select(-1, 1, books);
    let seen = Apart(away.hi * whole, away.lo * sign);
    let g = gap(seen, reach_hi, reach_lo, close, scene.unit);
    let velocity = sign * (me.velocity - other.velocity);
    let separation = dot(velocity, g.normal);

    var touch = Touch(g.normal, g.overlap, vec3<f32>(0.0), separation);
    var turn = no_turn();
#ifdef SLIDES
    // i and j in the order of identities, whoever computes.
    let spin_i = select(other.spin, me.spin, books);
    let spin_j = select(me.spin, other.spin, books);
    let radius_i = select(other.radius, me.radius, books);
    let radius_j = select(me.radius, other.radius, books);
    let surface = spin_i * law::velocity_arm(radius_i, g.overlap)
        + spin_j * law::velocity_arm(radius_j, g.overlap);
    touch.slip = velocity - separation * g.normal - cross(surface, g.normal);
#ifdef TURNS
    turn = Turn(spin_i - spin_j, radius_i * radius_j / (radius_i + radius_j));
#endif
#endif
    let step = select(scene.step, 0.0, first);
    let before = recall(e, word, books);
    let response = law::respond(scene.law, touch, turn, before, step);
    let force = response.tangential + response.normal_force * g.normal;
    var after = response.memory;
    if first {
        // The springs of the start already belong to this instant.
        after = before;
    }
    remember(e, j, word, after, force, response.couple, books);

    (*sum).force += sign * force;
#ifdef LOADS
    (*sum).load += max(response.normal_force, 0.0);
#endif
#ifdef SLIDES
    let arm = law::torque_arm(me.radius, g.overlap, false);
    (*sum).torque -= arm * cross(g.normal, response.tangential);
#ifdef TURNS
    (*sum).torque += sign * response.couple;
#endif
#endif
#ifdef LEDGER
    if books && !first {
        (*sum).lost += vec3<f32>(response.friction, response.viscosity, response.rolling_loss);
    }
#endif
}

// A contact that has parted forgets; what its springs still held is lost.
fn part(e: u32, j: u32, word: u32, books: bool, first: bool, sum: ptr<function, Sum>) {
#ifdef LEDGER
#ifdef SLIDES
    if books && !first {
        let held = energies(scene.law, recall(e, word, false));
        (*sum).lost += vec3<f32>(held.x, 0.0, held.y);
    }
#endif
#endif
#ifndef READ
    set_neighbours(e, j);
#endif
}
