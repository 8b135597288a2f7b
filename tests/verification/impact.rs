//! Oblique impacts with friction.
//!
//! While a contact slides, its impulse along the plane is μ_d times the normal one: whatever
//! the restitution, Δv_t = μ_d Δv_n, and each grain's spin changes by 5/2 μ_d Δv_n / R (less
//! the overlap's share of the arm R - δ/2). While it sticks without dashpot, the velocity u of
//! the surfaces oscillates, u = u₀ cos ω_t t with ω_t² = 7/2 k_t/m*, for the half period π/ω_n
//! of the normal spring, ω_n² = k_n/m*.
//! Source: the closed forms of Chung and Ooi (2011), Granul. Matter 13, 643, and of
//! Maw, Barber and Fawcett (1976), Wear 38, 101, with linear springs.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dem::contact::{Linear, Sliding, Tension};
use dem::{Grains, Snapshot, Surface};
use glam::DVec3;
use tests::packing::{angular_momentum, momentum};
use tests::{MIDDLE, RADIUS, floor, mass, run, smooth, state, steps_to};

const STIFFNESS: f64 = 1e9;

/// Static friction is far from dynamic friction: a law that mixes them up fails.
fn sliding_law(restitution_damping: f64) -> Linear {
    Linear {
        sliding: Some(Sliding {
            stiffness: 2.0 / 7.0 * STIFFNESS,
            damping: restitution_damping,
            friction_static: 0.4,
            friction_dynamic: 0.25,
        }),
        ..smooth(STIFFNESS, restitution_damping, Tension::Clip)
    }
}
const MU_D: f64 = 0.25;

/// A grain of radius [`RADIUS`] just above the floor, after it hit it with `velocity` and `spin`.
fn bounce(law: Linear, velocity: DVec3, spin: DVec3) -> Snapshot {
    let mut start = state(&[(MIDDLE + DVec3::Z * (RADIUS + 1e-9), RADIUS)], 1);
    start.grains.velocity[0] = velocity;
    start.grains.angular_velocity[0] = spin;
    let mut model = tests::model(law, &start.grains);
    model.walls = vec![floor(Surface::Full)];
    run_through(&model, &start)
}

/// Two grains along `normal` (from the second to the first), after the first met the second,
/// which was at rest, with `velocity` and `spin`.
fn meet(law: Linear, radii: [f64; 2], normal: DVec3, velocity: DVec3, spin: DVec3) -> [Grains; 2] {
    let away = normal * (radii[0] + radii[1] + 1e-9);
    let mut start = state(&[(MIDDLE + away, radii[0]), (MIDDLE, radii[1])], 0);
    start.grains.velocity[0] = velocity;
    start.grains.angular_velocity[0] = spin;
    let model = tests::model(law, &start.grains);
    let end = run_through(&model, &start);
    [start.grains, end.state.grains]
}

fn run_through(model: &dem::Model, start: &dem::State) -> Snapshot {
    let heaviest = start.grains.mass.iter().copied().fold(0.0, f64::max);
    let mut model = model.clone();
    model.step /= 20.0;
    let half_period = std::f64::consts::PI * (heaviest / STIFFNESS).sqrt();
    let end = run(&model, start, steps_to(3.0 * half_period, &model));
    assert!(end.state.contacts.is_empty(), "they have not parted");
    end
}

/// The arm of the friction is R - δ/2, so the spin lags by less than this [-].
fn arm_loss(normal_speed: f64, m: f64, radius: f64) -> f64 {
    normal_speed * (m / STIFFNESS).sqrt() / (2.0 * radius)
}

#[test]
fn a_grain_that_slides_on_a_wall_loses_mu_d_times_its_change_of_normal_velocity() {
    for damping in [0.0, 780.0] {
        for spin in [0.0, 40.0, -40.0] {
            let before = DVec3::new(2.0, 0.0, -0.5);
            let after = bounce(sliding_law(damping), before, spin * DVec3::Y)
                .state
                .grains;
            let change = after.velocity[0] - before;
            assert!(change.z > 0.5, "it bounced");
            assert_relative_eq!(change.x, -MU_D * change.z, max_relative = 1e-12);
            let turned = (after.angular_velocity[0].y - spin) / (2.5 * MU_D * change.z / RADIUS);
            let loss = arm_loss(0.5, mass(RADIUS), RADIUS);
            assert!(
                turned < 1.0 && turned > 1.0 - loss,
                "spin over closed form {turned}"
            );
        }
    }
}

