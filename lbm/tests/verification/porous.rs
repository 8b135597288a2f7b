//! Water in a bed: drainage, layers, stillness.

use crate::common::{column, orders, relative_error, scatter};
use lbm::{Bed, Ends, Field, Scaling, Side, Signal, Solver, State};
use std::f64::consts::PI;

/// p/p0 at height z/H over the impermeable base and T = D t/H².
/// Source: Terzaghi (1943), Theoretical Soil Mechanics.
pub fn terzaghi(z: f64, t: f64) -> f64 {
    let term = |m: u32| {
        let m = PI * (2.0 * f64::from(m) + 1.0) / 2.0;
        2.0 / m * (m * (1.0 - z)).sin() * (-m * m * t).exp()
    };
    (0..200).map(term).sum()
}

/// Relative error of a draining column at T = 0.2, with `diffusivity` cells² per step, from a
/// pressure of 1e-6 ρc².
pub fn drained<T: lbm::Real>(n: usize, diffusivity: f64) -> f64 {
    let mut model = column(n, 1.0, 1e-13);
    // Along x, where cells are worked on side by side.
    model.cells = [n, 1, 1];
    model.ends.reverse();
    let d = 1e-13 / (model.fluid.viscosity * 0.4 * model.fluid.compressibility);
    let steps = (0.2 * (n * n) as f64 / diffusivity).round();
    model.step = Some(0.2 / d / steps);
    let scaling = Scaling::choose::<T>(&model, model.spacing).unwrap();
    let p0 = 1e-6 * scaling.pressure_unit();
    let state = State {
        pressure: vec![p0; n],
        ..State::at_rest(&model)
    };
    let mut solver = Solver::<T>::new(model, state, 1).unwrap();
    solver.advance(steps as u64).unwrap();
    let exact: Vec<f64> = (0..n)
        .map(|k| p0 * terzaghi((k as f64 + 0.5) / n as f64, 0.2))
        .collect();
    relative_error(solver.snapshot().pressure, &exact)
}

/// Waves of pressure over 16 cells, or as many along two or three axes at once, decay as fast as
/// diffusion has it, to one per cent, whatever the drag.
#[test]
fn short_waves_decay_as_they_should_in_all_directions() {
    let n = 16;
    for diffusivity in [0.1, 0.01, 0.001] {
        for direction in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]] {
            let mut model = column(n, 1.0, 1e-13);
            model.cells = [n; 3];
            model.ends[2] = Ends::Periodic;
            let d = 1e-13 / (model.fluid.viscosity * 0.4 * model.fluid.compressibility);
            model.step = Some(diffusivity * model.spacing.powi(2) / d);
            let wave: Vec<f64> = (0..n.pow(3))
                .map(|i| [i % n, i / n % n, i / n / n].map(|x| x as f64 + 0.5))
                .map(|x| (0..3).map(|axis| direction[axis] * x[axis]).sum::<f64>())
                .map(|phase| (2.0 * PI * phase / n as f64).cos())
                .collect();
            let mut state = State::at_rest(&model);
            state.pressure = wave.iter().map(|w| 1e3 * w).collect();
            let mut solver = Solver::<f64>::new(model, state, 1).unwrap();
            let height = |solver: &Solver<f64>| -> f64 {
                let pressure = solver.snapshot().pressure;
                pressure.iter().zip(&wave).map(|(p, w)| p * w).sum()
            };
            // After the start has settled, over the time in which half of it goes.
            solver.advance((0.1 / diffusivity) as u64 + 20).unwrap();
            let before = height(&solver);
            let square: f64 = direction
                .iter()
                .map(|c| (2.0 * PI * c / n as f64).powi(2))
                .sum();
            let steps = (0.7 / (diffusivity * square)).ceil();
            solver.advance(steps as u64).unwrap();
            let rate = (before / height(&solver)).ln() / steps / diffusivity / square;
            assert!(
                (rate - 1.0).abs() < 1e-2,
                "D {diffusivity}, {direction:?}: {rate}"
            );
        }
    }
}

/// Consolidation in a rigid bed has second order, and its error depends little on the drag.
#[test]
fn a_column_drains_as_terzaghi_says() {
    for diffusivity in [0.1, 0.01] {
        let errors = [8, 16, 32].map(|n| drained::<f64>(n, diffusivity));
        let orders = orders(&errors);
        assert!(
            orders.iter().all(|&o| o > 1.9),
            "D {diffusivity}: {orders:?} {errors:?}"
        );
        assert!(errors[1] < 1e-3, "D {diffusivity}: {errors:?}");
    }
}

