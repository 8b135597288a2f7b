//! Is a description of the water possible with these grains?

use crate::lattice::Lattice;
use crate::{Error, Model};
use dem::measure::{bottom_wall, top_wall};

/// The indices of the bottom and the top wall, and the lattice.
pub(crate) fn check<const N: usize>(
    model: &Model,
    grains: &dem::Model,
) -> Result<([usize; 2], Lattice), Error> {
    const {
        assert!(N == 3 || N == 5, "a kernel reaches three cells or five");
    }
    let refuse = |what: String| Err(Error::Invalid(what));
    if grains.domain.periodic != [true, true] {
        return refuse("water needs a box that is periodic along x and y".into());
    }
    let (Some(bottom), Some(top)) = (bottom_wall(grains), top_wall(grains)) else {
        return refuse("water stands between a bottom and a top wall: there must be both".into());
    };
    if grains.walls.len() != 2
        || [bottom, top]
            .iter()
            .any(|&k| grains.walls[k].normal.z.abs() < 1.0)
    {
        return refuse("water knows no other walls than a level bottom and a level top".into());
    }
    if grains.gravity.x != 0.0 || grains.gravity.y != 0.0 {
        return refuse(
            "gravity must be along z: pressure is the deviation from hydrostatic".into(),
        );
    }
    let [nx, ny, nz] = model.cells;
    if nx == 0 || ny == 0 || nz < N {
        return refuse(format!(
            "{nx} x {ny} x {nz} cells: there must be at least {N} from wall to wall, which the \
             kernel reaches"
        ));
    }
    let [lx, ly] = grains.domain.size;
    let spacing = lx / nx as f64;
    // Boxes are made of whole units of the positions on a GPU.
    if (ly / ny as f64 / spacing - 1.0).abs() > 1e-6 {
        let fitting = (ly / spacing).round();
        return refuse(format!(
            "cells of {spacing:.4e} m by {:.4e} m are not square: give {fitting} along y, or a \
             box of {:.6e} m",
            ly / ny as f64,
            fitting * spacing
        ));
    }
    if let Some(fault) = model.resistance.fault() {
        return refuse(fault);
    }
    let positive = [
        ("load at which a grain counts half", model.loose),
        ("time over which loads are averaged", model.load_memory),
    ];
    for (name, value) in positive {
        if !(value > 0.0 && value.is_finite()) {
            return refuse(format!("the {name}, {value}, must be positive"));
        }
    }
    if model.renewal == Some(0) || model.interval == Some(0) || model.exchange == Some(0) {
        return refuse(
            "steps between renewals, between exchanges, and between fluid steps, must be at least 1"
                .into(),
        );
    }
    if let Some(stiffness) = model.stiffness
        && !(stiffness > 0.0 && stiffness.is_finite())
    {
        return refuse(format!("stiffness {stiffness} Pa must be positive"));
    }
    let lattice = Lattice {
        cells: model.cells,
        spacing,
        bottom: 0.0,
        height: 0.0,
    };
    Ok(([bottom, top], lattice))
}
