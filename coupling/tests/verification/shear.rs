//! Undrained shear: what dilates dry keeps its volume under water, and hardens.

use crate::bed::*;
use coupling::Coupled;
use dem::{Drive, Horizontal, Solver, State};
use lbm::Side;

/// A bed with its lowest grains held and its highest driven at `speed` [m/s], sheared linearly.
pub fn sheared(mut state: State, speed: f64) -> (dem::Model, State) {
    let top = -state.walls[1].offset;
    let grains = &mut state.grains;
    for k in 0..grains.len() {
        let z = grains.position[k].z;
        let constraint = &mut grains.constraint[k];
        constraint.horizontal = match z {
            z if z < 0.02 => Horizontal::Held,
            z if z > top - 0.02 => Horizontal::Driven,
            _ => Horizontal::Free,
        };
        constraint.rotation_held = constraint.horizontal != Horizontal::Free;
        grains.velocity[k].x = speed * z / top;
    }
    let mut model = model(law(), STRESS);
    model.drive = Some(Drive::Velocity(speed));
    (model, state)
}

#[test]
fn undrained_shear_keeps_the_volume_and_hardens() {
    let (model, state) = sheared(pressed(), 0.17);
    let height = -state.walls[1].offset;
    let steps = 4000;
    let mut dry = Solver::new(model.clone(), state.clone(), 1).unwrap();
    dry.advance(steps).unwrap();
    let mut sealed = water(1e-12);
    sealed.sides = [Side::FreeSlip, Side::FreeSlip];
    let mut wet = Coupled::<3>::new(model, state, sealed, None, 1).unwrap();
    wet.advance(steps).unwrap();

    let (dry, now) = (dry.snapshot(), wet.grains().snapshot());
    let dilation = |state: &State| (-state.walls[1].offset - height) / height;
    println!(
        "dilation {:e} dry, {:e} wet",
        dilation(&dry.state),
        dilation(&now.state)
    );
    assert!(
        dilation(&dry.state) > 1e-3,
        "dry: {:e}",
        dilation(&dry.state)
    );
    assert!(
        dilation(&now.state).abs() < 0.2 * dilation(&dry.state),
        "wet: {:e}",
        dilation(&now.state)
    );
    let cells = wet.water().pressure();
    let mean = cells.iter().sum::<f64>() / cells.len() as f64;
    println!("pressure {mean:.0} Pa");
    assert!(mean < -0.5e5, "{mean} Pa");
    // What the bed has gained is in the tension of the water.
    let gained = AREA * height * dilation(&now.state);
    assert!((wet.ledger().content / -gained - 1.0).abs() < 1e-6);
    let strength = |sums: &dem::Sums| -sums.driven_force / AREA / sums.steps as f64;
    println!(
        "{:.0} Pa dry, {:.0} Pa wet",
        strength(&dry.sums),
        strength(&now.sums)
    );
    assert!(strength(&now.sums) > 1.3 * strength(&dry.sums));
    // The wall is in balance: grains carry what the water's tension adds.
    let carried = now.wall_force[1] / AREA + wet.water().pressure()[3];
    println!("{carried}");
}
