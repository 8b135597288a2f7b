// Contacts of grains with walls. Twin of dem/src/walls.rs: the wall is the body j, without
// curvature and without spin.

#define_import_path dem::walls
#import dem::wide::Wide
#import dem::fixed::{Place, wall_overlap}
#import dem::scene::{scene, Motion, WallScene, TOUCHES}
#import dem::boundary::{now, WALLS}
#import dem::sweep::Sum
#import dem::contact::types::{Touch, Turn, Memory, Response, no_memory, energies}
#import dem::contact::normal
#ifdef FULL_WALLS
#import dem::contact::law
#endif

// What grains remember of each wall; only those that touch one read it.
#ifdef LEDGER
@group(0) @binding(12) var<storage, read_write> wall_forces: array<vec4<f32>>;
#endif
#ifdef FULL_WALLS
@group(0) @binding(13) var<storage, read_write> wall_springs: array<vec4<f32>>;
#ifdef TURNS
@group(0) @binding(14) var<storage, read_write> wall_rollings: array<vec4<f32>>;
#ifdef LEDGER
@group(0) @binding(15) var<storage, read_write> wall_couples: array<vec4<f32>>;
#endif
#endif
#endif

#ifdef READ
// Force on each grain from each wall; w: 0 apart, 1 touching, 2 sliding.
@group(0) @binding(24) var<storage, read_write> wall_forces_read: array<vec4<f32>>;
#ifdef FULL_WALLS
@group(0) @binding(25) var<storage, read_write> wall_springs_read: array<vec4<f32>>;
#ifdef TURNS
@group(0) @binding(26) var<storage, read_write> wall_rollings_read: array<vec4<f32>>;
#endif
#endif
#endif

fn touching_bit(k: u32) -> u32 {
    return TOUCHES << k;
}

fn sliding_bit(k: u32) -> u32 {
    return TOUCHES << (WALLS + k);
}

fn recall_wall(e: u32, k: u32, flags: u32) -> Memory {
    var memory = no_memory();
    if (flags & touching_bit(k)) == 0u {
        return memory;
    }
#ifdef LEDGER
    memory.force = wall_forces[e].xyz;
#endif
#ifdef FULL_WALLS
    memory.spring = wall_springs[e].xyz;
    memory.sliding = (flags & sliding_bit(k)) != 0u;
#ifdef TURNS
    memory.twisting = wall_springs[e].w;
    memory.rolling = wall_rollings[e].xyz;
#ifdef LEDGER
    memory.couple = wall_couples[e].xyz;
#endif
#endif
#endif
    return memory;
}

// Add the contact of grain `g` with wall `k` to `sum`; returns how hard it presses [N].
// `flags` are the grain's, and are changed.
fn touch_wall(
    k: u32,
    g: u32,
    place: Place,
    me: Motion,
    first: bool,
    flags: ptr<function, u32>,
    sum: ptr<function, Sum>,
) -> f32 {
    let wall = scene.walls[k];
    let e = g * WALLS + k;
    let x = Wide(place.hi[wall.axis], place.lo[wall.axis]);
    let overlap = wall_overlap(x, place.radius_hi, place.radius_lo, now[k].offset, wall.side, scene.unit);
    // A grain that just touches counts: its dashpot does.
    if overlap < 0.0 {
#ifdef READ
        wall_forces_read[e] = vec4<f32>(0.0);
#endif
        if (*flags & touching_bit(k)) != 0u {
#ifdef LEDGER
#ifdef FULL_WALLS
            let held = energies(scene.law, recall_wall(e, k, *flags));
            if !first {
                (*sum).lost += vec3<f32>(held.x, 0.0, held.y);
            }
#endif
#endif
            *flags &= ~(touching_bit(k) | sliding_bit(k));
        }
        return 0.0;
    }
    var n = vec3<f32>(0.0);
    n[wall.axis] = f32(wall.side);
    let velocity = me.velocity - now[k].velocity * n;
    let separation = dot(velocity, n);
    var touch = Touch(n, overlap, vec3<f32>(0.0), separation);
    var turn = Turn(vec3<f32>(0.0), me.radius);
    let step = select(scene.step, 0.0, first);
    let memory = recall_wall(e, k, *flags);
#ifdef FULL_WALLS
    var response: Response;
    if wall.full == 1u {
        let surface = me.spin * law::velocity_arm(me.radius, overlap);
        touch.slip = velocity - separation * n - cross(surface, n);
        turn.spin = me.spin;
        response = law::respond(scene.law, touch, turn, memory, step);
    } else {
        response = normal::respond(scene.law, touch, turn, memory, step);
    }
#else
    let response = normal::respond(scene.law, touch, turn, memory, step);
#endif
    let force = response.tangential + response.normal_force * n;
    var after = response.memory;
    if first {
        // The springs of the start already belong to this instant.
        after = memory;
    }
#ifdef READ
    wall_forces_read[e] = vec4<f32>(force, select(1.0, 2.0, after.sliding));
#ifdef FULL_WALLS
    wall_springs_read[e] = vec4<f32>(after.spring, after.twisting);
#ifdef TURNS
    wall_rollings_read[e] = vec4<f32>(after.rolling, 0.0);
#endif
#endif
#else
    *flags = (*flags & ~sliding_bit(k)) | touching_bit(k) | select(0u, sliding_bit(k), after.sliding);
#ifdef LEDGER
    wall_forces[e] = vec4<f32>(force, 0.0);
#endif
#ifdef FULL_WALLS
    wall_springs[e] = vec4<f32>(after.spring, after.twisting);
#ifdef TURNS
    wall_rollings[e] = vec4<f32>(after.rolling, 0.0);
#ifdef LEDGER
    wall_couples[e] = vec4<f32>(response.couple, 0.0);
#endif
#endif
#endif
#endif

    (*sum).force += force;
#ifdef FULL_WALLS
    (*sum).torque += response.couple - law::torque_arm(me.radius, overlap, true) * cross(n, response.tangential);
#endif
#ifdef LEDGER
    if !first {
        (*sum).lost += vec3<f32>(response.friction, response.viscosity, response.rolling_loss);
    }
#endif
    return response.normal_force;
}
