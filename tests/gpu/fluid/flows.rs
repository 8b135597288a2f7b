//! Flows in closed form, in the precision of the device.

use super::scenes::{free, no_slip, porous};
use crate::lab::Suite;
use lbm::gpu::Solver;
use lbm::{Bed, Ends, Field, Model, Side, Signal, State};
use shaders::Device;
use std::f64::consts::PI;

pub fn list(suite: &mut Suite) {
    suite.gpu("poiseuille_flow_is_exact_on_the_gpu", poiseuille);
    suite.gpu("couette_flow_is_exact_on_the_gpu", couette);
    suite.gpu("a_column_drains_on_the_gpu_as_on_the_cpu", column);
    suite.gpu("uniform_pressure_stays_still_on_the_gpu", still);
}

/// √(Σ(a - b)² / Σb²)
fn relative_error(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (off / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// Flow between plates driven by a body force: u = g y (H - y) / 2ν, from wall to wall. (At
/// 1e-5 of u added a step or less, rounding shows: 1.2e-5 at half a second, on the CPU too.)
fn poiseuille(device: &Device) {
    let (n, viscosity, g) = (8, 0.1, 1e-6);
    for step in [2.0, 8.0] {
        let mut model = free([3, 1, n]);
        model.fluid.viscosity = viscosity;
        model.ends[2] = no_slip();
        model.acceleration = [g, 0.0, 0.0];
        model.step = Some(step);
        let mut solver = Solver::new(device, model.clone(), State::at_rest(&model)).unwrap();
        // Start-up decays as exp(-π² ν t / H²): by e^-30.
        let steps = 30.0 * 64.0 / (PI * PI * viscosity) / step;
        solver.advance(steps as u64).unwrap();
        let height = n as f64;
        let exact = (0..3 * n).map(|cell| {
            let y = (cell / 3) as f64 + 0.5;
            g / (2.0 * viscosity) * y * (height - y)
        });
        let flux = solver.snapshot().unwrap().flux;
        let u: Vec<f64> = flux.iter().map(|u| u[0]).collect();
        let error = relative_error(&u, &exact.collect::<Vec<_>>());
        println!("Poiseuille, step {step} s: {error:.1e}");
        assert!(error < 1e-5, "step {step} s: {error:e}");
    }
}

/// A wall that moves along itself drags a linear profile.
fn couette(device: &Device) {
    let speed = 1e-3;
    let mut model = free([3, 1, 10]);
    model.fluid.viscosity = 0.1;
    model.speed = speed;
    let moving = Side::NoSlip([speed, 0.5 * speed, 0.0]);
    model.ends[2] = Ends::Walls(Side::NoSlip([0.0; 3]), moving);
    let mut solver = Solver::new(device, model.clone(), State::at_rest(&model)).unwrap();
    solver.advance(4000).unwrap();
    let exact: Vec<f64> = (0..30)
        .map(|k| speed * ((k / 3) as f64 + 0.5) / 10.0)
        .collect();
    let flux = solver.snapshot().unwrap().flux;
    for (axis, share) in [(0, 1.0), (1, 2.0)] {
        let u: Vec<f64> = flux.iter().map(|u| share * u[axis]).collect();
        let error = relative_error(&u, &exact);
        println!("Couette, axis {axis}: {error:.1e}");
        assert!(error < 1e-5, "axis {axis}: {error:e}");
    }
}

/// p/p0 at height z/H over the impermeable base and T = D t/H².
/// Source: Terzaghi (1943), Theoretical Soil Mechanics.
fn terzaghi(z: f64, t: f64) -> f64 {
    let term = |m: u32| {
        let m = PI * (2.0 * f64::from(m) + 1.0) / 2.0;
        2.0 / m * (m * (1.0 - z)).sin() * (-m * m * t).exp()
    };
    (0..200).map(term).sum()
}

/// Consolidation: right as on the CPU, and the same to what single precision does to a column of
/// L cells at a diffusivity of D cells² a step, 1e-2 ε L²/D (lbm/src/limits.rs), in each.
fn column(device: &Device) {
    let (n, p0) = (32, 1e3);
    let (mut model, d) = uniform([1, 1, n]);
    model.ends[2] = Ends::Walls(Side::FreeSlip, Side::Pressure(Signal::Steady(0.0)));
    for diffusivity in [0.1, 0.01] {
        let steps = (0.2 * (n * n) as f64 / diffusivity).round();
        let height = model.spacing * n as f64;
        model.step = Some(0.2 * height * height / d / steps);
        let mut state = State::at_rest(&model);
        state.pressure = vec![p0; n];
        let mut cpu = lbm::Solver::<f32>::new(model.clone(), state.clone(), 1).unwrap();
        let mut gpu = Solver::new(device, model.clone(), state).unwrap();
        cpu.advance(steps as u64).unwrap();
        gpu.advance(steps as u64).unwrap();
        let z = |k: usize| (k as f64 + 0.5) / n as f64;
        let exact: Vec<f64> = (0..n).map(|k| p0 * terzaghi(z(k), 0.2)).collect();
        let (ours, theirs) = (gpu.snapshot().unwrap().pressure, cpu.snapshot().pressure);
        let errors = [&ours, &theirs].map(|p| relative_error(p, &exact));
        let apart = relative_error(&ours, &theirs);
        let [gpu, cpu] = errors;
        println!("Terzaghi, D {diffusivity}: GPU {gpu:.1e}, CPU {cpu:.1e}, apart {apart:.1e}");
        assert!(gpu < 1e-3, "D {diffusivity}: {gpu:e}");
        let rounding = 1e-2 * f64::from(f32::EPSILON) * (n * n) as f64 / diffusivity;
        assert!(apart < 2.0 * rounding, "D {diffusivity}: apart {apart:e}");
    }
}

/// A uniform bed, and its hydraulic diffusivity [m²/s].
fn uniform(cells: [usize; 3]) -> (Model, f64) {
    let mut model = porous(cells);
    let (porosity, permeability) = (0.4, 1e-13);
    model.bed = Some(Bed {
        porosity: Field::Uniform(porosity),
        permeability: Field::Uniform(permeability),
        forchheimer: None,
    });
    let fluid = model.fluid;
    let d = permeability / (fluid.viscosity * porosity * fluid.compressibility);
    (model, d)
}

/// Pressure that is uniform over random porosity and permeability stays so, and nothing flows.
fn still(device: &Device) {
    let mut model = porous([8, 8, 8]);
    model.ends[2] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3]));
    let mut state = State::at_rest(&model);
    state.pressure.fill(1e3);
    let mut solver = Solver::new(device, model.clone(), state).unwrap();
    solver.advance(2000).unwrap();
    let now = solver.snapshot().unwrap();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let pressure = largest(&mut now.pressure.iter().map(|p| (p / 1e3 - 1.0).abs()));
    // Against the flux that 1 kPa over a cell would drive through the mean permeability.
    let unit = 1.5e-13 / model.fluid.viscosity * 1e3 / model.spacing;
    let flux = largest(&mut now.flux.as_flattened().iter().map(|q| q.abs() / unit));
    println!("stillness: pressure {pressure:.1e}, flux {flux:.1e}");
    assert!(pressure < 1e-6, "pressure off by {pressure:e}");
    assert!(flux < 1e-6, "flux of {flux:e}");
}
