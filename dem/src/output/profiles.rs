//! Profiles of `profiles.nc`.

use super::{Field, Storage, field, scalars, vectors};
use crate::measure::profile;
use glam::DMat3;
use ndarray::{Array3, ArrayD};

/// Profiles along z: dimension `z`, one entry a layer between two edges. `component` is
/// x, y, z; so is `face`, the axis across which a stress acts.
pub static PROFILES: &[Field] = &[
    field(
        "velocity",
        &["z", "component"],
        "m s-1",
        "mean velocity of the grains",
        Storage::Single,
        |r| {
            let grains = &r.now.state.grains;
            vectors(&profile::mass_mean(grains, &grains.velocity, r.edges))
        },
    ),
    field(
        "solid_fraction",
        &["z"],
        "1",
        "solid fraction",
        Storage::Single,
        |r| {
            let fraction = profile::solid_fraction(r.model, &r.now.state.grains, r.edges);
            scalars(fraction)
        },
    ),
    field(
        "stress",
        &["z", "component", "face"],
        "Pa",
        "stress, compression positive (xz is negative where the upper side is dragged along +x)",
        Storage::Single,
        |r| matrices(&profile::stress(r.model, &r.now.state, r.edges)),
    ),
    field(
        "strain_rate",
        &["z"],
        "s-1",
        "shear strain rate dv_x/dz",
        Storage::Single,
        |r| scalars(profile::strain_rate(&r.now.state.grains, r.edges)),
    ),
    field(
        "angular_velocity",
        &["z", "component"],
        "rad s-1",
        "mean angular velocity of the grains",
        Storage::Single,
        |r| {
            let grains = &r.now.state.grains;
            let spin = &grains.angular_velocity;
            vectors(&profile::mass_mean(grains, spin, r.edges))
        },
    ),
];

fn matrices(values: &[DMat3]) -> ArrayD<f64> {
    // glam keeps columns: row i of column j.
    Array3::from_shape_fn((values.len(), 3, 3), |(k, i, j)| values[k].col(j)[i]).into_dyn()
}
