//! Lattices that do not fit into one binding, and their memory.

use super::scenes::{free, porous, pressures, rough, scatter};
use crate::lab::Suite;
use lbm::gpu::Solver;
use lbm::gpu::memory::{Memory, moved_by_a_step};
use lbm::{Ends, Error, Field, Model, Side, State};
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("parts_of_the_populations_change_no_bit", parts);
    suite.gpu(
        "a_lattice_larger_than_a_binding_flows_as_on_the_cpu",
        larger,
    );
    suite.long("a_lattice_larger_than_the_largest_binding", largest);
    suite.gpu("memory_of_the_fluid_is_told_beforehand", memory);
    suite.gpu("what_no_binding_holds_is_refused", refused);
}

/// However many bindings the populations are spread over, down to one each.
fn parts(device: &Device) {
    let mut model = free([12, 6, 5]);
    model.inertia = true;
    model.ends[1] = Ends::Walls(Side::FreeSlip, Side::NoSlip([1e-3, 0.0, 0.0]));
    model.ends[2] = pressures(1e-4, 0.0);
    model.solid = scatter(360).iter().map(|&x| x < 0.1).collect();
    let state = rough(&model, 1e-4, 1e-3);
    let one = Memory::of(&model).largest;
    let run = |fit: u64| {
        let model = model.clone();
        let mut solver = Solver::with_largest(device, fit * one, model, state.clone()).unwrap();
        solver.advance(25).unwrap();
        solver.state().unwrap()
    };
    let whole = run(19);
    assert!(whole.flux.as_flattened().iter().any(|&q| q != 0.0));
    // 2, 3, 4, 5, 10 and 19 parts.
    for fit in [18, 9, 6, 5, 2, 1] {
        assert!(run(fit) == whole, "{fit} populations fit");
    }
}

/// What software binds at a time; hardware is asked for no more here.
const SOFTWARE: u64 = 1 << 27;

fn larger(device: &Device) {
    let limits = &device.adapter.limits;
    beyond(device, limits.max_storage_buffer_binding_size.min(SOFTWARE));
}

/// The limit of the device itself.
fn largest(device: &Device) {
    beyond(
        device,
        device.adapter.limits.max_storage_buffer_binding_size,
    );
}

/// A lattice under a moving lid of which no more than `largest` bytes can be bound in one piece.
fn beyond(device: &Device, largest: u64) {
    let least = largest as f64 / (19.0 * 4.0);
    let height = (least / (128.0 * 112.0)) as usize + 1;
    let mut model = free([128, 112, height]);
    model.ends[2] = Ends::Walls(Side::NoSlip([0.0; 3]), Side::NoSlip([1e-2, 0.0, 0.0]));
    assert!(19 * Memory::of(&model).largest > largest);
    let layer = 128 * 112;
    let state = rough(&model, 1e-3, 1e-3);
    let mut cpu = lbm::Solver::<f32>::new(model.clone(), state.clone(), 0).unwrap();
    let mut gpu = Solver::with_largest(device, largest, model.clone(), state).unwrap();
    cpu.advance(5).unwrap();
    gpu.advance(5).unwrap();
    let (ours, theirs) = (gpu.snapshot().unwrap(), cpu.snapshot());
    // A rounding a step or so of the largest of each.
    let close = |a: f64, b: f64, largest: f64| (a - b).abs() < 1e-6 * largest;
    for (cell, (a, b)) in ours.pressure.iter().zip(&theirs.pressure).enumerate() {
        assert!(close(*a, *b, 1e-2), "cell {cell}: {a} and {b} Pa");
    }
    for (cell, (a, b)) in ours.flux.iter().zip(&theirs.flux).enumerate() {
        let all = a.iter().zip(b).all(|(a, b)| close(*a, *b, 1e-2));
        assert!(all, "cell {cell}: {a:?} and {b:?} m/s");
    }
    let below_lid = &ours.flux[ours.flux.len() - layer..];
    let mean = below_lid.iter().map(|u| u[0]).sum::<f64>() / below_lid.len() as f64;
    assert!(mean > 1e-3, "the lid drags at {mean} m/s");
}

fn memory(device: &Device) {
    let n = 9 * 7 * 6;
    let mut bed = porous([9, 7, 6]);
    bed.ends[2] = pressures(1.0, 0.0);
    bed.solid = scatter(n).iter().map(|&x| x < 0.1).collect();
    let mut forchheimer = bed.clone();
    if let Some(bed) = &mut forchheimer.bed {
        bed.forchheimer = Some(Field::Uniform(1.0));
    }
    let mut no_solid = free([40, 9, 8]);
    no_solid.solid = vec![false; 40 * 9 * 8];
    for (model, moved) in [
        (no_solid, 152.0),
        (porous([9, 7, 6]), 160.0),
        (bed.clone(), 164.0),
        (forchheimer, 168.0),
    ] {
        let told = Memory::of(&model);
        let solver = Solver::new(device, model.clone(), State::at_rest(&model)).unwrap();
        // Setting, range, what is wrong, and the words and rows of sides are not worth telling.
        let more = solver.memory() - told.bytes;
        assert!(more < 20_000, "{more} bytes more than told");
        assert_eq!(moved_by_a_step(&model), moved);
    }
    let mut solver = Solver::new(device, bed.clone(), State::at_rest(&bed)).unwrap();
    let before = solver.memory();
    solver.advance_with(1, &vec![0.0; n]).unwrap();
    assert_eq!(solver.memory() - before, Memory::of(&bed).source);
    // 19 populations a cell, and nothing that grows beside.
    let large: Model = free([256, 256, 256]);
    let bytes = Memory::of(&large).bytes as f64 / 256f64.powi(3);
    assert!((76.0..78.0).contains(&bytes), "{bytes} bytes a cell");
}

fn refused(device: &Device) {
    let new = |largest: u64, model: Model| {
        let state = State::at_rest(&model);
        match Solver::with_largest(device, largest, model, state).err() {
            Some(error) => error,
            None => panic!("not refused"),
        }
    };
    let model = free([12, 6, 5]);
    match new(Memory::of(&model).largest - 4, model) {
        Error::Invalid(what) => {
            assert!(
                what.contains("[12, 6, 5]") && what.contains("fewer"),
                "{what}"
            );
        }
        other => panic!("{other:?}"),
    }
    let Error::Invalid(what) = new(u64::MAX, free([64, 1, 70_000])) else {
        panic!("so many layers were accepted");
    };
    assert!(what.contains("along x"), "{what}");
    // More than the device has in one piece, though the lattice was told that it has it.
    let binding = device.adapter.limits.max_storage_buffer_binding_size;
    if binding > 1 << 28 {
        println!("a binding holds {binding} bytes: too much for a test");
        return;
    }
    match new(u64::MAX, free([128, 112, 128])) {
        Error::Device(shaders::Error::Memory(what)) => {
            assert!(what.contains("0.15 GiB") && what.contains("CPU"), "{what}");
        }
        other => panic!("{other:?}"),
    }
}
