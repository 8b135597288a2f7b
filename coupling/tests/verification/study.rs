//! The cases of the tests over the whole range of beds and waters, as the tables of
//! `coupling/studies/`.
//!
//! `bash coupling/studies/run.sh` runs them all, and draws the figures.

use crate::balance::shake;
use crate::bed::*;
use crate::consolidation::{Bed, LOAD, errors, soft_from, stiff_from, stiffer_from, terzaghi};
use crate::dilation::dilated;
use crate::shear::sheared;
use coupling::{Coupled, Model};
use dem::{Solver, StressLoad};
use std::fmt::Display;
use std::path::Path;

/// Write a table of `coupling/studies/`.
fn write(name: &str, header: &str, rows: &[Vec<String>]) {
    let lines = rows.iter().map(|row| row.join(",") + "\n");
    let text = format!("{header}\n{}", lines.collect::<String>());
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("studies")
        .join(name);
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

fn row<const N: usize>(cells: [&dyn Display; N]) -> Vec<String> {
    let row = cells.map(|cell| cell.to_string()).to_vec();
    println!("{}", row.join(","));
    row
}

fn number(x: f64) -> String {
    format!("{x:.4}")
}

/// Permeabilities [m²] of the map, and intervals.
const PERMEABILITIES: [f64; 11] = [
    1e-17, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7,
];
const INTERVALS: [u64; 5] = [1, 4, 16, 64, 256];

/// Steps until the pressure is read, and over which it is averaged.
const READ_AT: u64 = 3700;
const READ: u64 = 800;

/// Water in a bed, so many times softer than it is.
fn softened(bed: &Bed, permeability: f64, times: f64, interval: u64) -> Model {
    let mut water = water(permeability);
    water.interval = Some(interval);
    water.fluid.compressibility *= times;
    // Water that is softened on purpose says nothing of the skeleton, or is refused.
    water.stiffness = (times == 1.0).then_some(bed.2);
    water
}

/// Kinetic energy of a shaken bed after a thousand steps, over that at first; infinite where the
/// run has failed. None where it is refused, and D_n, and sub-steps.
fn calmed(bed: &Bed, water: &Model) -> Option<(f64, f64, u64)> {
    let state = shake(bed.1.clone(), 1e-3);
    let mut run = Coupled::<3>::new(bed.0.clone(), state, water.clone(), None, 1).ok()?;
    let report = run.report();
    let energy = |run: &Coupled<3>| run.grains().snapshot().ledger.kinetic;
    let start = energy(&run);
    let growth = match run.advance(1000) {
        Ok(()) => energy(&run) / start,
        Err(_) => f64::INFINITY,
    };
    Some((growth, report.diffusivity, report.sub_steps))
}

/// Mean pressure of a loaded bed less that of Terzaghi with real water, over the first pressure
/// with that.
fn off(bed: &Bed, model: Model) -> f64 {
    let loaded = with_load(&bed.0, |load| StressLoad {
        mean: STRESS + LOAD,
        ..load
    });
    let permeability = match model.resistance {
        coupling::Resistance::Darcy(law) => law.at(0.4),
        _ => unreachable!("Darcy's law"),
    };
    let mut run = Coupled::<3>::new(loaded, bed.1.clone(), model, None, 1).unwrap();
    let report = run.report();
    let storage = report.porosity * WATER.compressibility;
    let first = LOAD / (1.0 + storage * bed.2);
    let diffusivity = permeability / WATER.viscosity / (storage + 1.0 / bed.2);
    let unit = report.height.powi(2) / diffusivity;
    let (mut sum, mut theory, mut done) = (0.0, 0.0, 0);
    for step in (READ_AT..READ_AT + READ).step_by(20) {
        if run.advance(step - done).is_err() {
            return f64::INFINITY;
        }
        done = step;
        let pressure = run.water().pressure();
        sum += pressure.iter().sum::<f64>() / pressure.len() as f64;
        let time = step as f64 * bed.0.step / unit;
        let cells = [0.125, 0.375, 0.625, 0.875];
        theory += first * cells.map(|depth| terzaghi(depth, time)).iter().sum::<f64>() / 4.0;
    }
    (sum - theory) / (READ / 20) as f64 / first
}

/// Stability and accuracy, over permeability, softness of the water, interval, and stiffness of
/// grains.
#[test]
#[ignore = "a study: five minutes"]
fn study_map() {
    let mut rows = Vec::new();
    for (contact, bed) in [(1e7, soft_from(1)), (1e9, stiff_from(1))] {
        println!("k_n {contact:e}: M {:.3e} Pa", bed.2);
        for times in [1.0, 10.0, 100.0] {
            for permeability in PERMEABILITIES {
                for interval in INTERVALS {
                    let water = softened(&bed, permeability, times, interval);
                    let head: [&dyn Display; 4] =
                        [&contact, &times, &format!("{permeability:e}"), &interval];
                    let Some((growth, diffusivity, sub_steps)) = calmed(&bed, &water) else {
                        let [a, b, c, d] = head;
                        rows.push(row([a, b, c, d, &"", &"", &"refused", &""]));
                        continue;
                    };
                    // Softened water is as accurate as its theory; one interval shows that.
                    let asked = times == 1.0 || interval == 1 || interval == 16;
                    let error = match asked && growth < 1.0 {
                        true => number(off(&bed, water)),
                        false => String::new(),
                    };
                    let [a, b, c, d] = head;
                    rows.push(row([
                        a,
                        b,
                        c,
                        d,
                        &format!("{diffusivity:.3e}"),
                        &sub_steps,
                        &format!("{growth:.3e}"),
                        &error,
                    ]));
                }
            }
        }
    }
    write(
        "map.csv",
        "contact stiffness,times softer,permeability,interval,D_n,sub-steps,energy left,error",
        &rows,
    );
}

/// How loosely held grains count: consolidation of several beds of soft and of stiff grains.
#[test]
#[ignore = "a study: five minutes"]
fn study_loose() {
    let mut rows = Vec::new();
    let beds = [
        (1e7, soft_from as fn(u64) -> Bed, 3),
        (4e7, |seed| stiffer_from(seed, 4.0), 3),
        (1e8, |seed| stiffer_from(seed, 10.0), 3),
        (1e9, stiff_from, 6),
    ];
    for (contact, bed_from, seeds) in beds {
        for seed in 1..=seeds {
            let bed = bed_from(seed);
            for loose in [0.5, 1.0, 2.0, 4.0] {
                let mut water = water(1e-12);
                water.loose = loose;
                let [a, b, c, d] = errors::<3>(bed.clone(), water).map(number);
                let storage = number(0.4 * WATER.compressibility * bed.2);
                rows.push(row([&contact, &seed, &storage, &loose, &a, &b, &c, &d]));
            }
        }
    }
    write(
        "loose.csv",
        "contact stiffness,seed,S M,f,T 0.05,T 0.1,T 0.2,T 0.4",
        &rows,
    );
}

/// Mean shear stress and pressure [Pa] from strain 0.01 to 0.05 at 1 /s, drained at the top; and
/// the root of the mean square of the pressure in time.
fn strength(seed: u64, water: Option<Model>) -> [f64; 3] {
    let (model, state) = sheared(pressed_from(seed), 0.17);
    let [first, steps] = [1500, 6000];
    let mean = |before: &dem::Sums, now: &dem::Sums| {
        -(now.driven_force - before.driven_force) / AREA / (now.steps - before.steps) as f64
    };
    let Some(water) = water else {
        let mut dry = Solver::new(model, state, 1).unwrap();
        dry.advance(first).unwrap();
        let before = dry.snapshot().sums;
        dry.advance(steps).unwrap();
        return [mean(&before, &dry.snapshot().sums), 0.0, 0.0];
    };
    let mut wet = Coupled::<3>::new(model, state, water, None, 1).unwrap();
    wet.advance(first).unwrap();
    let before = wet.grains().snapshot().sums;
    let (mut sum, mut squares) = (0.0, 0.0);
    let count = steps / 50;
    for _ in 0..count {
        wet.advance(50).unwrap();
        let pressure = wet.water().pressure();
        let now = pressure.iter().sum::<f64>() / pressure.len() as f64;
        sum += now / count as f64;
        squares += now * now / count as f64;
    }
    let shear = mean(&before, &wet.grains().snapshot().sums);
    [shear, sum, (squares - sum * sum).max(0.0).sqrt()]
}

/// Shear strength of beds that drain partly, over exchanges, intervals and the weight of loose grains.
#[test]
#[ignore = "a study: two minutes"]
fn study_shear() {
    let mut rows = Vec::new();
    for seed in 1..=3 {
        let mut add = |permeability: f64, exchange: u64, interval: u64, loose: f64| {
            let mut water = water(permeability);
            water.exchange = Some(exchange);
            water.interval = Some(interval);
            water.loose = loose;
            let [shear, pressure, noise] = strength(seed, Some(water)).map(|x| format!("{x:.0}"));
            rows.push(row([
                &seed,
                &format!("{permeability:e}"),
                &exchange,
                &interval,
                &loose,
                &shear,
                &pressure,
                &noise,
            ]));
        };
        for interval in [1, 2, 4, 8, 16] {
            add(1e-11, 1, interval, 1.0);
        }
        for [exchange, interval] in [[2, 2], [2, 4], [2, 8]] {
            add(1e-11, exchange, interval, 1.0);
        }
        for permeability in [1e-10, 1e-9] {
            for exchange in [1, 2] {
                add(permeability, exchange, exchange, 1.0);
            }
        }
        add(1e-10, 1, 2, 1.0);
        for loose in [0.5, 2.0, 4.0] {
            add(1e-11, 1, 1, loose);
        }
        let [shear, ..] = strength(seed, None).map(|x| format!("{x:.0}"));
        rows.push(row([&seed, &"dry", &"", &"", &"", &shear, &"", &""]));
    }
    write(
        "shear.csv",
        "seed,permeability,exchange,interval,f,shear stress,pressure,noise",
        &rows,
    );
}

/// From storage to flow: a bed that dilates at a given rate.
#[test]
#[ignore = "a study: half a minute"]
fn study_deborah() {
    let powers = (0..13).map(|k| -15.0 + 0.5 * f64::from(k));
    let rows: Vec<_> = powers
        .map(|power| {
            let permeability = 10f64.powf(power);
            let (found, theory, deborah) = dilated(permeability, 600);
            let [found, theory] = [found[0], theory[0]].map(|p| format!("{p:.1}"));
            row([
                &format!("{permeability:.3e}"),
                &format!("{deborah:.4e}"),
                &found,
                &theory,
            ])
        })
        .collect();
    write("deborah.csv", "permeability,De,base,theory", &rows);
}

/// Consolidation with fluid steps ever rarer, with and without prediction.
#[test]
#[ignore = "a study: a minute"]
fn study_intervals() {
    let mut rows = Vec::new();
    let bed = soft_from(1);
    for predicts in [true, false] {
        for interval in [1, 8, 32, 128] {
            let mut water = water(1e-12);
            water.interval = Some(interval);
            water.predicts = predicts;
            water.stiffness = Some(bed.2);
            let (growth, diffusivity, _) = calmed(&bed, &water).expect("it is not refused");
            let found = match growth < 1.0 {
                true => errors::<3>(bed.clone(), water).map(number),
                false => std::array::from_fn(|_| String::new()),
            };
            let [a, b, c, d] = &found;
            rows.push(row([
                &predicts,
                &interval,
                &number(diffusivity),
                &format!("{growth:.3e}"),
                a,
                b,
                c,
                d,
            ]));
        }
    }
    write(
        "intervals.csv",
        "prediction,interval,D_n,energy left,T 0.05,T 0.1,T 0.2,T 0.4",
        &rows,
    );
}
