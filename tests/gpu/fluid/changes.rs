//! What changes while running: height of the cells, bed, sources, and who computes.

use super::scenes::{free, no_slip, porous, pressures, rough, scatter};
use crate::lab::Suite;
use lbm::gpu::Solver;
use lbm::{Bed, Ends, Error, Field, Model, Side, Signal, State};
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("sources_bring_their_content_on_the_gpu", sources);
    suite.gpu("stretching_keeps_the_content_on_the_gpu", stretching);
    suite.gpu("a_changed_bed_acts_as_on_the_cpu", other_bed);
    suite.gpu("a_state_goes_from_one_machine_to_the_other", handed_over);
}

/// A closed bed with a solid cell in it.
fn closed() -> Model {
    let mut model = porous([6, 5, 7]);
    model.ends[2] = Ends::Walls(Side::FreeSlip, Side::NoSlip([0.0; 3]));
    model.solid = vec![false; 210];
    model.solid[100] = true;
    model
}

/// What sources brought is there afterwards, with drag and storage that jump; they end when
/// there are none any more.
fn sources(device: &Device) {
    let model = closed();
    let source: Vec<f64> = scatter(210).iter().map(|x| 1e-6 * (x - 0.3)).collect();
    let mut solver = Solver::new(device, model.clone(), State::at_rest(&model)).unwrap();
    solver.advance_with(1000, &source).unwrap();
    let rate: f64 = (0..210).filter(|&k| k != 100).map(|k| source[k]).sum();
    let brought = rate * model.spacing.powi(3) * solver.time();
    let content = solver.snapshot().unwrap().content;
    let error = content / brought - 1.0;
    println!("content: {error:.1e}");
    assert!(error.abs() < 1e-6, "{error:e}");
    solver.advance(500).unwrap();
    let later = solver.snapshot().unwrap().content;
    assert!((later / content - 1.0).abs() < 1e-6);
    solver.advance_with(500, &source).unwrap();
    let more = solver.snapshot().unwrap().content;
    assert!((more / content - 1.5).abs() < 1e-6);

    let mut refused = |source: &[f64]| match solver.advance_with(1, source) {
        Err(Error::Invalid(what)) => what,
        other => panic!("{other:?}"),
    };
    assert!(refused(&[0.0; 3]).contains("210 cells"));
    assert!(refused(&[f64::NAN; 210]).contains("finite"));
    let model = free([4, 4, 4]);
    let mut water = Solver::new(device, model.clone(), State::at_rest(&model)).unwrap();
    assert!(water.advance_with(1, &[0.0; 64]).is_err());
}

/// Cells change their height while water diffuses between them, and what they hold together
/// does not; pressures are those of the CPU.
fn stretching(device: &Device) {
    let model = closed();
    let state = rough(&model, 1e3, 0.0);
    let mut cpu = lbm::Solver::<f32>::new(model.clone(), state.clone(), 1).unwrap();
    let mut gpu = Solver::new(device, model.clone(), state).unwrap();
    let before = gpu.snapshot().unwrap().content;
    for k in 1..=20 {
        let thickness = model.spacing * (1.0 + 5e-3 * f64::from(k));
        cpu.set_thickness(thickness).unwrap();
        gpu.set_thickness(thickness).unwrap();
        cpu.advance(19).unwrap();
        gpu.advance(19).unwrap();
    }
    let (ours, theirs) = (gpu.snapshot().unwrap(), cpu.snapshot());
    assert!((ours.content / before - 1.0).abs() < 1e-6);
    assert_eq!(ours.thickness, theirs.thickness);
    close(&ours.pressure, &theirs.pressure, 1e3);
    assert!(gpu.set_thickness(-1.0).is_err());
    assert!(gpu.set_thickness(1e-3 * model.spacing).is_err());

    // A side whose flux and velocity count per cell face: what was emitted before a change is
    // answered in the units of before.
    let mut model = porous([4, 3, 6]);
    model.ends[2] = Ends::Walls(
        Side::Flux(Signal::Steady(1e-6)),
        Side::Pressure(Signal::Steady(0.0)),
    );
    model.ends[0] = Ends::Walls(Side::NoSlip([0.0, 2e-6, 1e-6]), Side::FreeSlip);
    let state = State::at_rest(&model);
    let mut cpu = lbm::Solver::<f32>::new(model.clone(), state.clone(), 1).unwrap();
    let mut gpu = Solver::new(device, model.clone(), state).unwrap();
    for k in 0..6 {
        let thickness = model.spacing * if k % 2 == 0 { 1.5 } else { 1.0 };
        cpu.set_thickness(thickness).unwrap();
        gpu.set_thickness(thickness).unwrap();
        cpu.advance(1).unwrap();
        gpu.advance(1).unwrap();
    }
    let (ours, theirs) = (gpu.snapshot().unwrap(), cpu.snapshot());
    let scale = theirs.pressure.iter().fold(0.0, |a: f64, p| a.max(p.abs()));
    close(&ours.pressure, &theirs.pressure, scale);
}

