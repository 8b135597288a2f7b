// When grains and water last exchanged.

#define_import_path coupling::times
#import coupling::numbers::numbers
#import dem::boundary::{reliefs, WALLS}

// Time since the last exchange, and from the one before until that [s]; zero where there was none.
fn passed_until(step: u32) -> vec2<f32> {
    let last = reliefs[numbers.walls.x].since;
    let before = reliefs[WALLS + numbers.walls.x].since;
    return numbers.step * vec2<f32>(f32(step - last), f32(last - before));
}

// What makes mean velocities of ways since the last exchange [1/s].
fn rate_until(step: u32) -> f32 {
    let passed = passed_until(step).x;
    return select(1.0 / passed, 0.0, passed == 0.0);
}
