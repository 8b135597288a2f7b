//! Cell by cell against the CPU in single precision: each law, each side, solids, stretch.
//!
//! Both round alike but for the order of sums and fused multiplications, about ten roundings a
//! step, which a stable lattice carries on without growth: after n steps they may be apart by
//! `ROUNDINGS` n ε of the largest population that there was.

use super::scenes::{free, no_slip, open, porous, pressures, rough, scatter};
use crate::lab::Suite;
use lbm::{Ends, Field, Model, Side, Signal, State, gpu};
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("free_water_flows_as_on_the_cpu", free_water);
    suite.gpu("a_bed_flows_as_on_the_cpu", beds);
    suite.gpu("sides_answer_as_on_the_cpu", sides);
    suite.gpu("narrow_boxes_flow_as_on_the_cpu", narrow);
    suite.gpu("solids_answer_as_on_the_cpu", solids);
}

const ROUNDINGS: f64 = 0.5;

/// The largest difference of the populations of fluid cells, over the largest of them at any
/// time, in roundings.
fn apart(model: &Model, a: &State, b: &State, scale: f64) -> f64 {
    let fluid = |cell: &usize| model.solid.get(*cell) != Some(&true);
    let cells = (0..a.populations.len()).filter(fluid);
    let differences = cells.flat_map(|cell| {
        let pairs = a.populations[cell].iter().zip(&b.populations[cell]);
        pairs.map(|(a, b)| (a - b).abs())
    });
    let largest = differences.fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
    largest / (scale * f64::from(f32::EPSILON))
}

fn scale(state: &State) -> f64 {
    let all = state.populations.as_flattened().iter();
    all.fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// Run both for `STEPS` steps and compare, halfway too.
fn compare(device: &Device, name: &str, model: &Model, state: &State, source: Option<&[f64]>) {
    let mut cpu = lbm::Solver::<f32>::new(model.clone(), state.clone(), 1)
        .unwrap_or_else(|e| panic!("{name}: {e}"));
    let mut gpu = gpu::Solver::new(device, model.clone(), state.clone())
        .unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(cpu.scaling(), gpu.scaling(), "{name}");
    let begin = cpu.state();
    let mut largest = scale(&begin);
    assert_eq!(
        apart(model, &begin, &gpu.state().unwrap(), largest),
        0.0,
        "{name}: at the start"
    );
    for (made, steps) in [(31, 31), (70, 39)] {
        match source {
            None => {
                cpu.advance(steps).unwrap();
                gpu.advance(steps).unwrap();
            }
            Some(source) => {
                cpu.advance_with(steps, source).unwrap();
                gpu.advance_with(steps, source).unwrap();
            }
        }
        let (a, b) = (cpu.state(), gpu.state().unwrap());
        largest = largest.max(scale(&a));
        let roundings = apart(model, &a, &b, largest);
        println!("{name}: {roundings:.2} after {made}");
        assert!(
            roundings < ROUNDINGS * made as f64,
            "{name}: {roundings:.1} roundings after {made} steps"
        );
        let moved = apart(model, &begin, &a, largest);
        assert!(moved > 1e4, "{name}: nothing happened");
        assert_eq!((a.time, a.thickness), (b.time, b.thickness));
    }
}

fn free_water(device: &Device) {
    for (inertia, force) in [(false, false), (true, false), (false, true), (true, true)] {
        let mut model = free([19, 6, 5]);
        model.inertia = inertia;
        if force {
            model.acceleration = [1e-4, -2e-4, 3e-4];
        }
        let state = rough(&model, 1e-3, 1e-2);
        let name = format!("free, inertia {inertia}, force {force}");
        compare(device, &name, &model, &state, None);
    }
}

fn beds(device: &Device) {
    for case in 0..16 {
        let [inertia, force, forchheimer, source] = [1, 2, 4, 8].map(|bit| case & bit != 0);
        let mut model = match inertia || forchheimer {
            true => open([9, 7, 6]),
            false => porous([9, 7, 6]),
        };
        let n = 9 * 7 * 6;
        model.inertia = inertia;
        if force {
            model.acceleration = [0.3, -0.2, -9.8];
        }
        if forchheimer && let Some(bed) = &mut model.bed {
            bed.forchheimer = Some(Field::Cells(scatter(n).iter().map(|x| 1e6 * x).collect()));
        }
        let rate: Vec<f64> = scatter(n).iter().map(|x| 1e-3 * (x - 0.4)).collect();
        let state = match inertia || forchheimer {
            true => rough(&model, 1e4, 1e-2),
            false => rough(&model, 1e3, 1e-7),
        };
        let name = format!(
            "bed, inertia {inertia}, force {force}, Forchheimer {forchheimer}, source {source}"
        );
        compare(device, &name, &model, &state, source.then_some(&rate[..]));
    }
    // Cells that are no cubes.
    for stretch in [0.7, 1.6] {
        let mut model = porous([9, 7, 6]);
        model.ends[2] = pressures(100.0, -50.0);
        model.acceleration = [0.0, 0.0, -9.8];
        let mut state = rough(&model, 1e3, 1e-7);
        state.thickness = stretch * model.spacing;
        compare(device, &format!("stretch {stretch}"), &model, &state, None);
    }
}

/// Every side on each axis, with every other at the other end; where fluxes meet at edges the
/// model is refused, so the other axes have walls in turn.
fn sides(device: &Device) {
    let wave = |mean: f64, amplitude: f64, frequency: f64| Signal::Sinusoidal {
        mean,
        amplitude,
        frequency,
        phase: 0.3,
    };
    for axis in 0..3 {
        let mut along = [0.02, 0.01, -0.03];
        along[axis] = 0.0;
        let kinds = [
            Side::NoSlip([0.0; 3]),
            Side::NoSlip(along),
            Side::FreeSlip,
            Side::Pressure(wave(1e-3, 5e-4, 1e-3)),
            Side::Flux(Signal::Table(vec![[0.0, 0.0], [50.0, 1e-2], [90.0, -1e-3]])),
        ];
        for (k, lower) in kinds.iter().enumerate() {
            let mut model = free([7, 6, 5]);
            model.cells.rotate_right(axis);
            model.inertia = k % 2 == 0;
            // Time in steps of one.
            model.step = Some(1.0);
            let upper = &kinds[(k + 2) % 5];
            model.ends[axis] = Ends::Walls(lower.clone(), upper.clone());
            // A box that is closed along the others in some cases: edges and corners.
            let beside = [
                Ends::Periodic,
                Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3])),
                Ends::Walls(Side::Pressure(Signal::Steady(2e-4)), Side::FreeSlip),
            ];
            model.ends[(axis + 1) % 3] = beside[k % 3].clone();
            model.ends[(axis + 2) % 3] = beside[(k + axis) % 3].clone();
            let state = rough(&model, 1e-3, 1e-2);
            let name = format!("axis {axis}, {lower:?} to {upper:?}");
            compare(device, &name, &model, &state, None);
        }
    }
}

