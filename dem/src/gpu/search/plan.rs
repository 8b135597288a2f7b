//! What the host tells the stages of the search, and what they lay out themselves.
//!
//! Twin: shaders/dem/search/plan.wgsl.

use bytemuck::{Pod, Zeroable};

/// The plan of the search.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Plan {
    /// Grains.
    pub count: u32,
    /// Most cells.
    pub cell_room: u32,
    /// Most entries of all lists.
    pub entry_room: u32,
    /// Most entries that touch.
    pub touching_room: u32,
    /// Periodic lengths along x and y, 0 where the box is open [units].
    pub lengths: [i32; 2],
    /// Mean diameter, for the width of cells [units].
    pub diameter: i32,
    /// Largest radius, rounded up [units].
    pub largest: i32,
    /// Unit of positions [m].
    pub unit: f32,
    /// Time step [s].
    pub step: f32,
    /// Smallest and largest skin [m].
    pub skins: [f32; 2],
    /// Steps between searches that the skin aims at.
    pub every: f32,
    pub(crate) padding: u32,
}

/// The cells, as the device lays them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Grid {
    /// Lowest corner [units].
    pub origin: [i32; 3],
    /// Gaps up to here are in the lists, rounding included [units].
    pub near: i32,
    /// Width of cells [units].
    pub width: [u32; 3],
    /// Cells in all.
    pub total: u32,
    /// Cells along x, y, z.
    pub cells: [u32; 3],
    pub(crate) padding: u32,
}

/// How an array of rows lies.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct Shape {
    /// Vectors of four words a row.
    pub width: u32,
    /// 2 if even and odd steps have their own half, otherwise 1.
    pub halves: u32,
}
