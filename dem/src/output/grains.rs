//! Grain arrays of `grains.nc`.

use super::{Field, Storage, field, scalars, vectors};
use crate::measure;
use ndarray::Array2;

/// Grain arrays: dimension `grain`, in the order of identities; vectors also `component`,
/// orientations `quaternion` (x, y, z, w).
pub static GRAINS: &[Field] = &[
    // Double: single precision would hide overlaps, 1e-8 m in a box of half a metre.
    field(
        "position",
        &["grain", "component"],
        "m",
        "position of the grain, inside the box along periodic sides",
        Storage::Double,
        |r| vectors(&r.now.state.grains.position),
    ),
    field(
        "displacement",
        &["grain", "component"],
        "m",
        "way travelled since the bed was made, not wrapped at periodic sides",
        Storage::Single,
        |r| vectors(&r.now.state.grains.displacement),
    ),
    field(
        "velocity",
        &["grain", "component"],
        "m s-1",
        "velocity of the grain",
        Storage::Single,
        |r| vectors(&r.now.state.grains.velocity),
    ),
    field(
        "angular_velocity",
        &["grain", "component"],
        "rad s-1",
        "angular velocity of the grain",
        Storage::Single,
        |r| vectors(&r.now.state.grains.angular_velocity),
    ),
    field(
        "orientation",
        &["grain", "quaternion"],
        "1",
        "orientation of the grain since the bed was made, unit quaternion",
        Storage::Single,
        |r| {
            let turned = &r.now.state.grains.orientation;
            let part = |(k, c): (usize, usize)| turned[k].to_array()[c];
            Array2::from_shape_fn((turned.len(), 4), part).into_dyn()
        },
    ),
    field(
        "force",
        &["grain", "component"],
        "N",
        "net force on the grain",
        Storage::Single,
        |r| vectors(&r.now.force),
    ),
    field(
        "pressure",
        &["grain"],
        "Pa",
        "pressure on the grain, sum of normal forces over its surface",
        Storage::Single,
        |r| scalars(measure::pressure(&r.now.state)),
    ),
    field(
        "coordination_number",
        &["grain"],
        "1",
        "number of grains that the grain touches",
        Storage::Integer,
        |r| {
            let count = measure::neighbours(&r.now.state);
            scalars(count.into_iter().map(f64::from).collect())
        },
    ),
];
