// Walls after the motion of a step, as the step to come will have them, and how far they have come
// since the last exchange.

#define_import_path coupling::walls
#import coupling::numbers::numbers
#import dem::boundary::{now, move_body, BODIES}
#import dem::wide::Wide
#import dem::fixed::offset

// Where the bottom and the top were at the last exchange, units.
@group(0) @binding(26) var<storage, read_write> walls_left: array<Wide>;

// By the first threads of a workgroup, before a barrier.
fn move_walls(local: u32, step: u32) {
    if local < BODIES {
        move_body(local, step, false);
    }
}

// Mean velocities along z of the bottom and the top since the last exchange, with the `rate` that
// makes them of ways, after that barrier.
fn wall_velocities(rate: f32) -> vec2<f32> {
    return rate * vec2<f32>(wall_way(0u), wall_way(1u));
}

fn wall_way(side: u32) -> f32 {
    let way = offset(now[numbers.walls[side]].offset, walls_left[side]);
    return (f32(way.hi) + way.lo) * numbers.unit;
}

// The next way begins here: by one thread, after all have asked.
fn leave_walls() {
    for (var side = 0u; side < 2u; side++) {
        walls_left[side] = now[numbers.walls[side]].offset;
    }
}
