//! A load of 10 kPa more on a saturated bed that drains at the top: Terzaghi's theory with the
//! stiffness of the dry skeleton and the storage of the pores.
//!
//! p/p0 = Σ 2/m sin(m (1 - z/H)) exp(-m² T), m = π/2, 3π/2, ...; z from the drained top here.
//! Source: Terzaghi (1943), Theoretical Soil Mechanics.

use crate::bed::*;
use coupling::{Coupled, Model, skeleton_stiffness};
use dem::{ContactLaw, Solver, State, StressLoad};
use lbm::Side;
use std::f64::consts::PI;
use std::sync::OnceLock;

pub const LOAD: f64 = 1e4;

/// Description, state, and the stiffness of the dry skeleton [Pa].
pub type Bed = (dem::Model, State, f64);

/// The bed with grains of k_n = 1e7 N/m.
fn soft() -> Bed {
    static BED: OnceLock<Bed> = OnceLock::new();
    BED.get_or_init(|| soft_from(1)).clone()
}

/// The same from another seed.
pub fn soft_from(seed: u64) -> Bed {
    let (model, state) = (model(law(), STRESS), pressed_from(seed));
    let m = skeleton_stiffness(&model, &state, LOAD, 0.04).unwrap();
    (model, state, m)
}

/// The same of 1e9 N/m, pressed anew: water is as soft as this skeleton. It has borne more than
/// the load of the test twice before, so that its stiffness is one number: it varies by 0.5 %
/// with load and time. A virgin bed yields: 8.1e9 Pa where 10 kPa come at once, 9.3e9 where they
/// come slowly, and Terzaghi's pressure at T = 0.4 with the one is 15 % above that with the other.
pub fn stiff_from(seed: u64) -> Bed {
    stiffer_from(seed, 100.0)
}

/// The same so many times stiffer than `soft_from`.
pub fn stiffer_from(seed: u64, times: f64) -> Bed {
    let faster = times.sqrt();
    let mut model = model(law(), STRESS);
    let ContactLaw::Linear(law) = &mut model.law else {
        unreachable!("the law is linear");
    };
    law.normal_stiffness *= times;
    law.normal_damping *= faster;
    if let Some(sliding) = &mut law.sliding {
        sliding.stiffness *= times;
        sliding.damping *= faster;
    }
    model.step /= faster;
    let mut state = pressed_from(seed);
    state.contacts.clear();
    // Pressed anew, then loaded by twice as much as later, and unloaded: what slides has slid.
    let sudden = [0.0, 2.0 * LOAD, 0.0, 2.0 * LOAD, 0.0];
    for (more, turns) in sudden.into_iter().zip([12, 2, 2, 2, 4]) {
        let damped = with_load(&model, |load| StressLoad {
            mean: STRESS + more,
            damping: 3e4,
            ..load
        });
        for _ in 0..turns {
            let mut solver = Solver::new(damped.clone(), state, 1).unwrap();
            solver.advance(8000).unwrap();
            state = solver.snapshot().state;
            state.grains.velocity.fill(glam::DVec3::ZERO);
            state.grains.angular_velocity.fill(glam::DVec3::ZERO);
            state.walls[1].velocity = 0.0;
        }
    }
    state.time = 0.0;
    let m = skeleton_stiffness(&model, &state, LOAD, 0.06 / faster).unwrap();
    (model, state, m)
}

/// Terzaghi's pressure over that at first, at `depth` below the drained top, both over H and T.
pub fn terzaghi(depth: f64, time: f64) -> f64 {
    let terms = (0..200).map(|k| {
        let m = PI * (k as f64 + 0.5);
        2.0 / m * (m * depth).sin() * (-m * m * time).exp()
    });
    terms.sum()
}

