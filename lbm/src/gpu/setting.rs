//! What the kernels know of a lattice. Twins: shaders/lbm/setting.wgsl and slab.wgsl.

use super::sides::pressures;
use crate::Model;
use crate::collide::Coefficients;
use crate::grid::Grid;
use bytemuck::{Pod, Zeroable};

/// Lattice units.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Setting {
    /// Cells of the box.
    pub cells: [u32; 3],
    /// From one row to the next, places.
    pub stride: u32,
    /// Layers, those in walls included.
    pub extent: [u32; 3],
    /// From one population to the next, places.
    pub step: u32,
    /// 3 where an axis has walls, 0 where it is periodic.
    pub walled: [u32; 3],
    /// A bit for each side that gives a pressure: lower x, upper x, lower y, and so on.
    pub pressures: u32,
    /// Half the body force.
    pub half_force: [f32; 3],
    /// 1/τ⁺
    pub omega_even: f32,
    /// By how much drag is stronger along x, y and along z.
    pub drag_stretch: [f32; 2],
    /// Content of a cube over that of a cell.
    pub flatness: f32,
    /// 1/τ⁻
    pub omega_odd: f32,
    /// Zero, of which a compiler knows nothing.
    pub nothing: u32,
    /// Nobody's.
    pub unused: [u32; 3],
}

impl Setting {
    pub(super) fn new(model: &Model, grid: &Grid, k: &Coefficients<f32>) -> Self {
        // The solver refuses more places than there are u32.
        let words = |sizes: [usize; 3]| sizes.map(|size| size as u32);
        Self {
            cells: words(grid.cells),
            stride: grid.stride as u32,
            extent: words(grid.extent),
            step: grid.places() as u32,
            walled: model.walled().map(|walled| if walled { 3 } else { 0 }),
            pressures: pressures(model),
            half_force: k.half_force,
            omega_even: k.omega_even,
            drag_stretch: k.drag_stretch,
            flatness: k.flatness,
            omega_odd: k.omega_odd,
            nothing: 0,
            unused: [0; 3],
        }
    }
}

/// The cells of a slab.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Range {
    /// The first cell.
    pub first: u32,
    /// Number of cells.
    pub count: u32,
    /// Nobody's.
    pub unused: [u32; 2],
}
