// Velocities of the walls after the motion of a step, as the step to come will have them.

#define_import_path coupling::walls
#import coupling::numbers::numbers
#import dem::boundary::{now, move_body, BODIES}

// By the first threads of a workgroup, before a barrier.
fn move_walls(local: u32, step: u32) {
    if local < BODIES {
        move_body(local, step, false);
    }
}

// Along z, of the bottom and the top, after that barrier.
fn wall_velocities() -> vec2<f32> {
    return vec2<f32>(now[numbers.walls.x].velocity, -now[numbers.walls.y].velocity);
}