/// Boxes of one or two cells along some axes: periodic, where a cell is its own neighbour, and
/// with walls, where it touches both.
fn narrow(device: &Device) {
    for cells in [[1, 1, 7], [2, 1, 5], [1, 6, 2], [70, 1, 1]] {
        for walls in 0..4 {
            let mut model = free(cells);
            model.inertia = true;
            model.acceleration = [1e-4, 2e-4, -1e-4];
            for axis in 0..3 {
                let mut along = [1e-2; 3];
                along[axis] = 0.0;
                model.ends[axis] = match (walls + axis) % 4 {
                    0 => Ends::Periodic,
                    1 => Ends::Walls(Side::NoSlip(along), Side::NoSlip([0.0; 3])),
                    2 => Ends::Walls(Side::FreeSlip, Side::FreeSlip),
                    _ => pressures(1e-3, -1e-3),
                };
            }
            let state = rough(&model, 1e-3, 1e-2);
            let name = format!("{cells:?}, walls {walls}");
            compare(device, &name, &model, &state, None);
        }
    }
}

fn solids(device: &Device) {
    for porous_bed in [false, true] {
        let cells = [11, 9, 8];
        let mut model = match porous_bed {
            true => porous(cells),
            false => free(cells),
        };
        model.solid = scatter(11 * 9 * 8).iter().map(|&x| x < 0.2).collect();
        model.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3]));
        model.ends[2] = no_slip();
        let state = match porous_bed {
            true => rough(&model, 1e3, 1e-7),
            false => rough(&model, 1e-3, 1e-2),
        };
        let name = format!("solids, bed {porous_bed}");
        compare(device, &name, &model, &state, None);
        // Moving walls and pressures beside solids.
        if !porous_bed {
            model.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.01, 0.0, -0.02]));
        }
        model.ends[2] = Ends::Walls(Side::FreeSlip, Side::Pressure(Signal::Steady(1e-3)));
        compare(device, &format!("{name}, sides"), &model, &state, None);
    }
}