/// Within some roundings of `scale`.
fn close(a: &[f64], b: &[f64], scale: f64) {
    for (cell, (a, b)) in a.iter().zip(b).enumerate() {
        let off = (a - b).abs() / scale;
        assert!(off < 3e-6, "cell {cell}: {a} and {b}, {off:.1e} of {scale}");
    }
}

/// Another porosity and permeability: content stays, and the run goes on as on the CPU.
fn other_bed(device: &Device) {
    let model = closed();
    let state = rough(&model, 1e3, 0.0);
    let mut cpu = lbm::Solver::<f32>::new(model.clone(), state.clone(), 1).unwrap();
    let mut gpu = Solver::new(device, model.clone(), state).unwrap();
    cpu.advance(21).unwrap();
    gpu.advance(21).unwrap();
    let content = gpu.snapshot().unwrap().content;
    let random = scatter(420);
    let bed = Bed {
        porosity: Field::Cells(random[..210].iter().map(|x| 0.32 + 0.18 * x).collect()),
        permeability: Field::Cells(random[210..].iter().map(|x| 1.1e-13 * (1.0 + x)).collect()),
        forchheimer: None,
    };
    cpu.set_bed(bed.clone()).unwrap();
    gpu.set_bed(bed.clone()).unwrap();
    assert_eq!(gpu.model(), cpu.model());
    assert_eq!(gpu.scaling(), cpu.scaling());
    assert_eq!(gpu.snapshot().unwrap().content, content);
    close(
        &gpu.snapshot().unwrap().pressure,
        &cpu.snapshot().pressure,
        1e3,
    );
    cpu.advance(40).unwrap();
    gpu.advance(40).unwrap();
    let now = gpu.snapshot().unwrap();
    assert!((now.content / content - 1.0).abs() < 1e-6);
    close(&now.pressure, &cpu.snapshot().pressure, 1e3);

    // What is refused changes nothing.
    let wrong = Bed {
        porosity: Field::Uniform(1.5),
        ..bed.clone()
    };
    assert!(gpu.set_bed(wrong).is_err());
    let other_law = Bed {
        forchheimer: Some(Field::Uniform(1.0)),
        ..bed
    };
    assert!(gpu.set_bed(other_law).is_err());
    assert_eq!(gpu.model(), cpu.model());
    assert_eq!(gpu.snapshot().unwrap(), now);
}

/// A state of the CPU goes on on the GPU, and back: both take the very numbers over.
fn handed_over(device: &Device) {
    let mut bed = closed();
    bed.ends[0] = pressures(10.0, -20.0);
    let mut water = free([9, 5, 6]);
    water.ends[2] = no_slip();
    water.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([1e-2, 0.0, 0.0]));
    water.inertia = true;
    for (model, state) in [
        (&bed, rough(&bed, 1e3, 1e-7)),
        (&water, rough(&water, 1e-3, 1e-2)),
    ] {
        let fluid = |state: &State| -> Vec<[f64; 19]> {
            let cells = state.populations.iter().enumerate();
            let fluid = cells.filter(|(cell, _)| model.solid.get(*cell) != Some(&true));
            fluid.map(|(_, populations)| *populations).collect()
        };
        let mut cpu = lbm::Solver::<f32>::new(model.clone(), state, 1).unwrap();
        cpu.advance(33).unwrap();
        let saved = cpu.state();
        let mut gpu = Solver::new(device, model.clone(), saved.clone()).unwrap();
        assert!(fluid(&gpu.state().unwrap()) == fluid(&saved));
        assert_eq!(gpu.time(), cpu.time());
        gpu.advance(27).unwrap();
        let saved = gpu.state().unwrap();
        let mut back = lbm::Solver::<f32>::new(model.clone(), saved.clone(), 1).unwrap();
        assert!(fluid(&back.state()) == fluid(&saved));
        let (ours, theirs) = (gpu.snapshot().unwrap(), back.snapshot());
        // One state, read by two: whole numbers of roundings apart, but for the content.
        assert!((ours.content / theirs.content - 1.0).abs() < 1e-12);
        let scale = theirs.pressure.iter().fold(0.0, |a: f64, p| a.max(p.abs()));
        close(&ours.pressure, &theirs.pressure, scale);
        let (ours, theirs) = (ours.flux.as_flattened(), theirs.flux.as_flattened());
        let scale = theirs.iter().fold(0.0, |a: f64, q| a.max(q.abs()));
        close(ours, theirs, scale);
        back.advance(20).unwrap();
        cpu.advance(47).unwrap();
        let (now, never) = (back.snapshot(), cpu.snapshot());
        let scale = never.pressure.iter().fold(0.0, |a: f64, p| a.max(p.abs()));
        close(&now.pressure, &never.pressure, scale);
    }
}
