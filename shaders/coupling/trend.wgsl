// The pressure that grains feel until the next exchange: that of the middle of the kicks which it makes.
// Twin of coupling/src/trend.rs, which tells why.

#define_import_path coupling::trend
#import coupling::numbers::{numbers, course}
#import coupling::pressure::pressure
#ifdef CAVITATION
#import coupling::numbers::at_cell
#import coupling::pressure::least
#endif
#import coupling::times::passed_until
#import dem::boundary::reliefs

// Pressure at the last exchange [Pa], its slope from the one before until then [Pa/s], and what has
// been added since.
@group(0) @binding(27) var<storage, read_write> trends: array<vec4<f32>>;
// Pressure that grains feel [Pa].
@group(0) @binding(28) var<storage, read_write> pressures: array<f32>;

fn bounded(cell: u32, pressure: f32) -> f32 {
#ifdef CAVITATION
    return max(pressure, least(at_cell(cell).z));
#else
    return pressure;
#endif
}

// Steps from the exchange of this one to the middle of the kicks that it makes.
fn steps_ahead(step: u32) -> f32 {
    let every = course[0].exchange;
    return 0.5 * f32(every - step % every - 1u);
}

// After this step: what is held, on its way from the last exchange.
fn felt(cell: u32, step: u32) -> f32 {
    let last = reliefs[numbers.walls.x].since;
    let ahead = steps_ahead(last);
    if ahead == 0.0 {
        return pressures[cell];
    }
    return bounded(cell, trends[cell].x + f32(step - last) / ahead * trends[cell].z);
}

// At the exchange of this step.
fn feel(cell: u32, step: u32) {
    let now = pressure(cell);
    let trend = trends[cell];
    let passed = passed_until(step);
    let slope = (now - trend.x) / passed.x;
    var bend = 0.0;
    if passed.y > 0.0 {
        bend = 2.0 * (slope - trend.y) / (passed.x + passed.y);
    }
    let ahead = numbers.step * steps_ahead(step);
    let rise = ahead * (slope + 0.5 * bend * (passed.x + ahead));
    trends[cell] = vec4<f32>(now, slope, rise, 0.0);
    pressures[cell] = bounded(cell, now + rise);
}

// The same when cells have changed, as at the last exchange but for that.
fn feel_anew(cell: u32) {
    let now = pressure(cell);
    trends[cell].x = now;
    pressures[cell] = bounded(cell, now + trends[cell].z);
}
