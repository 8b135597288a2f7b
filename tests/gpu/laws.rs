//! Every contact law, WGSL in single precision against Rust in double precision, on a grid,
//! on random contacts, and on contacts at the limit of friction.
//!
//! Errors are counted in roundings, 2^-24 of the largest term that went into the number: a
//! spring force of 10 N and a dashpot of -10 N may leave a force that is all rounding.
//! Where the force is that close to the limit of friction, the two may differ about slip:
//! such contacts are counted, must be that close, and are left out. (Rolling and twisting have
//! one coefficient, so what they answer does not jump at their limits; nothing is left out.)

use crate::lab::{Suite, kernel, map};
use bytemuck::{Pod, Zeroable};
use dem::ContactLaw;
use dem::contact::probe::{self, Answer, Contact};
use dem::contact::{Linear, LinearLammps, Sliding, Tension, Turning};
use dem::gpu::law::{Law, flags};
use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::Device;
use std::collections::BTreeMap;

pub fn list(suite: &mut Suite) {
    suite.gpu("frictionless_law", |device| {
        check(device, &ContactLaw::Linear(linear(None, None, None)));
    });
    suite.gpu("frictional_law", |device| {
        check(
            device,
            &ContactLaw::Linear(linear(Some(SLIDING), None, None)),
        );
    });
    suite.gpu("frictional_law_that_turns", |device| {
        let law = linear(Some(SLIDING), Some(ROLLING), Some(TWISTING));
        check(device, &ContactLaw::Linear(law));
    });
    suite.gpu("frictional_law_that_only_rolls", |device| {
        check(
            device,
            &ContactLaw::Linear(linear(Some(SLIDING), Some(ROLLING), None)),
        );
    });
    suite.gpu("law_as_lammps_computes_it", |device| {
        let law = LinearLammps {
            normal_stiffness: 1e9,
            normal_damping: 780.0,
            tangential_stiffness: 1e9,
            tangential_damping: 780.0,
            friction: 0.3,
        };
        check(device, &ContactLaw::LinearLammps(law));
    });
}

/// The poster's stiffness, and coefficients that f32 rounds.
fn linear(sliding: Option<Sliding>, rolling: Option<Turning>, twisting: Option<Turning>) -> Linear {
    Linear {
        normal_stiffness: 1e9,
        normal_damping: 780.0,
        tension: Tension::Clip,
        sliding,
        rolling,
        twisting,
    }
}

const SLIDING: Sliding = Sliding {
    stiffness: 0.7e9,
    damping: 310.0,
    friction_static: 0.6,
    friction_dynamic: 0.4,
};
const ROLLING: Turning = Turning {
    stiffness: 0.3e9,
    damping: 130.0,
    friction: 0.1,
};
const TWISTING: Turning = Turning {
    stiffness: 0.1e9,
    damping: 90.0,
    friction: 0.07,
};

