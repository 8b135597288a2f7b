//! The numbers of water's `series.nc`.

use crate::scene::water::Water;
use dem::output::{Storage, Variable};
use lbm::{Ends, Regime, Side, Snapshot};

/// A number of the whole box.
#[derive(Debug)]
pub struct Scalar {
    /// How the file describes it.
    pub variable: Variable,
    /// Is it written where a scene says nothing?
    pub chosen: fn(&Water) -> bool,
    /// Its value; NaN where it has no meaning.
    pub read: fn(&Water, &Snapshot) -> f64,
}

const fn scalar(
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    chosen: fn(&Water) -> bool,
    read: fn(&Water, &Snapshot) -> f64,
) -> Scalar {
    let variable = Variable {
        name,
        dims: &[],
        units,
        long_name,
        storage: Storage::Double,
    };
    Scalar {
        variable,
        chosen,
        read,
    }
}

/// All of them.
pub static SCALARS: &[Scalar] = &[
    scalar(
        "flux_x",
        "m s-1",
        "mean flux along x, per area of the box",
        flows::<0>,
        flux::<0>,
    ),
    scalar(
        "flux_y",
        "m s-1",
        "mean flux along y, per area of the box",
        flows::<1>,
        flux::<1>,
    ),
    scalar(
        "flux_z",
        "m s-1",
        "mean flux along z, per area of the box",
        flows::<2>,
        flux::<2>,
    ),
    scalar(
        "pressure_drop_x",
        "Pa",
        "pressure at the left less that at the right side, and what a body force adds",
        driven::<0>,
        drop::<0>,
    ),
    scalar(
        "pressure_drop_y",
        "Pa",
        "pressure at the front less that at the back side, and what a body force adds",
        driven::<1>,
        drop::<1>,
    ),
    scalar(
        "pressure_drop_z",
        "Pa",
        "pressure at the bottom less that at the top, and what a body force adds",
        driven::<2>,
        drop::<2>,
    ),
    scalar(
        "permeability_x",
        "m2",
        "viscosity times mean flux over the drop of pressure per length, along x",
        resisted::<0>,
        permeability::<0>,
    ),
    scalar(
        "permeability_y",
        "m2",
        "viscosity times mean flux over the drop of pressure per length, along y",
        resisted::<1>,
        permeability::<1>,
    ),
    scalar(
        "permeability_z",
        "m2",
        "viscosity times mean flux over the drop of pressure per length, along z",
        resisted::<2>,
        permeability::<2>,
    ),
    scalar(
        "pressure_bottom",
        "Pa",
        "mean pressure of the lowest layer of cells",
        |water| walled(water, 2),
        |water, now| layer(water, now, 2, 0),
    ),
    scalar(
        "pressure_top",
        "Pa",
        "mean pressure of the uppermost layer of cells",
        |water| walled(water, 2),
        |water, now| layer(water, now, 2, water.model.cells[2] - 1),
    ),
    scalar(
        "speed_max",
        "m s-1",
        "greatest speed, or Darcy's flux in a bed",
        |_| true,
        speed_max,
    ),
    scalar(
        "kinetic_energy",
        "J",
        "kinetic energy of free water",
        |water| water.model.bed.is_none(),
        kinetic_energy,
    ),
    scalar(
        "content",
        "m3",
        "volume of water beyond that at zero pressure",
        |water| water.scaling.regime != Regime::Incompressible,
        |_, now| now.content,
    ),
];

fn walled(water: &Water, axis: usize) -> bool {
    matches!(water.model.ends[axis], Ends::Walls(..))
}

/// May water pass both ends of the axis?
fn open(water: &Water, axis: usize) -> bool {
    let passes = |side: &Side| matches!(side, Side::Pressure(_) | Side::Flux(_));
    match &water.model.ends[axis] {
        Ends::Periodic => true,
        Ends::Walls(lower, upper) => passes(lower) && passes(upper),
    }
}

fn flows<const A: usize>(water: &Water) -> bool {
    driven::<A>(water) || water.model.cells[A] > 1
}

/// Does a body force or a difference between its ends drive a flow through the axis?
fn driven<const A: usize>(water: &Water) -> bool {
    let by_sides = walled(water, A) && water.model.cells[A] > 1;
    open(water, A) && (by_sides || water.model.acceleration[A] != 0.0)
}

fn resisted<const A: usize>(water: &Water) -> bool {
    driven::<A>(water) && (water.model.bed.is_some() || !water.model.solid.is_empty())
}

fn flux<const A: usize>(_: &Water, now: &Snapshot) -> f64 {
    now.flux.iter().map(|q| q[A]).sum::<f64>() / now.flux.len() as f64
}

/// What the sides prescribe; where they prescribe no pressure, drawn on from the two layers beside.
fn drop<const A: usize>(water: &Water, now: &Snapshot) -> f64 {
    let length = water.lattice().size()[A];
    let by_force = water.model.fluid.density * water.model.acceleration[A] * length;
    let Ends::Walls(lower, upper) = &water.model.ends[A] else {
        return by_force;
    };
    let last = water.model.cells[A] - 1;
    let at = |side: &Side, nearest, next| match side {
        Side::Pressure(signal) => signal.at(now.time),
        _ if last == 0 => f64::NAN,
        _ => 1.5 * layer(water, now, A, nearest) - 0.5 * layer(water, now, A, next),
    };
    by_force + at(lower, 0, 1) - at(upper, last, last.saturating_sub(1))
}

fn permeability<const A: usize>(water: &Water, now: &Snapshot) -> f64 {
    let gradient = drop::<A>(water, now) / water.lattice().size()[A];
    water.model.fluid.viscosity * flux::<A>(water, now) / gradient
}

/// Mean pressure of the water in one layer of cells across an axis.
fn layer(water: &Water, now: &Snapshot, axis: usize, layer: usize) -> f64 {
    let [nx, ny, _] = water.model.cells;
    let stride = [1, nx, nx * ny][axis];
    let of_layer = now.pressure.iter().enumerate().filter(|(cell, _)| {
        let solid = water.model.solid.get(*cell) == Some(&true);
        !solid && cell / stride % water.model.cells[axis] == layer
    });
    let (sum, count) = of_layer.fold((0.0, 0.0), |(sum, n), (_, p)| (sum + p, n + 1.0));
    sum / count
}

fn speed_max(_: &Water, now: &Snapshot) -> f64 {
    let squares = now
        .flux
        .iter()
        .map(|u| u.iter().map(|u| u * u).sum::<f64>());
    squares.fold(0.0, f64::max).sqrt()
}

fn kinetic_energy(water: &Water, now: &Snapshot) -> f64 {
    let squares: f64 = now.flux.as_flattened().iter().map(|u| u * u).sum();
    0.5 * water.model.fluid.density * squares * water.model.spacing.powi(3)
}