/// Pressure that is uniform, 1e-6 ρc², stays so, and nothing flows, however porosity jumps.
#[test]
fn uniform_pressure_over_random_porosity_stays_still() {
    fn run<T: lbm::Real>() -> (f64, f64) {
        let mut model = column(8, 1.0, 1e-13);
        model.cells = [8, 8, 8];
        model.ends[2] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3]));
        let random = scatter(1024);
        model.bed = Some(Bed {
            porosity: Field::Cells(random[..512].iter().map(|x| 0.3 + 0.2 * x).collect()),
            permeability: Field::Cells(
                random[512..]
                    .iter()
                    .map(|x| 1e-14 * 10f64.powf(*x))
                    .collect(),
            ),
            forchheimer: None,
        });
        let scaling = Scaling::choose::<T>(&model, model.spacing).unwrap();
        let pressure = 1e-6 * scaling.pressure_unit();
        let state = State {
            pressure: vec![pressure; 512],
            ..State::at_rest(&model)
        };
        let viscosity = model.fluid.viscosity;
        let mut solver = Solver::<T>::new(model, state, 1).unwrap();
        solver.advance(2000).unwrap();
        let now = solver.snapshot();
        let deviation = now.pressure.iter().map(|p| (p / pressure - 1.0).abs());
        // Against the flux that this pressure over a cell would drive where least flows.
        let unit = 1e-14 / viscosity * pressure / 0.125;
        let flow = now.flux.as_flattened().iter().map(|q| q.abs() / unit);
        (deviation.fold(0.0, f64::max), flow.fold(0.0, f64::max))
    }
    let (pressure, flow) = run::<f64>();
    assert!(
        pressure < 1e-13 && flow < 1e-13,
        "f64: {pressure:e}, {flow:e}"
    );
    let (pressure, flow) = run::<f32>();
    assert!(
        pressure < 1e-6 && flow < 1e-6,
        "f32: {pressure:e}, {flow:e}"
    );
}

/// Through two layers in series the flux is that of the sum of their resistances, whatever the
/// jump in permeability.
#[test]
fn layers_in_series_add_their_resistances() {
    fn error<T: lbm::Real>(ratio: f64) -> f64 {
        let n = 16;
        let mut model = column(n, 1.0, 1e-12);
        let p = 1e3;
        model.ends[2] = Ends::Walls(
            Side::Pressure(Signal::Steady(p)),
            Side::Pressure(Signal::Steady(0.0)),
        );
        let k = [1e-12, 1e-12 / ratio];
        let layers =
            |a: f64, b: f64| Field::Cells((0..n).map(|z| if z < n / 2 { a } else { b }).collect());
        model.bed = Some(Bed {
            porosity: layers(0.3, 0.45),
            permeability: layers(k[0], k[1]),
            forchheimer: None,
        });
        let exact = p / (model.fluid.viscosity * 0.5 * (1.0 / k[0] + 1.0 / k[1]));
        let mut solver = Solver::<T>::new(model.clone(), State::at_rest(&model), 1).unwrap();
        let steps = 30.0 * (n * n) as f64 / 9.0 / solver.scaling().diffusivity[0];
        solver.advance(steps as u64).unwrap();
        let flux = solver.snapshot().flux;
        relative_error(flux.iter().map(|q| q[2]), &vec![exact; n])
    }
    for ratio in [2.0, 20.0] {
        let (double, single) = (error::<f64>(ratio), error::<f32>(ratio));
        assert!(double < 1e-10, "ratio {ratio}, f64: {double:e}");
        // To 1e-4 at a ratio of two. Where only one part of 1 + `ratio` of the pressure falls, its
        // rounding counts that much more.
        assert!(single < 5e-5 * ratio, "ratio {ratio}, f32: {single:e}");
    }
}

