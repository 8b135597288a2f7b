//! Free water and bed in one scene, and the drag beyond Darcy's.

use crate::common::{column, free, no_slip, orders, relative_error};
use lbm::{Bed, Ends, Field, Model, Regime, Side, Signal, Solver, State};

/// A bed of porosity one without drag.
pub fn open() -> Bed {
    Bed {
        porosity: Field::Uniform(1.0),
        permeability: Field::Uniform(f64::INFINITY),
        forchheimer: None,
    }
}

/// A bed of porosity one without drag is free water: the same flow along a channel, with the
/// squares of the velocity and without.
#[test]
fn a_bed_that_is_all_pore_is_free_water() {
    for inertia in [false, true] {
        let mut model = free([6, 5, 7], 0.05);
        model.ends[2] = no_slip();
        model.acceleration = [2e-5, 1e-5, 0.0];
        model.inertia = inertia;
        model.speed = 1e-2;
        let n = 6 * 5 * 7;
        let random = crate::common::scatter(3 * n);
        let mut state = State::at_rest(&model);
        for (u, random) in state.flux.iter_mut().zip(random.chunks(3)) {
            *u = [0, 1, 2].map(|axis| 1e-2 * (random[axis] - 0.5));
        }
        let run = |bed: Option<Bed>| {
            let model = Model {
                bed,
                regime: Some(Regime::Incompressible),
                ..model.clone()
            };
            let mut solver = Solver::<f64>::new(model, state.clone(), 1).unwrap();
            solver.advance(60).unwrap();
            solver.snapshot().flux
        };
        let exact = run(None);
        let flux = run(Some(open()));
        let error = relative_error(flux.into_flattened(), exact.as_flattened());
        assert!(error < 1e-12, "inertia {inertia}: {error:e}");
    }
}

/// Flow along a layer of free water over a bed on `n` cells, both driven by the same force: a
/// parabola that goes over into Darcy's flux across √k, with one shear stress at the interface
/// (the condition of Beavers and Joseph with a slip coefficient of one). Relative error.
/// Source: Brinkman (1949), Appl. Sci. Res. A 1, 27; Neale and Nader (1974), Can. J. Chem. Eng.
/// 52, 475.
pub fn free_layer(n: usize) -> f64 {
    let (height, nu, g, reach) = (32.0, 0.1, 1e-6, 3.0_f64);
    let mut model = free([1, 1, n], nu);
    model.spacing = height / n as f64;
    model.step = Some(model.spacing.powi(2));
    model.regime = Some(Regime::Incompressible);
    model.ends[2] = no_slip();
    model.acceleration = [g, 0.0, 0.0];
    let in_bed = |k: usize| k < n / 2;
    model.bed = Some(Bed {
        porosity: Field::Cells((0..n).map(|k| if in_bed(k) { 0.5 } else { 1.0 }).collect()),
        permeability: Field::Cells(
            (0..n)
                .map(|k| {
                    if in_bed(k) {
                        reach * reach
                    } else {
                        f64::INFINITY
                    }
                })
                .collect(),
        ),
        forchheimer: None,
    });
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    solver
        .advance(40_000 * n as u64 / 32 * n as u64 / 32 / 4)
        .unwrap();
    // u = darcy + a e^(y/l) + b e^(-(y+h)/l) below y = 0, -g y²/2ν + s y + u(0) above, with
    // u = 0 at y = -h and h, and u and its slope s continuous at 0.
    let h = height / 2.0;
    let darcy = g * reach * reach / nu;
    let far = (-h / reach).exp();
    // b = -darcy - a far;  u(0) = darcy + a + b far;  s = (a - b far)/l.
    let (u_fixed, u_a) = (darcy - darcy * far, 1.0 - far * far);
    let (s_fixed, s_a) = (darcy * far / reach, (1.0 + far * far) / reach);
    let a = (g * h * h / (2.0 * nu) - s_fixed * h - u_fixed) / (s_a * h + u_a);
    let b = -darcy - a * far;
    let exact: Vec<f64> = (0..n)
        .map(|k| {
            let y = (k as f64 + 0.5) * model.spacing - h;
            match in_bed(k) {
                true => darcy + a * (y / reach).exp() + b * (-(y + h) / reach).exp(),
                false => -g * y * y / (2.0 * nu) + (s_fixed + s_a * a) * y + u_fixed + u_a * a,
            }
        })
        .collect();
    let flux = solver.snapshot().flux;
    relative_error(flux.iter().map(|u| u[0]), &exact)
}

#[test]
fn a_free_layer_drags_water_through_the_top_of_the_bed() {
    let errors = [16, 32, 64].map(free_layer);
    let orders = orders(&errors);
    assert!(orders.iter().all(|&o| o > 1.8), "{orders:?}: {errors:?}");
    assert!(errors[1] < 1e-2, "{errors:?}");
}

/// -dp/dz = μ/k q + ρ b q² in a column between two pressures.
/// Source: Forchheimer (1901), Z. Ver. Dtsch. Ing. 45, 1782.
#[test]
fn fast_flow_obeys_forchheimer() {
    let n = 8;
    let (p, k, b) = (5e4, 1e-9, 1e6);
    let mut model = column(n, 1.0, k);
    model.ends[2] = Ends::Walls(
        Side::Pressure(Signal::Steady(p)),
        Side::Pressure(Signal::Steady(0.0)),
    );
    let Some(bed) = &mut model.bed else {
        unreachable!()
    };
    bed.forchheimer = Some(Field::Uniform(b));
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    solver.advance(30_000).unwrap();
    let (linear, square) = (model.fluid.viscosity / k, model.fluid.density * b);
    let exact = 2.0 * p / (linear + (linear * linear + 4.0 * square * p).sqrt());
    let darcy = p / linear;
    assert!(exact < 0.8 * darcy, "Darcy alone would do");
    for q in solver.snapshot().flux {
        assert!(
            (q[2] / exact - 1.0).abs() < 1e-9,
            "{} m/s, exact {exact} m/s",
            q[2]
        );
    }
}
