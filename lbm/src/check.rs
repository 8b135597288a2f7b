//! Is a description possible at all?

use crate::{Bed, Ends, Error, Field, Model, Side, State};

pub(crate) fn refuse<T>(what: String) -> Result<T, Error> {
    Err(Error::Invalid(what))
}

/// Above zero, and a number.
fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

/// Refuse what cannot be right whatever the numbers of the lattice.
pub(crate) fn check(model: &Model) -> Result<(), Error> {
    let count: usize = model.cells.iter().product();
    if count == 0 || count > (u32::MAX / 2) as usize {
        return refuse(format!(
            "{:?} cells: from one to {} of them are possible",
            model.cells,
            u32::MAX / 2
        ));
    }
    let fluid = model.fluid;
    let numbers = [
        ("spacing", model.spacing, "m"),
        ("density", fluid.density, "kg/m³"),
        ("viscosity", fluid.viscosity, "Pa s"),
        ("compressibility", fluid.compressibility, "1/Pa"),
        ("step", model.step.unwrap_or(1.0), "s"),
    ];
    for (name, value, unit) in numbers {
        if !positive(value) {
            return refuse(format!("{name} {value} {unit} must be positive"));
        }
    }
    if !(model.speed >= 0.0 && model.speed.is_finite()) {
        return refuse(format!("speed {} m/s must not be negative", model.speed));
    }
    if !model.acceleration.iter().all(|a| a.is_finite()) {
        return refuse(format!(
            "acceleration {:?} m/s² must be finite",
            model.acceleration
        ));
    }
    if !(model.solid.is_empty() || model.solid.len() == count) {
        return refuse(format!(
            "{} marks of solid cells for {count} cells",
            model.solid.len()
        ));
    }
    if model.solid.iter().all(|&solid| solid) && !model.solid.is_empty() {
        return refuse("all cells are solid".into());
    }
    if let Some(bed) = &model.bed {
        field("porosity", "", &bed.porosity, count, |x| {
            x > 0.0 && x <= 1.0
        })?;
        field("permeability", " m²", &bed.permeability, count, |x| {
            x > 0.0
        })?;
        if let Some(b) = &bed.forchheimer {
            let natural = |x: f64| x >= 0.0 && x.is_finite();
            field("Forchheimer's coefficient", " 1/m", b, count, natural)?;
        }
    }
    let fluxes = model.ends.iter().filter(|ends| match ends {
        Ends::Walls(lower, upper) => [lower, upper].iter().any(|s| matches!(s, Side::Flux(_))),
        Ends::Periodic => false,
    });
    if fluxes.count() > 1 {
        return refuse(
            "fluxes are prescribed through sides that meet at an edge: that is possible only at \
             the ends of one axis; give pressures on the others"
                .into(),
        );
    }
    for (ends, name) in model.ends.iter().zip(["x", "y", "z"]) {
        if let Ends::Walls(lower, upper) = ends {
            side(&format!("lower {name} side"), name, lower)?;
            side(&format!("upper {name} side"), name, upper)?;
        }
    }
    Ok(())
}

fn field(
    name: &str,
    unit: &str,
    field: &Field,
    count: usize,
    fine: impl Fn(f64) -> bool,
) -> Result<(), Error> {
    if let Field::Cells(values) = field
        && values.len() != count
    {
        return refuse(format!("{name}: {} values for {count} cells", values.len()));
    }
    match (0..count).find(|&cell| !fine(field.at(cell))) {
        Some(cell) => refuse(format!(
            "{name} of cell {cell} is {}{unit}: it must be {}",
            field.at(cell),
            match name {
                "porosity" => "above 0 and at most 1",
                "permeability" => "above 0 (infinite for free water)",
                _ => "a number, and not negative",
            }
        )),
        None => Ok(()),
    }
}

fn side(name: &str, axis: &str, side: &Side) -> Result<(), Error> {
    let fault = match side {
        Side::FreeSlip => None,
        Side::NoSlip(velocity) => {
            let normal = velocity[["x", "y", "z"].iter().position(|a| *a == axis).unwrap_or(0)];
            let finite = velocity.iter().all(|v| v.is_finite());
            match finite && normal == 0.0 {
                true => None,
                false => Some("its velocity must be finite and along itself"),
            }
        }
        Side::Pressure(signal) | Side::Flux(signal) => signal.fault(),
    };
    match fault {
        Some(fault) => refuse(format!("{name}: {fault}")),
        None => Ok(()),
    }
}

/// Refuse a state that does not belong to the model.
pub(crate) fn check_state(model: &Model, state: &State) -> Result<(), Error> {
    let count: usize = model.cells.iter().product();
    let lengths = [
        ("pressure", state.pressure.len()),
        ("flux", state.flux.len()),
    ];
    for (name, length) in lengths {
        if length != count {
            return refuse(format!("{name}: {length} values for {count} cells"));
        }
    }
    if !(state.populations.is_empty() || state.populations.len() == count) {
        return refuse(format!(
            "populations of {} cells for {count} cells",
            state.populations.len()
        ));
    }
    let finite = state.pressure.iter().all(|p| p.is_finite())
        && state.flux.as_flattened().iter().all(|q| q.is_finite())
        && state
            .populations
            .as_flattened()
            .iter()
            .all(|f| f.is_finite())
        && state.time.is_finite();
    if !finite {
        return refuse("time, pressure, flux and populations must be finite numbers".into());
    }
    check_thickness(model, state.thickness)
}

/// Refuse a height [m] of the cells that is none, or of which the law knows nothing.
pub(crate) fn check_thickness(model: &Model, thickness: f64) -> Result<(), Error> {
    if !positive(thickness) {
        return refuse(format!(
            "thickness {thickness} m of the cells must be positive"
        ));
    }
    let darcy = |bed: &Bed| bed.forchheimer.is_none();
    if thickness != model.spacing && (model.inertia || !model.bed.as_ref().is_some_and(darcy)) {
        return refuse(format!(
            "cells of {} m by {thickness} m in height are no cubes: that is possible only in a \
             bed with Darcy's drag alone, since viscous stress and squares of the flux know no \
             direction",
            model.spacing
        ));
    }
    Ok(())
}

/// Refuse sources [1/s] that are not one for each cell of a bed, or no numbers.
pub(crate) fn check_source(model: &Model, source: &[f64]) -> Result<(), Error> {
    if model.bed.is_none() {
        return refuse("free water takes no sources: describe a bed of porosity 1".into());
    }
    let count: usize = model.cells.iter().product();
    if source.len() != count || !source.iter().all(|rate| rate.is_finite()) {
        return refuse(format!(
            "{} sources for {count} cells: there must be a finite one for each",
            source.len()
        ));
    }
    Ok(())
}

/// Refuse a bed that has other parts than that of the model.
pub(crate) fn check_other_bed(model: &Model, bed: &Bed) -> Result<(), Error> {
    let same = |old: &Bed| old.forchheimer.is_some() == bed.forchheimer.is_some();
    match model.bed.as_ref().is_some_and(same) {
        true => Ok(()),
        false => refuse("a bed, or its Forchheimer's drag, cannot come or go".into()),
    }
}