/// Allowed error, in roundings of the largest term: a dot product of three and a few steps.
const ROUNDINGS: f64 = 8.0;
const ROUNDING: f64 = 1.0 / 16_777_216.0;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
struct Input {
    normal: [f32; 3],
    overlap: f32,
    slip: [f32; 3],
    separation: f32,
    spin: [f32; 3],
    reduced_radius: f32,
    spring: [f32; 3],
    sliding: u32,
    force: [f32; 3],
    step: f32,
    rolling: [f32; 3],
    twisting: f32,
    couple: [f32; 3],
    radius: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Output {
    tangential: [f32; 3],
    normal_force: f32,
    couple: [f32; 3],
    twisting: f32,
    spring: [f32; 3],
    sliding: u32,
    rolling: [f32; 3],
    smooth_viscosity: f32,
    losses: [f32; 3],
    smooth_force: f32,
    arms: [f32; 3],
    unused: f32,
    energies: [f32; 2],
    unused_too: [f32; 2],
}

fn vector(v: [f32; 3]) -> DVec3 {
    Vec3::from_array(v).as_dvec3()
}

impl Input {
    /// The same contact, exactly, in double precision.
    fn contact(&self) -> Contact {
        Contact {
            normal: vector(self.normal),
            overlap: self.overlap.into(),
            separation: self.separation.into(),
            slip: vector(self.slip),
            spin: vector(self.spin),
            reduced_radius: self.reduced_radius.into(),
            spring: vector(self.spring),
            sliding: self.sliding != 0,
            force: vector(self.force),
            rolling: vector(self.rolling),
            twisting: self.twisting.into(),
            couple: vector(self.couple),
        }
    }
}

/// A contact whose size is told by a few numbers: overlap [m], rate of separation [m/s],
/// slip [m/s], springs as fractions of the static limit, and the time step [s].
struct Sizes {
    overlap: f64,
    separation: f64,
    slip: f64,
    spring: f64,
    sliding: bool,
    step: f64,
}

fn direction(random: &mut ChaCha8Rng) -> DVec3 {
    loop {
        let v = DVec3::from_array(random.random()) * 2.0 - 1.0;
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// Make a contact of these sizes. Its last force is the one that its springs and velocities
/// had a step ago, so that losses are small differences, as they are in a run.
fn make(law: &ContactLaw, sizes: &Sizes, random: &mut ChaCha8Rng) -> Input {
    let normal = direction(random).as_vec3();
    let n = normal.as_dvec3();
    let across = |random: &mut ChaCha8Rng| direction(random).cross(n).normalize_or_zero();
    let slip = across(random) * sizes.slip;
    // Carried along since the last step, the spring is a little out of the plane.
    let tilt = 1e-4 * random.random_range(-1.0..1.0);
    let limit = law.normal_stiffness() * sizes.overlap / 1e9;
    let spring = (across(random) + tilt * n) * (sizes.spring * 0.6 * limit);
    let rolling = (across(random) + tilt * n) * (sizes.spring * 0.3 * limit);
    let twisting = sizes.spring * 0.6 * limit * random.random_range(-1.0..1.0);
    let spin = direction(random) * (100.0 * sizes.slip);

    let radius = random.random_range(1e-3..1e-2);
    let mut contact = Contact {
        normal: n,
        overlap: (sizes.overlap + sizes.separation * sizes.step).max(0.0),
        separation: sizes.separation * random.random_range(0.9..1.1),
        slip: slip * random.random_range(0.9..1.1),
        spin: spin * random.random_range(0.9..1.1),
        reduced_radius: 0.5 * radius,
        spring,
        sliding: sizes.sliding,
        rolling,
        twisting,
        ..Contact::default()
    };
    let before = probe::respond(law, &contact, 0.0);
    contact.force = before.normal_force * n + before.tangential;
    let array = |v: DVec3| v.as_vec3().to_array();
    Input {
        normal: normal.to_array(),
        overlap: sizes.overlap as f32,
        slip: array(slip),
        separation: sizes.separation as f32,
        spin: array(spin),
        reduced_radius: contact.reduced_radius as f32,
        spring: array(spring),
        sliding: u32::from(sizes.sliding),
        force: array(contact.force),
        step: sizes.step as f32,
        rolling: array(rolling),
        twisting: twisting as f32,
        couple: array(before.couple),
        radius: radius as f32,
    }
}

fn grid(law: &ContactLaw, random: &mut ChaCha8Rng) -> Vec<Input> {
    let mut inputs = Vec::new();
    for overlap in [0.0, 1e-12, 1e-10, 1e-9, 1e-8, 4e-8, 1e-6, 1e-5] {
        for separation in [-1.0, -1e-2, -1e-4, 0.0, 1e-6, 1e-3, 0.1, 10.0] {
            for slip in [0.0, 1e-8, 1e-6, 1e-4, 1e-2, 1.0] {
                for spring in [0.0, 1e-3, 0.1, 0.5, 0.99, 1.0, 1.5] {
                    for step in [0.0, 1e-7, 6.6e-7, 1e-5] {
                        for sliding in [false, true] {
                            let sizes = Sizes {
                                overlap,
                                separation,
                                slip,
                                spring,
                                sliding,
                                step,
                            };
                            inputs.push(make(law, &sizes, random));
                        }
                    }
                }
            }
        }
    }
    inputs
}

fn at_random(law: &ContactLaw, random: &mut ChaCha8Rng) -> Vec<Input> {
    let mut inputs = Vec::new();
    for _ in 0..200_000 {
        let mut decades = |low: f64, high: f64| 10f64.powf(random.random_range(low..high));
        let sizes = Sizes {
            overlap: decades(-10.0, -5.0),
            separation: decades(-7.0, 0.0) * if decades(-1.0, 1.0) > 1.0 { 1.0 } else { -1.0 },
            slip: decades(-8.0, 0.0),
            spring: 1.5 * decades(-4.0, 0.0),
            sliding: decades(-1.0, 1.0) > 1.0,
            step: decades(-8.0, -5.0),
        };
        inputs.push(make(law, &sizes, random));
    }
    inputs
}

/// Contacts at rest whose springs pull with the limit of friction, give or take a millionth:
/// the static limit if they stick, the dynamic one if they slide.
fn at_the_limit(law: &ContactLaw, random: &mut ChaCha8Rng) -> Vec<Input> {
    let [sliding, ..] = parts(law);
    let make_one = |k: usize| {
        let sizes = Sizes {
            overlap: 10f64.powf(random.random_range(-9.0..-6.0)),
            separation: 0.0,
            slip: 0.0,
            spring: 0.0,
            sliding: k % 2 == 1,
            step: 1e-7,
        };
        let mut input = make(law, &sizes, random);
        let limit =
            law.normal_stiffness() * f64::from(input.overlap) * friction(law, sizes.sliding);
        let across = direction(random).cross(vector(input.normal)).normalize();
        let excess = 1.0 + random.random_range(-1e-6..1e-6);
        let spring = across * (limit / sliding.stiffness * excess);
        input.spring = spring.as_vec3().to_array();
        input
    };
    (0..20_000).map(make_one).collect()
}

/// Friction coefficient of a contact that slides, or sticks.
fn friction(law: &ContactLaw, slides: bool) -> f64 {
    match law {
        ContactLaw::Linear(Linear {
            sliding: Some(sliding),
            ..
        }) if slides => sliding.friction_dynamic,
        _ => parts(law)[0].friction,
    }
}

/// Sizes of the largest terms of one contact.
struct Terms {
    /// Of the trial force, of the tangential spring.
    trial: f64,
    spring: f64,
    normal: f64,
    rolling: f64,
    twisting: f64,
}

/// Springs and sliders of `law`: tangential, rolling, twisting.
fn parts(law: &ContactLaw) -> [Turning; 3] {
    let none = Turning {
        stiffness: 1.0,
        damping: 0.0,
        friction: 0.0,
    };
    match law {
        ContactLaw::LinearLammps(law) => {
            let sliding = Turning {
                stiffness: law.tangential_stiffness,
                damping: law.tangential_damping,
                friction: law.friction,
            };
            [sliding, none, none]
        }
        ContactLaw::Linear(law) => {
            let sliding = law.sliding.map_or(none, |s| Turning {
                stiffness: s.stiffness,
                damping: s.damping,
                friction: s.friction_static,
            });
            [
                sliding,
                law.rolling.unwrap_or(none),
                law.twisting.unwrap_or(none),
            ]
        }
    }
}

impl Terms {
    fn of(law: &ContactLaw, c: &Contact, step: f64) -> Self {
        let [sliding, rolling, twisting] = parts(law);
        let normal = law.normal_stiffness() * c.overlap + law.normal_damping() * c.separation.abs();
        // Trial force, or the force that the limit allows.
        let trial = |part: Turning, spring: f64, rate: f64| {
            part.stiffness * (spring + step * rate) + part.damping * rate + part.friction * normal
        };
        let rate = c.spin.length() * c.reduced_radius;
        let slide = trial(sliding, c.spring.length(), c.slip.length());
        Self {
            trial: slide,
            spring: slide / sliding.stiffness,
            normal,
            rolling: trial(rolling, c.rolling.length(), rate),
            twisting: trial(twisting, c.twisting.abs(), rate),
        }
    }
}

/// Largest errors in roundings, by name, and the contacts left out.
#[derive(Default)]
struct Faults {
    worst: BTreeMap<&'static str, (f64, String)>,
    undecided: usize,
    slides: usize,
}

impl Faults {
    /// `fault` against the largest term `scale`.
    fn note(&mut self, name: &'static str, fault: f64, scale: f64, c: &Contact) {
        // Below the normal numbers f32 has no roundings to count in.
        let roundings = fault.abs() / (scale * ROUNDING).max(f64::from(f32::MIN_POSITIVE));
        let worst = self.worst.entry(name).or_insert((0.0, String::new()));
        if roundings.is_nan() || roundings > worst.0 {
            *worst = (roundings, format!("{fault:e} of {scale:e} in {c:?}"));
        }
    }
}

fn check(device: &Device, law: &ContactLaw) {
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut inputs = grid(law, &mut random);
    let on_grid = inputs.len();
    inputs.extend(at_random(law, &mut random));
    let random_ones = inputs.len() - on_grid;
    if law.slides() {
        inputs.extend(at_the_limit(law, &mut random));
    }
    let text = include_str!("laws.wgsl");
    let kernel = kernel(device, "laws.wgsl", text, &flags(law, true));
    let constants = device
        .array_of("constants", &[Law::of(law).unwrap()])
        .unwrap();
    let outputs: Vec<Output> = map(device, &kernel, &inputs, &[("constants", &constants)]);

    let mut faults = Faults::default();
    for (input, output) in inputs.iter().zip(&outputs) {
        compare(law, input, output, &mut faults);
    }
    println!(
        "{on_grid} contacts on the grid, {random_ones} at random, {} at the limit: {} slide, {} are \
         too close to slip to tell; largest errors in roundings of the largest term:",
        inputs.len() - on_grid - random_ones,
        faults.slides,
        faults.undecided,
    );
    for (name, (roundings, _)) in &faults.worst {
        println!("    {name:24} {roundings:.2}");
    }
    let wrong = faults
        .worst
        .iter()
        .filter(|(_, (roundings, _))| roundings.is_nan() || *roundings > ROUNDINGS);
    let wrong: Vec<_> = wrong.collect();
    assert!(wrong.is_empty(), "beyond {ROUNDINGS} roundings: {wrong:#?}");
    assert!(
        faults.undecided * 10 < inputs.len(),
        "{} undecided",
        faults.undecided
    );
}

fn compare(law: &ContactLaw, input: &Input, output: &Output, faults: &mut Faults) {
    let c = input.contact();
    let step = f64::from(input.step);
    let exact = probe::respond(law, &c, step);
    let terms = Terms::of(law, &c, step);
    let [arm, between, wall] = probe::arms(law, input.radius.into(), c.overlap);
    for (ours, exact) in output.arms.iter().zip([arm, between, wall]) {
        faults.note("arms", f64::from(*ours) - exact, input.radius.into(), &c);
    }
    for (ours, exact) in output.energies.iter().zip(probe::energies(law, &c)) {
        let fault = f64::from(*ours) - exact;
        faults.note("energies of springs", fault, exact, &c);
    }
    let force = f64::from(output.normal_force);
    faults.note("normal force", force - exact.normal_force, terms.normal, &c);
    let way = (c.separation * step).abs();
    let pressed = terms.normal + c.force.length() + law.normal_stiffness() * way;
    smooth_wall(law, &c, step, output, pressed * way, faults);

    if !law.slides() {
        let fault = f64::from(output.losses[1]) - exact.losses[1];
        faults.note("loss of dashpot", fault, pressed * way, &c);
        return;
    }
    faults.slides += usize::from(exact.sliding);
    if exact.sliding != (output.sliding != 0) {
        // Both right within rounding: the force must be the limit, within rounding.
        let [sliding, ..] = parts(law);
        let carried = c.spring - c.spring.dot(c.normal) * c.normal;
        let trial = sliding.stiffness * (carried + step * c.slip) + sliding.damping * c.slip;
        let excess = trial.length() - friction(law, c.sliding) * exact.normal_force.abs();
        faults.note("distance from slip", excess, terms.trial, &c);
        faults.undecided += 1;
        return;
    }
    let fault = (vector(output.tangential) - exact.tangential).length();
    faults.note("tangential force", fault, terms.trial, &c);
    let fault = (vector(output.spring) - exact.spring).length();
    faults.note("tangential spring", fault, terms.spring, &c);

    // Work of both forces, and energy of both springs.
    let [sliding, ..] = parts(law);
    let work = step * (c.force.length() + terms.trial) * c.slip.length();
    let stored = sliding.stiffness * (c.spring.length() + terms.spring).powi(2);
    let fault = f64::from(output.losses[0]) - exact.losses[0];
    faults.note("loss of sliding", fault, work + stored, &c);
    let fault = f64::from(output.losses[1]) - exact.losses[1];
    faults.note("loss of dashpots", fault, work + stored + pressed * way, &c);
    ledger_closes(
        &c,
        step,
        sliding.stiffness,
        output,
        pressed * way,
        work,
        faults,
    );
    if law.turns() {
        turning(law, &c, step, output, &exact, &terms, faults);
    }
}

/// The smooth wall's law, whatever that of the grains.
fn smooth_wall(
    law: &ContactLaw,
    c: &Contact,
    step: f64,
    output: &Output,
    scale: f64,
    faults: &mut Faults,
) {
    let tension = match law {
        ContactLaw::Linear(law) => law.tension,
        ContactLaw::LinearLammps(_) => Tension::Keep,
    };
    let smooth = ContactLaw::Linear(Linear {
        normal_stiffness: law.normal_stiffness(),
        normal_damping: law.normal_damping(),
        ..linear(None, None, None)
    });
    let ContactLaw::Linear(mut smooth) = smooth else {
        unreachable!("made just above")
    };
    smooth.tension = tension;
    let exact = probe::respond(&ContactLaw::Linear(smooth), c, step);
    let fault = f64::from(output.smooth_force) - exact.normal_force;
    let normal = law.normal_stiffness() * c.overlap + law.normal_damping() * c.separation.abs();
    faults.note("force of smooth wall", fault, normal, c);
    let fault = f64::from(output.smooth_viscosity) - exact.losses[1];
    faults.note("loss at smooth wall", fault, scale, c);
}

/// The ledger counts the springs as they are stored: against these the losses are far more
/// accurate than the springs' energies.
fn ledger_closes(
    c: &Contact,
    step: f64,
    k_t: f64,
    output: &Output,
    normal: f64,
    work: f64,
    faults: &mut Faults,
) {
    let (force, spring) = (vector(output.tangential), vector(output.spring));
    let stored = k_t * (spring - c.spring).dot(spring + c.spring);
    let loss = -0.5 * (step * (c.force + force).dot(c.slip) + stored);
    let scale = work + k_t * (spring - c.spring).length() * (spring.length() + c.spring.length());
    // The dashpot of the normal is in the other sum; the smooth wall has told it.
    let ours = f64::from(output.losses[0]) + f64::from(output.losses[1]);
    let tangential = ours - f64::from(output.smooth_viscosity);
    faults.note(
        "energy balance of a step",
        tangential - loss,
        scale + normal,
        c,
    );
}

fn turning(
    law: &ContactLaw,
    c: &Contact,
    step: f64,
    output: &Output,
    exact: &Answer,
    terms: &Terms,
    faults: &mut Faults,
) {
    let [_, rolling, twisting] = parts(law);
    let arm = c.reduced_radius;
    let fault = (vector(output.couple) - exact.couple).length();
    faults.note("couple", fault, (terms.rolling + terms.twisting) * arm, c);
    let fault = (vector(output.rolling) - exact.rolling).length();
    faults.note(
        "rolling spring",
        fault,
        terms.rolling / rolling.stiffness,
        c,
    );
    let fault = f64::from(output.twisting) - exact.twisting;
    faults.note(
        "twisting spring",
        fault,
        terms.twisting / twisting.stiffness,
        c,
    );
    let work = step * (c.couple.length() + (terms.rolling + terms.twisting) * arm);
    let rolled =
        rolling.stiffness * (c.rolling.length() + terms.rolling / rolling.stiffness).powi(2);
    let twisted =
        twisting.stiffness * (c.twisting.abs() + terms.twisting / twisting.stiffness).powi(2);
    let fault = f64::from(output.losses[2]) - exact.losses[2];
    let scale = work * c.spin.length() + rolled + twisted;
    faults.note("loss of rolling", fault, scale, c);
}
