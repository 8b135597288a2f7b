//! Free water: what the Navier-Stokes equations ask for in closed form.

use crate::common::{free, no_slip, orders, relative_error};
use lbm::{Ends, Model, Regime, Side, Solver, State};
use std::f64::consts::PI;

/// Flow between plates driven by a body force: u = g y (H - y) / 2ν, from wall to wall.
fn poiseuille(n: usize, step: f64) -> (Model, Vec<f64>) {
    let (viscosity, acceleration) = (0.1, 1e-6);
    let model = Model {
        ends: [Ends::Periodic, Ends::Periodic, no_slip()],
        acceleration: [acceleration, 0.0, 0.0],
        step: Some(step),
        ..free([1, 1, n], viscosity)
    };
    let height = n as f64;
    let u = |k: usize| {
        let y = k as f64 + 0.5;
        acceleration / (2.0 * viscosity) * y * (height - y)
    };
    (model, (0..n).map(u).collect())
}

/// With the magic parameter 3/16 the walls are exactly half-way and the parabola is exact,
/// whatever the relaxation time; in free water, and through a bed that is all pore.
/// Source: Ginzburg and d'Humières (2003), Phys. Rev. E 68, 066614.
#[test]
fn poiseuille_flow_is_exact_at_any_relaxation_time() {
    let free = [0.5, 2.0, 8.0].map(|step| (step, None));
    let bed = [0.5, 2.0, 8.0].map(|step| (step, Some(crate::layers::open())));
    for (step, bed) in free.into_iter().chain(bed) {
        let (mut model, exact) = poiseuille(8, step);
        model.regime = Some(Regime::Incompressible);
        model.bed = bed;
        let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
        // Start-up decays as exp(-π² ν t / H²): by e^-60.
        solver
            .advance((60.0 * 64.0 / (PI * PI * 0.1) / step) as u64)
            .unwrap();
        let flux = solver.snapshot().flux;
        let error = relative_error(flux.iter().map(|u| u[0]), &exact);
        assert!(error < 1e-11, "step {step} s, {:?}: {error:e}", model.bed);
    }
}

/// A wall that moves along itself drags a linear profile; round-off in either precision.
#[test]
fn couette_flow_is_exact() {
    fn error<T: lbm::Real>() -> f64 {
        let speed = 1e-3;
        let model = Model {
            ends: [
                Ends::Periodic,
                Ends::Periodic,
                Ends::Walls(
                    Side::NoSlip([0.0; 3]),
                    Side::NoSlip([speed, 0.5 * speed, 0.0]),
                ),
            ],
            speed,
            ..free([3, 1, 10], 0.1)
        };
        let mut solver = Solver::<T>::new(model.clone(), State::at_rest(&model), 1).unwrap();
        solver.advance(4000).unwrap();
        let exact: Vec<f64> = (0..10)
            .flat_map(|k| [speed * (k as f64 + 0.5) / 10.0; 3])
            .collect();
        let flux = solver.snapshot().flux;
        let y = relative_error(flux.iter().map(|u| 2.0 * u[1]), &exact);
        relative_error(flux.iter().map(|u| u[0]), &exact).max(y)
    }
    let (double, single) = (error::<f64>(), error::<f32>());
    assert!(double < 1e-12, "f64: {double:e}");
    assert!(single < 1e-5, "f32: {single:e}");
}

