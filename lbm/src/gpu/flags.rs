//! What a scene compiles in.

use super::bindings::Bindings;
use super::rows::Rows;
use crate::check::refuse;
use crate::grid::Grid;
use crate::kernels::Parts;
use crate::{Error, Model};
use shaders::Flags;

/// Threads of a workgroup.
const THREADS: usize = 64;

/// Cells of a workgroup along x, y and z: along x as far as there are some.
pub(super) fn shape(cells: [usize; 3]) -> [u32; 3] {
    let mut left = THREADS;
    cells.map(|count| {
        let own = count.next_power_of_two().min(left);
        left /= own;
        own as u32
    })
}

/// Workgroups of this shape over all cells.
pub(super) fn groups(cells: [usize; 3]) -> [u32; 3] {
    let shape = shape(cells);
    [0, 1, 2].map(|axis| cells[axis].div_ceil(shape[axis] as usize) as u32)
}

/// Workgroups along an axis at most, everywhere.
const MOST_GROUPS: u32 = 65_535;

/// Refuse a box of more rows than a dispatch has.
pub(super) fn check_groups(model: &Model) -> Result<(), Error> {
    match groups(model.cells)
        .iter()
        .all(|&count| count <= MOST_GROUPS)
    {
        true => Ok(()),
        false => refuse(format!(
            "{:?} cells: the GPU knows {MOST_GROUPS} rows along y and layers along z; turn the box, \
             so that its longest side lies along x, or use the CPU",
            model.cells
        )),
    }
}

/// The flags of shaders/lbm.
pub(super) fn flags(model: &Model, grid: &Grid, bindings: Bindings, rows: &Rows) -> Flags {
    let parts = Parts::of(model);
    let [x, y, z] = shape(grid.cells);
    Flags::new()
        .number("EACH", bindings.each as u32)
        .number("PARTS", bindings.parts as u32)
        .number("GROUP_X", x)
        .number("GROUP_Y", y)
        .number("GROUP_Z", z)
        .set_if("POROUS", parts.porous)
        .set_if("INERTIA", parts.inertia)
        .set_if("FORCE", parts.force)
        .set_if("FORCHHEIMER", parts.forchheimer)
        .set_if("SOLIDS", model.has_solids())
        .set_if("LINKS", !rows.words.is_empty())
        .set_if("SPECIALS", !rows.rows.is_empty())
        .set_if("MIRRORS", rows.mirrors())
}