/// Errors of the pressure in the lowest cells at T = 0.05, 0.1, 0.2, 0.4.
pub fn errors<const N: usize>((model, state, m): Bed, mut water: Model) -> [f64; 4] {
    water.stiffness = Some(m);
    let step_size = model.step;
    let loaded = with_load(&model, |load| StressLoad {
        mean: STRESS + LOAD,
        ..load
    });
    let mut bed = Coupled::<N>::new(loaded, state, water, None, 1).unwrap();
    let report = bed.report();
    let (storage, height) = (report.storage, report.height);
    let first = LOAD / (1.0 + storage * m);
    let diffusivity = report.permeability / WATER.viscosity / (storage + 1.0 / m);
    let unit = height * height / diffusivity;
    let nz = bed.water().model().cells[2];
    let depth = 1.0 - 0.5 / nz as f64;
    println!(
        "M {m:.3e} Pa, p0 {first:.0} Pa, {:.0} steps for T = 1",
        unit / step_size
    );
    print!("{report}");
    let mut done = 0;
    [0.05, 0.1, 0.2, 0.4].map(|time| {
        // A mean over the waves of the bed, which take about a millisecond.
        let (mut sum, mut theory, mut count) = (0.0, 0.0, 0);
        let middle = (time * unit / step_size) as u64;
        for step in (middle - 380..middle + 380).step_by(20) {
            bed.advance(step - done).unwrap();
            done = step;
            let pressure = bed.water().pressure();
            let base: f64 = pressure.iter().step_by(nz).sum();
            sum += base / (pressure.len() / nz) as f64;
            theory += first * terzaghi(depth, step as f64 * step_size / unit);
            count += 1;
        }
        let settled = bed.grains().snapshot();
        println!(
            "T {time}: p {:.0} theory {:.0} ({:+.1} %), grains {:.0} {:.0} Pa",
            sum / count as f64,
            theory / count as f64,
            100.0 * (sum / theory - 1.0),
            settled.wall_force[0] / AREA,
            settled.wall_force[1] / AREA,
        );
        sum / theory - 1.0
    })
}

/// Within 3 % once the waves that the load has sent through the bed are gone.
fn judge(errors: [f64; 4]) {
    assert!(
        errors[0].abs() < 0.06 && errors[1].abs() < 0.06,
        "{errors:?}"
    );
    assert!(
        errors[2].abs() < 0.03 && errors[3].abs() < 0.03,
        "{errors:?}"
    );
}

#[test]
fn a_loaded_bed_consolidates_as_terzaghi_says() {
    judge(errors::<3>(soft(), water(1e-12)));
}

#[test]
#[ignore = "a minute: the same in cells of one diameter"]
fn a_loaded_bed_consolidates_as_terzaghi_says_in_cells_of_one_diameter() {
    let mut water = water(1e-12);
    water.cells = [10, 10, 9];
    judge(errors::<5>(soft(), water));
}

/// Where water is as soft as the skeleton, loosely held grains count: of three beds the mean error
/// at T = 0.4 is -1 % with f = 1, the default, and -4 % with 0.5. Each bed departs from the mean by
/// up to 3 %, whatever f.
#[test]
#[ignore = "two minutes: stiff beds are pressed in small steps"]
fn beds_of_stiff_grains_consolidate_as_terzaghi_says() {
    let beds = [1, 2, 3].map(stiff_from);
    let mean = |loose: f64| {
        let mut water = water(1e-12);
        water.loose = loose;
        let found = beds
            .each_ref()
            .map(|bed| errors::<3>(bed.clone(), water.clone()));
        [0, 1, 2, 3].map(|time| found.iter().map(|errors| errors[time] / 3.0).sum::<f64>())
    };
    judge(mean(1.0));
    let leaks = mean(0.5);
    assert!(leaks[3] < -0.03, "{leaks:?}");
}

/// A sealed bed: the water takes Skempton's share B = 1/(1 + S M) of a load at once.
#[test]
fn a_sealed_bed_takes_skemptons_share_of_a_load() {
    let (model, state, m) = soft();
    let mut sealed = water(1e-12);
    sealed.sides = [Side::FreeSlip, Side::FreeSlip];
    sealed.stiffness = Some(m);
    let loaded = with_load(&model, |load| StressLoad {
        mean: STRESS + LOAD,
        damping: 2e4,
        ..load
    });
    let mut bed = Coupled::<3>::new(loaded, state, sealed, None, 1).unwrap();
    bed.advance(3000).unwrap();
    let (mut sum, count) = (0.0, 100);
    for _ in 0..count {
        bed.advance(20).unwrap();
        let cells = bed.water().pressure();
        sum += cells.iter().sum::<f64>() / cells.len() as f64 / f64::from(count);
    }
    let share = bed.report().skempton.expect("the stiffness was given");
    println!("{sum} Pa, B {share}");
    assert!(
        (sum / (LOAD * share) - 1.0).abs() < 0.01,
        "{sum} Pa, B {share}"
    );
}
