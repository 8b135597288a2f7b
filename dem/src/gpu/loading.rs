//! The scene in the numbers of the kernels: law, walls, loads, and the units of the sums.

use super::fixed::Grid;
use super::law::Law;
use super::numbers::Numbers;
use super::scene::{Body, MOST_WALLS, Scene, WallScene};
use super::wide::Wide;
use crate::{Drive, Error, Model, State, Surface, Wall, WallMotion};
use bytemuck::Zeroable;

/// Units of the running sums, powers of two: a unit is 2^32 parts, and a sum overflows at
/// 2^30 units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// [N]: a part is about 1e-15 of k_n R, far below the force of a contact that matters. Beds that
    /// are wide have so much larger units as more grains press against a wall: until its force is
    /// taken off the device, each of these may press with k_n R / 16 in every step.
    pub force: f64,
    /// [J]: a part is about 1e-17 of k_n R², far below what a contact loses in a step that
    /// matters; a sum holds 64 k_n R² until it is taken off the device.
    pub energy: f64,
    /// [J] of the work of walls: the unit of energy, larger as that of force is.
    pub work: f64,
}

impl Units {
    pub fn of(model: &Model, mean_radius: f64) -> Self {
        let force = model.law.normal_stiffness() * mean_radius;
        let power = |x: f64, below: f64| (x.log2() - below).round().exp2();
        // Grains, two radii wide, beside each other along a wall.
        let beside = model.domain.area() / (4.0 * mean_radius.powi(2));
        let wide = (beside / 16.0).max(1.0).log2().ceil().exp2();
        let energy = power(force * mean_radius, 24.0);
        Self {
            force: wide * power(force, 18.0),
            energy,
            work: wide * energy,
        }
    }
}

/// The axis that wall `wall` lies across, and the side on which its grains are.
pub(super) fn axis_of(wall: &Wall) -> Result<(usize, i32), Error> {
    let normal = wall.normal.to_array();
    let along = normal.iter().position(|x| x.abs() == 1.0);
    let axis = along.ok_or_else(|| {
        Error::Invalid(format!(
            "wall {}: its normal {} lies along no axis, which the GPU's positions need; use the \
             CPU, or turn gravity instead of the wall",
            wall.name, wall.normal
        ))
    })?;
    Ok((axis, normal[axis] as i32))
}

/// The walls, and the driven layer behind them, at step zero.
pub(super) fn bodies(
    model: &Model,
    state: &State,
    grid: &Grid,
    drive: f64,
) -> Result<Vec<Body>, Error> {
    let mut bodies = Vec::new();
    for (wall, now) in model.walls.iter().zip(&state.walls) {
        let (_, side) = axis_of(wall)?;
        bodies.push(Body {
            offset: grid.coordinate(f64::from(side) * now.offset)?,
            velocity: now.velocity as f32,
            unused: 0,
        });
    }
    bodies.push(Body {
        offset: Wide::default(),
        velocity: drive as f32,
        unused: 0,
    });
    Ok(bodies)
}

/// The uniform of the step kernels.
pub(super) fn scene(model: &Model, state: &State, numbers: &Numbers) -> Result<Scene, Error> {
    let Numbers {
        grid,
        units,
        driven_mass,
        limit,
        ..
    } = *numbers;
    if model.walls.len() > MOST_WALLS {
        let n = model.walls.len();
        return Err(Error::Invalid(format!(
            "{n} walls; the GPU takes {MOST_WALLS}: use the CPU"
        )));
    }
    let step = model.step;
    let (drive_velocity, drive_force) = match model.drive {
        Some(Drive::Velocity(velocity)) => (velocity, 0.0),
        Some(Drive::ShearStress(stress)) => (0.0, stress * model.domain.area()),
        None => (0.0, 0.0),
    };
    let shear_stress = matches!(model.drive, Some(Drive::ShearStress(_))) && driven_mass > 0.0;
    // The rounding of the fastest velocity that counts is below 2^28 parts, and the weight of a
    // step is above 2^16 of them.
    let weight = match model.gravity.length() * step {
        0.0 => f64::INFINITY,
        weight => weight.log2() - 16.0,
    };
    let part = (limit.log2() - 52.0).min(weight).floor().exp2();
    let mut scene = Scene {
        law: Law::of(&model.law)?,
        gravity: model.gravity.as_vec3().to_array(),
        step: step as f32,
        length: grid.length.to_array(),
        unit: grid.unit as f32,
        count: state.grains.len() as u32,
        way: (step / grid.unit) as f32,
        force_scale: (1.0 / units.force) as f32,
        energy_scale: (1.0 / units.energy) as f32,
        drive_velocity: drive_velocity as f32,
        drive_force: drive_force as f32,
        drive_kick: if shear_stress {
            (step / driven_mass) as f32
        } else {
            0.0
        },
        part: part as f32,
        parts: (1.0 / part) as f32,
        work_scale: (1.0 / units.work) as f32,
        unused_a: 0,
        unused_b: 0,
        walls: [WallScene::zeroed(); MOST_WALLS],
    };
    for (wall, row) in model.walls.iter().zip(&mut scene.walls) {
        let (axis, side) = axis_of(wall)?;
        row.axis = axis as u32;
        row.side = side;
        row.full = u32::from(wall.surface == Surface::Full);
        if let WallMotion::Stress(load) = wall.motion {
            row.kick = (step / load.mass) as f32;
            row.damping = load.damping as f32;
            row.push = (load.mean * load.area) as f32;
            row.amplitude = (load.amplitude * load.area) as f32;
            row.turn = turns(load.frequency * step);
            row.start = turns(load.frequency * state.time);
        }
    }
    Ok(scene)
}

/// Turns as parts of 2^-64 turn, whole turns dropped: high word, low word.
fn turns(x: f64) -> [u32; 2] {
    let parts = (x.rem_euclid(1.0) * 2f64.powi(64)) as u64;
    [(parts >> 32) as u32, parts as u32]
}
