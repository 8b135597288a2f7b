//! The cases of the tests at more and finer resolutions, as the tables of `lbm/studies/`.
//!
//! `bash lbm/studies/run.sh` runs them all, and draws the figure.

use crate::cavity::cavity;
use crate::common::relative_error;
use crate::spheres::{Array, OUTSIDE, ZICK_HOMSY, drag, series};
use crate::{free, layers, numbers, packing, porous, waves};
use std::fmt::Display;
use std::path::Path;

/// Write a table of `lbm/studies/`.
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

/// Errors over the number of cells.
#[test]
#[ignore = "a study: a minute"]
fn study_orders() {
    let mut rows = Vec::new();
    let mut add = |case: &str, n: usize, error: f64| {
        let row = row([&case, &n, &format!("{:.3e}", error.abs())]);
        rows.push((case.to_owned(), n, row));
    };
    for n in [16, 32, 64, 128] {
        for (case, carried) in [("at rest", [0.0; 2]), ("carried", [0.1, 0.05])] {
            let [velocity, viscosity] = free::vortices(n, carried);
            add(&format!("Taylor-Green {case}: velocity"), n, velocity);
            add(&format!("Taylor-Green {case}: viscosity"), n, viscosity);
        }
        add("free layer over a bed: velocity", n, layers::free_layer(n));
        let [speed, damping] = waves::speed_and_damping(n, 1e-7);
        add("wave in gravel: speed", n, speed - 1.0);
        add("wave in gravel: damping", n, damping - 1.0);
    }
    for n in [8, 16, 32, 64] {
        add(
            "Terzaghi D 0.1: pressure",
            n,
            porous::drained::<f64>(n, 0.1),
        );
        add(
            "Terzaghi D 0.01: pressure",
            n,
            porous::drained::<f64>(n, 0.01),
        );
        let [pressure, flux] = porous::manufactured(n);
        add("manufactured: pressure", n, pressure);
        add("manufactured: flux", n, flux);
        add("tide: pressure", 3 * n, waves::tide(3 * n));
    }
    rows.sort();
    let rows: Vec<_> = rows.into_iter().map(|(_, _, row)| row).collect();
    write("orders.csv", "case,cells,relative error", &rows);
}

/// The driven cube.
#[test]
#[ignore = "a study: five minutes"]
fn study_cavity() {
    let rows = [(48, 40.0), (64, 40.0), (96, 60.0)].map(|(n, time)| {
        let found = cavity::<f32>(n, 0.15, time, 2);
        let number = |x: f64| format!("{x:.3e}");
        let [mean, extremes, drift] = [found.mean, found.extremes, found.drift].map(number);
        row([&n, &mean, &extremes, &drift])
    });
    write(
        "cavity.csv",
        "cells,mean deviation,of extremes,drift",
        &rows,
    );
}

/// Drag of arrays of spheres.
#[test]
#[ignore = "a study: five minutes"]
fn study_spheres() {
    let mut rows = Vec::new();
    let mut add = |array, fraction, n, shrink, reference: &dyn Fn(f64) -> f64| {
        let found = drag(array, fraction, n, shrink);
        let reference = reference(found.fraction);
        let [fraction, k, reference] =
            [found.fraction, found.k, reference].map(|x| format!("{x:.4}"));
        rows.push(row([
            &format!("{array:?}"),
            &shrink,
            &n,
            &fraction,
            &k,
            &reference,
        ]));
    };
    for n in [16, 24, 32, 48] {
        for [fraction, k] in ZICK_HOMSY {
            if fraction < 0.05 {
                continue;
            }
            // Where the series is no good, the value as it stands.
            let reference = |c: f64| if fraction < 0.35 { series(c) } else { k };
            add(Array::SimpleCubic, fraction, n, 0.0, &reference);
            if fraction < 0.35 {
                add(Array::SimpleCubic, fraction, n, OUTSIDE, &reference);
            }
        }
        for array in [Array::BodyCentred, Array::FaceCentred] {
            add(array, 0.064, n, 0.0, &|c| array.hasimoto(c));
        }
    }
    write(
        "spheres.csv",
        "array,shrink,cells,solid fraction,K,reference",
        &rows,
    );
}

/// Permeability of the packing.
#[test]
#[ignore = "a study: ten minutes"]
fn study_packing() {
    let mut rows = Vec::new();
    for (n, shrink) in [4, 6, 8, 12]
        .into_iter()
        .flat_map(|n| [(n, 0.0), (n, OUTSIDE)])
    {
        let found = packing::pores(n, shrink);
        let number = |k: f64| format!("{k:.4e}");
        let [k, kozeny, hoef] = [
            found.permeability,
            found.kozeny_carman(),
            found.van_der_hoef(),
        ]
        .map(number);
        let porosity = format!("{:.4}", found.porosity);
        rows.push(row([&shrink, &n, &porosity, &k, &kozeny, &hoef]));
    }
    write(
        "packing.csv",
        "shrink,cells,porosity,permeability,Kozeny-Carman,van der Hoef",
        &rows,
    );
}

/// Single and double precision over the drag.
#[test]
#[ignore = "a study: two minutes"]
fn study_numbers() {
    let mut rows = Vec::new();
    for n in [16, 32] {
        let exact = numbers::at_rest_below(n);
        for sigma in [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4] {
            let double = relative_error(numbers::at_drag::<f64>(n, sigma), &exact);
            let single = relative_error(numbers::at_drag::<f32>(n, sigma), &exact);
            let [double, single] = [double, single].map(|x| format!("{x:.3e}"));
            let least = f64::from(f32::EPSILON) * (n * n) as f64 * 3.0 * sigma;
            rows.push(row([&n, &sigma, &double, &single, &format!("{least:.3e}")]));
        }
    }
    write(
        "numbers.csv",
        "cells,drag,error f64,error f32,least over diffusivity",
        &rows,
    );
}
