//! What a state must be before the first step: motion that constraints allow.

use crate::{Drive, Horizontal, Model, State, WallMotion};
use glam::DVec3;

/// Set the motion of held, driven and rotation-held grains and of walls as `model` has it;
/// returns the velocity of the driven layer [m/s].
pub(crate) fn constrain(model: &Model, state: &mut State) -> f64 {
    let grains = &mut state.grains;
    let is_driven = |k: &usize| grains.constraint[*k].horizontal == Horizontal::Driven;
    let driven: Vec<usize> = (0..grains.len()).filter(is_driven).collect();
    let mass: f64 = driven.iter().map(|&k| grains.mass[k]).sum();
    let momentum: f64 = driven
        .iter()
        .map(|&k| grains.mass[k] * grains.velocity[k].x)
        .sum();
    let drive = match model.drive {
        Some(Drive::Velocity(velocity)) => velocity,
        Some(Drive::ShearStress(_)) if mass > 0.0 => momentum / mass,
        _ => 0.0,
    };
    for k in 0..grains.len() {
        let constraint = grains.constraint[k];
        match constraint.horizontal {
            Horizontal::Free => {}
            Horizontal::Held => grains.velocity[k] *= DVec3::Z,
            Horizontal::Driven => {
                grains.velocity[k] = DVec3::new(drive, 0.0, grains.velocity[k].z);
            }
        }
        if constraint.rotation_held || !model.law.slides() {
            grains.angular_velocity[k] = DVec3::ZERO;
        }
    }
    for (wall, state) in model.walls.iter().zip(&mut state.walls) {
        match wall.motion {
            WallMotion::Held => state.velocity = 0.0,
            WallMotion::Velocity(velocity) => state.velocity = velocity,
            WallMotion::Stress(_) => {}
        }
    }
    drive
}