/// Decaying vortices, u = U cos kx sin ky e^(-2νk²t), on `n` cells a period, carried along by a
/// flow across the lattice [m/s]: relative error of velocity, and of viscosity.
/// Source: Taylor and Green (1937), Proc. R. Soc. A 158, 499.
pub fn vortices(n: usize, carried: [f64; 2]) -> [f64; 2] {
    let (nu, speed, length) = (0.01, 0.1, 1.0);
    let spacing = length / n as f64;
    let step = 0.2 * spacing * spacing / nu / 3.0;
    let model = Model {
        spacing,
        inertia: true,
        speed,
        step: Some(step),
        ..free([n, n, 1], nu)
    };
    let k = 2.0 * PI / length;
    let field = |t: f64| -> Vec<[f64; 3]> {
        let u = speed * (-2.0 * nu * k * k * t).exp();
        let cell = |i: usize| {
            let (x, y) = ((i % n) as f64 + 0.5, (i / n) as f64 + 0.5);
            let x = k * (x * spacing - carried[0] * t);
            let y = k * (y * spacing - carried[1] * t);
            [
                carried[0] + u * x.cos() * y.sin(),
                carried[1] - u * x.sin() * y.cos(),
                0.0,
            ]
        };
        (0..n * n).map(cell).collect()
    };
    let pressure = (0..n * n).map(|i| {
        let (x, y) = ((i % n) as f64 + 0.5, (i / n) as f64 + 0.5);
        let (x, y) = (2.0 * k * x * spacing, 2.0 * k * y * spacing);
        -0.25 * speed * speed * (x.cos() + y.cos())
    });
    let state = State {
        pressure: pressure.collect(),
        flux: field(0.0),
        ..State::at_rest(&model)
    };
    let mut solver = Solver::<f64>::new(model, state, 1).unwrap();
    let energy = |s: &Solver<f64>| -> f64 {
        s.snapshot()
            .flux
            .iter()
            .map(|u| (u[0] - carried[0]).powi(2) + (u[1] - carried[1]).powi(2))
            .sum()
    };
    // The decay of the vortices over the second half, after the start has settled.
    let steps = (0.5 / (2.0 * nu * k * k) / step).round() as u64;
    solver.advance(steps / 2).unwrap();
    let (t0, e0) = (solver.time(), energy(&solver));
    solver.advance(steps - steps / 2).unwrap();
    let rate = (e0 / energy(&solver)).ln() / (solver.time() - t0);
    let vortices = |u: &[f64; 3]| u[0] - carried[0];
    let exact: Vec<f64> = field(solver.time()).iter().map(vortices).collect();
    let flux = solver.snapshot().flux;
    [
        relative_error(flux.iter().map(vortices), &exact),
        rate / (4.0 * nu * k * k) - 1.0,
    ]
}

/// Velocity converges with second order when the step falls with the square of the spacing, and
/// viscosity is right to 0.2 %; at rest and carried along, which needs the squares of the velocity.
#[test]
fn taylor_green_vortices_decay_with_second_order() {
    for carried in [[0.0; 2], [0.1, 0.05]] {
        let runs = [16, 32, 64].map(|n| vortices(n, carried));
        let orders = orders(&runs.map(|[velocity, _]| velocity));
        assert!(
            orders.iter().all(|&o| o > 1.9),
            "{carried:?}: {orders:?}: {runs:?}"
        );
        assert!(runs[2][1].abs() < 2e-3, "{carried:?}: viscosity: {runs:?}");
    }
}

/// A lid that drives a square cavity, Re 100: the extremes along its middle lines to 1 %, and no
/// net flow across the middle.
/// Source: Marchi, Suero and Araki (2009), J. Braz. Soc. Mech. Sci. Eng. 31, 186.
#[test]
fn a_lid_drives_a_square() {
    let (n, speed, reynolds) = (48, 0.03, 100.0);
    let model = Model {
        ends: [
            no_slip(),
            Ends::Periodic,
            Ends::Walls(Side::NoSlip([0.0; 3]), Side::NoSlip([speed, 0.0, 0.0])),
        ],
        inertia: true,
        speed,
        step: Some(1.0),
        ..free([n, 1, n], speed * n as f64 / reynolds)
    };
    let mut solver = Solver::<f64>::new(model.clone(), State::at_rest(&model), 1).unwrap();
    solver.advance((20.0 * n as f64 / speed) as u64).unwrap();
    let flux = solver.snapshot().flux;
    // On the middle lines, which lie between two cells.
    let mean = |a: usize, b: usize, axis: usize| (flux[a][axis] + flux[b][axis]) / 2.0 / speed;
    let u: Vec<f64> = (0..n)
        .map(|z| mean(z * n + n / 2 - 1, z * n + n / 2, 0))
        .collect();
    let w = (0..n).map(|x| mean((n / 2 - 1) * n + x, n / 2 * n + x, 2));
    let net = u.iter().sum::<f64>() / n as f64;
    assert!(net.abs() < 1e-6, "net flow {net:e}");
    let u_least = u.into_iter().fold(0.0, f64::min);
    let (w_least, w_most) = w.fold((0.0, 0.0), |(a, b), w| (f64::min(a, w), f64::max(b, w)));
    for (found, exact) in [(u_least, -0.21404), (w_least, -0.25380), (w_most, 0.17957)] {
        assert!(
            (found / exact - 1.0_f64).abs() < 1e-2,
            "{found}, Marchi et al. {exact}"
        );
    }
}

/// Numbers that run away are told, not passed on.
#[test]
fn numbers_that_run_away_are_told() {
    let model = free([4, 4, 4], 0.1);
    let mut state = State::at_rest(&model);
    state.pressure[5] = 1e60;
    let mut solver = Solver::<f32>::new(model, state, 1).unwrap();
    let error = solver.advance(3).unwrap_err();
    assert!(
        matches!(error, lbm::Error::Unstable { step: 3, .. }),
        "{error}"
    );
}
