//! Head-on collisions of the linear law: how fast grains part, and when.
//! Source: Schwager and Pöschel (2007), Granul. Matter 9, 465, for the clipped force.

use approx::assert_abs_diff_eq;
use dem::contact::Tension;
use dem::stability::{contact_time, damping_for, restitution};
use dem::{Model, State, Surface};
use glam::DVec3;
use tests::{MIDDLE, RADIUS, floor, mass, smooth, solver, state, steps_to};

const STIFFNESS: f64 = 1e7;
/// Speed at which they meet [m/s].
const SPEED: f64 = 0.5;

/// Who meets.
#[derive(Clone, Copy, Debug)]
enum Pair {
    Grains(f64, f64),
    GrainAndWall(f64),
}

impl Pair {
    fn effective_mass(self) -> f64 {
        match self {
            Self::Grains(a, b) => mass(a) * mass(b) / (mass(a) + mass(b)),
            Self::GrainAndWall(a) => mass(a),
        }
    }

    /// Model and state just before they meet, at a hundredth of the default step.
    fn set_up(self, damping: f64, tension: Tension) -> (Model, State) {
        let gap = 1e-8;
        let (mut start, walls) = match self {
            Self::Grains(a, b) => {
                let other = MIDDLE + DVec3::Z * (a + b + gap);
                (state(&[(MIDDLE, a), (other, b)], 0), vec![])
            }
            Self::GrainAndWall(a) => {
                let above = MIDDLE + DVec3::Z * (a + gap);
                (state(&[(above, a)], 1), vec![floor(Surface::Frictionless)])
            }
        };
        start.grains.velocity[0] = match self {
            Self::Grains(..) => SPEED * DVec3::Z,
            Self::GrainAndWall(_) => -SPEED * DVec3::Z,
        };
        let mut model = tests::model(smooth(STIFFNESS, damping, tension), &start.grains);
        model.walls = walls;
        model.step /= 100.0;
        (model, start)
    }

    /// Speed at which they part, over that at which they met.
    fn parting(self, state: &State) -> f64 {
        let velocity = &state.grains.velocity;
        match self {
            Self::Grains(..) => (velocity[1].z - velocity[0].z) / SPEED,
            Self::GrainAndWall(_) => velocity[0].z / SPEED,
        }
    }
}

const PAIRS: [Pair; 4] = [
    Pair::Grains(RADIUS, RADIUS),
    Pair::Grains(0.8 * RADIUS, 1.2 * RADIUS),
    Pair::Grains(0.2 * RADIUS, 2.0 * RADIUS),
    Pair::GrainAndWall(RADIUS),
];

/// Restitution and duration of the overlap [s].
fn collide(pair: Pair, damping: f64, tension: Tension) -> (f64, f64) {
    let (model, start) = pair.set_up(damping, tension);
    let mut solver = solver(&model, &start);
    let chunk = 10;
    let mut touching = 0;
    loop {
        solver.advance(chunk).expect("stable");
        let now = solver.snapshot();
        if !now.state.contacts.is_empty() {
            touching += chunk;
        } else if touching > 0 {
            return (pair.parting(&now.state), touching as f64 * model.step);
        }
        assert!(now.sums.steps < steps_to(1.0, &model), "they never part");
    }
}

#[test]
fn restitution_is_that_of_the_closed_form_for_both_kinds_of_tension() {
    for tension in [Tension::Clip, Tension::Keep] {
        let clipped = tension == Tension::Clip;
        for pair in PAIRS {
            let m = pair.effective_mass();
            for expected in [1.0, 0.8, 0.5, 0.2] {
                let damping = damping_for(expected, STIFFNESS, m, clipped);
                let (e, _) = collide(pair, damping, tension);
                assert!(
                    (e - expected).abs() < 1e-3,
                    "{pair:?} {tension:?}: restitution {e}, closed form {expected}"
                );
            }
        }
    }
}

/// The two kinds differ by far more than the tolerance above.
#[test]
fn a_clipped_force_gives_more_speed_back() {
    let pair = PAIRS[0];
    let m = pair.effective_mass();
    let damping = damping_for(0.5, STIFFNESS, m, false);
    let (clip, _) = collide(pair, damping, Tension::Clip);
    let (keep, _) = collide(pair, damping, Tension::Keep);
    let difference = restitution(STIFFNESS, damping, m, true) - 0.5;
    assert_abs_diff_eq!(clip - keep, difference, epsilon = 2e-3);
    assert!(difference > 0.04);
}

/// Unclipped: half a damped period. Clipped: from the moment t₀ = 2 arccos ζ / ω_d at which the
/// force is gone, grains part at e v through the overlap that is left, γ e v / k.
#[test]
fn a_contact_lasts_as_long_as_the_closed_form_says() {
    for pair in PAIRS {
        let m = pair.effective_mass();
        let damping = damping_for(0.5, STIFFNESS, m, false);
        let resolution = 1e-2 * contact_time(STIFFNESS, damping, m);
        let (_, kept) = collide(pair, damping, Tension::Keep);
        let expected = contact_time(STIFFNESS, damping, m);
        assert_abs_diff_eq!(kept, expected, epsilon = resolution);

        let zeta = damping / (2.0 * (m * STIFFNESS).sqrt());
        let damped = (STIFFNESS / m * (1.0 - zeta * zeta)).sqrt();
        let (_, clipped) = collide(pair, damping, Tension::Clip);
        let expected = 2.0 * zeta.acos() / damped + damping / STIFFNESS;
        assert_abs_diff_eq!(clipped, expected, epsilon = resolution);
    }
}
