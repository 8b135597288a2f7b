//! Walls and their loads over many steps: an f32 wall at 0.35 m would never move at 2 cm/s.

use crate::lab::{Suite, kernel, map};
use crate::rounding::ROUNDING;
use dem::contact::Tension;
use dem::{Model, State, StressLoad, Surface, Wall, WallMotion, WallState, gpu};
use glam::DVec3;
use shaders::{Device, Flags, compose_text, layout};
use std::f64::consts::TAU;
use tests::{MIDDLE, RADIUS, floor, smooth, state};

pub fn list(suite: &mut Suite) {
    suite.gpu("a_moving_wall_goes_as_far_as_it_should", moving);
    suite.gpu("the_sine_of_a_load_is_as_good_as_f32", sine);
    suite.gpu("a_load_stays_in_phase_for_4e9_steps", phase);
    suite.gpu("a_wall_under_a_late_load_moves_as_on_the_cpu", |d| {
        loaded(d, 2000);
    });
    suite.gpu("a_damped_wall_reaches_its_terminal_velocity", damped);
    suite.long("a_wall_under_a_load_moves_as_on_the_cpu_for_long", |d| {
        loaded(d, 1_000_000);
    });
}

fn lid(motion: WallMotion) -> Wall {
    Wall {
        name: "top".into(),
        normal: -DVec3::Z,
        surface: Surface::Frictionless,
        motion,
    }
}

/// A grain on the floor, and a wall 0.35 m up that never comes down to it.
fn below(motion: WallMotion) -> (Model, State) {
    let mut start = state(&[(MIDDLE + RADIUS * DVec3::Z, RADIUS)], 1);
    start.walls.push(WallState {
        offset: -0.35,
        velocity: 0.0,
    });
    let mut model = tests::model(smooth(1e9, 0.0, Tension::Clip), &start.grains);
    model.walls = vec![floor(Surface::Frictionless), lid(motion)];
    model.step = 6.6e-7;
    (model, start)
}

/// Two centimetres a second, 13 nm a step.
fn moving(device: &Device) {
    let (velocity, steps) = (0.02, 100_000);
    let (model, start) = below(WallMotion::Velocity(velocity));
    let mut solver = gpu::Solver::new(device, model.clone(), start).unwrap();
    solver.advance(steps).unwrap();
    let way = solver.snapshot().unwrap().state.walls[1].offset + 0.35;
    let expected = velocity * model.step * steps as f64;
    // Velocity, step over unit, and their product: each the same in all steps. And in each step
    // the last part of a coordinate, 2^-32 of a unit of 2^-29 m at most.
    let allowed = 3.0 * ROUNDING * expected + steps as f64 * 2f64.powi(-62);
    println!(
        "{way:.9e} m of {expected:.9e}: off by {:.1e} of {allowed:.1e}",
        way - expected
    );
    assert!((way - expected).abs() <= allowed);
}

/// Those of a scene with one wall.
fn flags() -> Flags {
    let numbers = [("WALLS", 1), ("BODIES", 2), ("SPREAD", 32)];
    let flags = numbers.into_iter();
    flags.fold(Flags::new(), |flags, (name, x)| flags.number(name, x))
}

const SINE: &str = "
    #import dem::boundary::sine
    @group(0) @binding(0) var<storage, read> inputs: array<f32>;
    @group(0) @binding(1) var<storage, read_write> outputs: array<f32>;
    @compute @workgroup_size(64)
    fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        if id.x < arrayLength(&inputs) {
            outputs[id.x] = sine(inputs[id.x]);
        }
    }";

/// Within a few roundings of one, all around.
fn sine(device: &Device) {
    let kernel = kernel(device, "sine.wgsl", SINE, &flags());
    let shares: Vec<f32> = (0..=4096).map(|k| k as f32 / 4096.0).collect();
    let found: Vec<f32> = map(device, &kernel, &shares, &[]);
    for (share, found) in shares.iter().zip(found) {
        let expected = (TAU * f64::from(*share)).sin();
        let off = (f64::from(found) - expected).abs();
        assert!(off < 3e-7, "{share}: {found}, off by {off:e}");
    }
}

const PHASE: &str = "
    #import dem::boundary::phase
    @group(0) @binding(0) var<storage, read> inputs: array<u32>;
    @group(0) @binding(1) var<storage, read_write> outputs: array<f32>;
    @compute @workgroup_size(64)
    fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        if id.x < arrayLength(&inputs) {
            outputs[id.x] = phase(0u, inputs[id.x]);
        }
    }";