/// A bed that dilates steadily under a drained surface draws its pressure down to a parabola,
/// p = -μ s (H² - z²)/2k, with suction μ s H²/2k at its tight base.
/// Source: the steady equation ∇·(k/μ ∇p) = s, integrated twice.
#[test]
fn steady_dilation_sucks_a_parabola() {
    let (n, k, rate) = (16, 1e-13, 1e-7);
    let model = column(n, 1.0, k);
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    let steps = 4.0 * (n * n) as f64 / solver.scaling().diffusivity[0];
    solver.advance_with(steps as u64, &vec![-rate; n]).unwrap();
    let exact: Vec<f64> = (0..n)
        .map(|cell| {
            let z = (cell as f64 + 0.5) / n as f64;
            -model.fluid.viscosity * rate / (2.0 * k) * (1.0 - z * z)
        })
        .collect();
    let error = relative_error(solver.snapshot().pressure, &exact);
    assert!(error < 2e-3, "{error:e}");
}

/// A manufactured solution with porosity that varies in space and time: content φβp obeys
/// ∂(φβp)/∂t = ∇·(k/μ ∇p) + s, with the s that makes p = p0 cos(πz/2H) cos ωt. Relative errors of
/// pressure and flux on `n` cells, with a step that falls with the square of the spacing.
pub fn manufactured(n: usize) -> [f64; 2] {
    let mut model = column(n, 1.0, 1e-13);
    let (mu, beta) = (model.fluid.viscosity, model.fluid.compressibility);
    let (p0, kappa) = (1e3, PI / 2.0);
    let omega = 2.0 * 1e-13 / (mu * 0.4 * beta);
    let height = |cell: usize| (cell as f64 + 0.5) / n as f64;
    let phi = |z: f64, t: f64| 0.4 + 0.1 * (3.0 * z).sin() * (omega * t).sin();
    let phi_rate = |z: f64, t: f64| 0.1 * (3.0 * z).sin() * omega * (omega * t).cos();
    let mobility = |z: f64| 1e-13 / mu * (1.0 + 0.5 * (2.0 * z).cos());
    let mobility_slope = |z: f64| -1e-13 / mu * (2.0 * z).sin();
    let source = |z: f64, t: f64| {
        let (p, slope) = (p0 * (kappa * z).cos(), -p0 * kappa * (kappa * z).sin());
        let stored = phi_rate(z, t) * (omega * t).cos() - phi(z, t) * omega * (omega * t).sin();
        let drained = mobility(z) * kappa * kappa * p - mobility_slope(z) * slope;
        beta * p * stored + drained * (omega * t).cos()
    };
    let cells = |f: &dyn Fn(f64) -> f64| Field::Cells((0..n).map(|c| f(height(c))).collect());
    let bed = |t: f64| Bed {
        porosity: cells(&|z| phi(z, t)),
        permeability: cells(&|z| mobility(z) * mu),
        forchheimer: None,
    };
    model.bed = Some(bed(0.0));
    let steps = 12 * n * n;
    model.step = Some(1.0 / omega / steps as f64);
    let pressure = |t: f64| -> Vec<f64> {
        let p = |c: usize| p0 * (kappa * height(c)).cos() * (omega * t).cos();
        (0..n).map(p).collect()
    };
    let mut state = State::at_rest(&model);
    state.pressure = pressure(0.0);
    let mut solver = Solver::<f64>::new(model, state, 1).unwrap();
    for _ in 0..steps {
        let t = solver.time() + 0.5 * solver.scaling().step;
        let source: Vec<f64> = (0..n).map(|c| source(height(c), t)).collect();
        solver.set_bed(bed(solver.time())).unwrap();
        solver.advance_with(1, &source).unwrap();
    }
    solver.set_bed(bed(solver.time())).unwrap();
    let (now, t) = (solver.snapshot(), solver.time());
    let flux: Vec<f64> = (0..n)
        .map(height)
        .map(|z| mobility(z) * p0 * kappa * (kappa * z).sin() * (omega * t).cos())
        .collect();
    [
        relative_error(now.pressure, &pressure(t)),
        relative_error(now.flux.iter().map(|q| q[2]), &flux),
    ]
}

/// Pressure and flux both converge with second order.
#[test]
fn porosity_may_vary_in_space_and_time() {
    let errors = [8, 16, 32].map(manufactured);
    for which in [0, 1] {
        let orders = orders(&errors.map(|e| e[which]));
        assert!(orders.iter().all(|&o| o > 1.8), "{orders:?}: {errors:?}");
        assert!(errors[2][which] < 1e-3, "{errors:?}");
    }
}
