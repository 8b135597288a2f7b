//! No contact makes energy, but for the integrator's own error, which falls with the step.

use dem::contact::{Linear, Sliding, Tension};
use dem::{Snapshot, State, Surface};
use glam::DVec3;
use tests::{MIDDLE, RADIUS, floor, mass, run, smooth, state, turning};

const STIFFNESS: f64 = 1e9;

fn motion(state: &State) -> f64 {
    state.grains.kinetic_energy() + state.grains.rotational_energy()
}

/// Laws that dissipate as little as can be, and the poster's.
fn laws() -> Vec<(&'static str, Linear)> {
    let friction = |ratio: f64, damping: f64, coefficients: [f64; 2]| {
        Some(Sliding {
            stiffness: ratio * STIFFNESS,
            damping,
            friction_static: coefficients[0],
            friction_dynamic: coefficients[1],
        })
    };
    let elastic = smooth(STIFFNESS, 0.0, Tension::Clip);
    let poster = Linear {
        sliding: friction(0.1, 780.0, [0.58, 0.47]),
        ..smooth(STIFFNESS, 780.0, Tension::Clip)
    };
    vec![
        ("elastic", elastic),
        (
            "rough",
            Linear {
                sliding: friction(2.0 / 7.0, 0.0, [1e3, 1e3]),
                ..elastic
            },
        ),
        (
            "frictional",
            Linear {
                sliding: friction(2.0 / 7.0, 0.0, [0.5, 0.5]),
                ..elastic
            },
        ),
        (
            "stick and slip",
            Linear {
                sliding: friction(1.0, 0.0, [0.58, 0.47]),
                ..elastic
            },
        ),
        ("poster", poster),
        (
            "pulling",
            Linear {
                tension: Tension::Keep,
                ..poster
            },
        ),
        (
            "turning",
            Linear {
                rolling: turning(0.1 * STIFFNESS, 0.0, 0.2),
                twisting: turning(0.1 * STIFFNESS, 0.0, 0.2),
                ..poster
            },
        ),
    ]
}

/// A grain hits a wall (or another grain) under an angle, with spin, at one moment within a step.
fn collide(
    law: Linear,
    step: f64,
    angle: f64,
    spin: DVec3,
    gap: f64,
    wall: bool,
) -> (State, Snapshot) {
    let velocity = DVec3::new(angle.sin(), 0.0, -angle.cos());
    let above = (MIDDLE + DVec3::Z * (RADIUS + gap), RADIUS);
    let below = (MIDDLE - DVec3::Z * RADIUS, RADIUS);
    let mut start = if wall {
        state(&[above], 1)
    } else {
        state(&[above, below], 0)
    };
    start.grains.velocity[0] = velocity;
    start.grains.angular_velocity[0] = spin;
    let mut model = tests::model(law, &start.grains);
    if wall {
        model.walls = vec![floor(Surface::Full)];
    }
    model.step = step;
    let period = (mass(RADIUS) / STIFFNESS).sqrt();
    let end = run(&model, &start, (8.0 * period / angle.cos() / step) as u64);
    assert!(end.state.contacts.is_empty(), "they have not parted");
    (start, end)
}

/// The largest gain of energy over many impacts, relative to what there was.
fn largest_gain(law: Linear, step: f64) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for angle in [0.0, 10.0, 25.0, 40.0, 55.0, 70.0, 80.0_f64] {
        for spin in [DVec3::ZERO, DVec3::Y * 80.0, DVec3::new(30.0, -60.0, 50.0)] {
            for phase in [0.02, 0.2, 0.4, 0.6, 0.8, 0.98] {
                for wall in [true, false] {
                    let angle = angle.to_radians();
                    let gap = phase * step * angle.cos();
                    let (start, end) = collide(law, step, angle, spin, gap, wall);
                    let gain = motion(&end.state) / motion(&start) - 1.0;
                    largest = largest.max(gain);
                }
            }
        }
    }
    largest
}

/// What the integrator may add: a contact begins and ends within a step, where the spring is
/// off by up to half a step's way, ½ k (v h/2)², out of ½ m* v². At the poster's step, 13 steps
/// per contact, that is 1.4e-2.
fn integrator_error(step: f64) -> f64 {
    0.25 * STIFFNESS / (0.5 * mass(RADIUS)) * step * step
}

/// The poster's step and a quarter of it. Without dashpots the worst of these impacts gains
/// 6.7e-3 of its energy at the poster's step, half the bound, and
/// 3.4e-4 at a quarter; with the poster's dashpots none gains any.
#[test]
fn no_impact_gains_energy_beyond_an_error_that_falls_with_the_step() {
    for (name, law) in laws() {
        let steps = [6.6e-7, 6.6e-7 / 4.0];
        let [coarse, fine] = steps.map(|step| largest_gain(law, step));
        println!("{name}: largest gain {coarse:.2e} at the poster's step, {fine:.2e} at a quarter");
        if law.normal_damping > 0.0 {
            assert!(
                coarse < 0.0 && fine < 0.0,
                "{name} gains {coarse:e} and {fine:e} in spite of its dashpot"
            );
            continue;
        }
        assert!(
            coarse < integrator_error(steps[0]),
            "{name} gains {coarse:e}"
        );
        assert!(fine < integrator_error(steps[1]), "{name} gains {fine:e}");
        // Second order, as the bound: two halvings, and nearer to two than to one.
        let order = 0.5 * tests::order(coarse, fine);
        assert!(order > 1.5, "{name}: the gain falls with order {order:.2}");
    }
}

/// And the ledger books each impact: what motion loses is found as dissipation.
#[test]
fn the_ledger_of_an_impact_closes_with_the_step() {
    for (name, law) in laws() {
        for wall in [true, false] {
            let residual = |step: f64| {
                let spin = DVec3::new(30.0, -60.0, 50.0);
                let (start, end) = collide(law, step, 0.6, spin, 0.3 * step, wall);
                (end.ledger.residual / motion(&start)).abs()
            };
            let (coarse, fine) = (residual(6.6e-7), residual(6.6e-7 / 8.0));
            let body = if wall { "wall" } else { "grain" };
            println!(
                "{name}, {body}: residual {coarse:.2e} at the poster's step, {fine:.2e} at 1/8"
            );
            assert!(
                fine < 1e-12 || fine < coarse / 3.0,
                "{name} on a {body}: {coarse:e} falls to {fine:e} only"
            );
        }
    }
}