/// The share of a turn at steps up to the last that a device counts, against 128 bits.
fn phase(device: &Device) {
    let flags = flags();
    let module = compose_text("phase.wgsl", PHASE, &flags).unwrap();
    let kernel = kernel(device, "phase.wgsl", PHASE, &flags);
    let offset = |name: &str, member: &str| {
        let (_, members) = layout::of(&module, name).expect(name);
        let found = members.iter().find(|(name, _)| name == member);
        found.expect(member).1 as usize / 4
    };
    let words = layout::of(&module, "Scene").expect("Scene").0 as usize / 4;
    // A period of 1.1e5 steps, that of a wave of a thousand days' tides, and one of a few steps.
    for (turn, start) in [
        (1.0 / 112_358.0, 0.25),
        (1.234_567e-12, 0.999_999),
        (0.381_966, 0.5),
    ] {
        let parts = |x: f64| (x * 2f64.powi(64)) as u64;
        let (turn, start) = (parts(turn), parts(start));
        let mut scene = vec![0u32; words];
        let wall = offset("Scene", "walls");
        for (member, value) in [("turn", turn), ("start", start)] {
            let high = offset("WallScene", &format!("{member}_hi"));
            let low = offset("WallScene", &format!("{member}_lo"));
            scene[wall + high] = (value >> 32) as u32;
            scene[wall + low] = value as u32;
        }
        let scene = device.array_of("scene", &scene).unwrap();
        let steps: Vec<u32> = (0..2000u32)
            .map(|k| k.wrapping_mul(2_147_481))
            .chain([0, 1, 1_000_000, u32::MAX])
            .collect();
        let found: Vec<f32> = map(device, &kernel, &steps, &[("scene", &scene)]);
        for (&step, &found) in steps.iter().zip(&found) {
            let parts = u128::from(turn) * u128::from(step) + u128::from(start);
            let expected = (parts as u64) as f64 / 2f64.powi(64);
            // 2^-32 is dropped, and the rest rounded to f32: 1 and 0 are the same phase.
            let off = (f64::from(found) - expected).abs();
            let off = off.min(1.0 - off);
            assert!(off <= ROUNDING, "step {step}: {found} of {expected}");
        }
    }
}

/// A sinusoidal load without mean, a million steps after time began: the wall swings with it.
fn loaded(device: &Device, steps: u64) {
    let period = 800.0;
    let load = StressLoad {
        mean: 0.0,
        amplitude: 1e4,
        frequency: 0.0,
        area: 0.04,
        mass: 15.52,
        damping: 0.0,
    };
    let (mut model, mut start) = below(WallMotion::Stress(load));
    let frequency = 1.0 / (period * model.step);
    model.walls[1].motion = WallMotion::Stress(StressLoad { frequency, ..load });
    start.time = 1_000_000.37 * model.step;
    // Swinging about where it is: v = -A/(M w) cos(w t).
    let speed = load.amplitude * load.area / load.mass / (TAU * frequency);
    start.walls[1].velocity = -speed * (TAU * frequency * start.time).cos();
    let mut solver = gpu::Solver::new(device, model.clone(), start.clone()).unwrap();
    let mut cpu = tests::solver(&model, &start);
    let mut worst: f64 = 0.0;
    // Parts that do not fit into the period.
    for _ in 0..20 {
        solver.advance(steps / 20 + 7).unwrap();
        cpu.advance(steps / 20 + 7).unwrap();
        let [a, b] = [cpu.snapshot(), solver.snapshot().unwrap()].map(|s| s.state.walls[1]);
        worst = worst.max((a.velocity - b.velocity).abs());
    }
    // A kick is rounded to the last place of the velocity, by chance up or down; six standard
    // deviations. The load's own rounding is of one sign for half a period, then of the other.
    let allowed = ROUNDING * speed * (6.0 * (steps as f64).sqrt() + period);
    println!("{steps} steps: velocity {speed:.3e} m/s off by {worst:.1e} of {allowed:.1e}");
    assert!(worst <= allowed);
}

/// M dv/dt = A σ - c v, over twenty times M/c. A velocity is at rest where a kick is less than half
/// of its last place: M/(c dt) half places from the terminal one.
fn damped(device: &Device) {
    let steps = 200.0;
    let (mass, step) = (15.52, 6.6e-7);
    let load = StressLoad {
        mean: 1e4,
        amplitude: 0.0,
        frequency: 0.0,
        area: 0.04,
        mass,
        damping: mass / (steps * step),
    };
    let (model, start) = below(WallMotion::Stress(load));
    let mut solver = gpu::Solver::new(device, model, start).unwrap();
    solver.advance(20 * steps as u64).unwrap();
    let found = solver.snapshot().unwrap().state.walls[1].velocity;
    let expected = load.mean * load.area / load.damping;
    let off = (found / expected - 1.0).abs();
    // An ulp is up to two roundings; constants are rounded, too.
    let allowed = 2.0 * (steps + 4.0) * ROUNDING + (-20.0_f64).exp();
    println!("{found:e} m/s of {expected:e}: off by {off:.1e} of {allowed:.1e}");
    assert!(off < allowed);
}
