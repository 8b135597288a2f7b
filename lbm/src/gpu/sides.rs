//! What the sides of the box give in the steps to come. Twin: shaders/lbm/links.wgsl.

use crate::links;
use crate::step::given;
use crate::{Ends, Model, Scaling, Side};
use bytemuck::{Pod, Zeroable};

/// What the sides give in one step, lattice units.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Given {
    /// Flux or velocity along x, y and z, and pressure, of lower x, upper x, lower y, and so on.
    pub sides: [[f32; 4]; 6],
    /// 1: what arrived was given by the host, answers of the sides included.
    pub fresh: u32,
    /// Nobody's.
    pub unused: [u32; 3],
}

impl Given {
    /// What is given to what passes the sides at `time` [s].
    pub(super) fn at(model: &Model, scaling: &Scaling, stretch: f64, time: f64) -> Self {
        let mut row = Self::default();
        for (k, side) in row.sides.iter_mut().enumerate() {
            let which = (k / 2, k % 2 == 1);
            *side = match given(model, scaling, stretch, which, time) {
                links::Given::Flux(j) => [j[0] as f32, j[1] as f32, j[2] as f32, 0.0],
                links::Given::Pressure(p) => [0.0, 0.0, 0.0, p as f32],
            };
        }
        row
    }

    /// For a lattice that the host has just filled.
    pub(super) fn fresh() -> Self {
        Self {
            fresh: 1,
            ..Self::default()
        }
    }
}

/// The sides of a box, in the order of [`Given`].
pub(super) fn sides(model: &Model) -> [Option<&Side>; 6] {
    [0, 1, 2, 3, 4, 5].map(|k| match &model.ends[k / 2] {
        Ends::Periodic => None,
        Ends::Walls(lower, upper) => Some(if k % 2 == 0 { lower } else { upper }),
    })
}

/// A bit for each side that gives a pressure.
pub(super) fn pressures(model: &Model) -> u32 {
    let each = sides(model).into_iter().enumerate();
    let bits = each.map(|(k, side)| u32::from(matches!(side, Some(Side::Pressure(_)))) << k);
    bits.sum()
}