/// With e = 1 the closed forms need no measured restitution.
#[test]
fn a_spinning_grain_dropped_on_a_wall_leaves_sideways() {
    let (drop, spin) = (0.2, 300.0);
    let after = bounce(sliding_law(0.0), -drop * DVec3::Z, spin * DVec3::Y)
        .state
        .grains;
    // A grain that spins about +y pushes the floor towards -x and leaves along +x.
    assert_relative_eq!(after.velocity[0].x, 2.0 * MU_D * drop, max_relative = 1e-3);
    let slowed = 5.0 * MU_D * drop / RADIUS;
    assert_relative_eq!(
        after.angular_velocity[0].y,
        spin - slowed,
        max_relative = 1e-3
    );
}

#[test]
fn grains_that_slide_on_each_other_share_the_impulse_by_mass() {
    let normals = [DVec3::X, DVec3::Z, DVec3::new(1.0, 2.0, -2.0) / 3.0];
    for radii in [
        [RADIUS, RADIUS],
        [0.6 * RADIUS, RADIUS],
        [RADIUS, 0.6 * RADIUS],
    ] {
        for normal in normals {
            let tangent = normal.any_orthonormal_vector();
            let velocity = 3.0 * tangent - 0.5 * normal;
            let [before, after] = meet(sliding_law(780.0), radii, normal, velocity, DVec3::ZERO);
            let change = after.velocity[0] - velocity;
            // The contact plane turns by a few 1e-4 while they touch.
            let impulse = change.dot(normal);
            assert!(impulse > 0.0);
            assert_relative_eq!(change.dot(tangent), -MU_D * impulse, max_relative = 4e-3);
            for (k, radius) in radii.iter().enumerate() {
                let share = radius * before.mass[0] / before.moment_of_inertia[k];
                let expected = normal.cross(tangent) * (MU_D * impulse * share);
                let spin = after.angular_velocity[k];
                assert!((spin - expected).length() < 4e-3 * expected.length());
            }
        }
    }
}

#[test]
fn a_contact_that_sticks_turns_its_surface_velocity_by_the_phase_of_its_spring() {
    for ratio in [0.1, 2.0 / 7.0, 0.7, 8.0 / 7.0] {
        let law = Linear {
            sliding: Some(Sliding {
                stiffness: ratio * STIFFNESS,
                damping: 0.0,
                friction_static: 1e4,
                friction_dynamic: 1e4,
            }),
            ..smooth(STIFFNESS, 0.0, Tension::Clip)
        };
        let expected = ((3.5 * ratio).sqrt() * std::f64::consts::PI).cos();

        let before = DVec3::new(0.2, 0.1, -0.5);
        let after = bounce(law, before, DVec3::ZERO).state.grains;
        let surface = after.velocity[0] + after.angular_velocity[0].cross(-RADIUS * DVec3::Z);
        assert_abs_diff_eq!(surface.x / before.x, expected, epsilon = 5e-3);
        assert_abs_diff_eq!(surface.y / before.y, expected, epsilon = 5e-3);

        let velocity = DVec3::new(-0.5, 0.2, 0.1);
        let [_, after] = meet(law, [RADIUS, 0.7 * RADIUS], DVec3::X, velocity, DVec3::ZERO);
        let arm = |k: usize, radius: f64| after.angular_velocity[k].cross(radius * DVec3::X);
        let surface = after.velocity[0] - after.velocity[1] - arm(0, RADIUS) - arm(1, 0.7 * RADIUS);
        assert_abs_diff_eq!(surface.y / velocity.y, expected, epsilon = 5e-3);
        assert_abs_diff_eq!(surface.z / velocity.z, expected, epsilon = 5e-3);
    }
}

#[test]
fn an_oblique_impact_keeps_momentum_and_angular_momentum() {
    let velocity = DVec3::new(-0.5, 0.4, 0.3);
    let spin = DVec3::new(20.0, -30.0, 10.0);
    let [before, after] = meet(
        sliding_law(780.0),
        [RADIUS, 0.7 * RADIUS],
        DVec3::X,
        velocity,
        spin,
    );
    let lost = momentum(&after) - momentum(&before);
    assert!(lost.length() < 1e-14 * momentum(&before).length());
    let turned = angular_momentum(&after) - angular_momentum(&before);
    // Positions of about 0.7 m are rounded in each of some 5000 steps.
    let round_off = 5000.0 * f64::EPSILON * 0.7 * momentum(&before).length();
    assert!(turned.length() < round_off, "{turned} of {round_off:e}");
}
