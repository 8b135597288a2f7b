//! Means over horizontal layers: velocity, solid fraction, stress.
//!
//! A layer l lies between `edges[l]` and `edges[l + 1]`. A grain belongs to every layer
//! it reaches into, by the exact volume of its part there; a layer without grains has no
//! mean, which is written as NaN.

use super::sphere_volume_between;
use crate::{Grains, Model, State};
use glam::{DMat3, DVec3};
use std::ops::Range;

/// Layers that the heights from `low` to `high` touch; at least one inside the edges.
fn layers_between(edges: &[f64], low: f64, high: f64) -> Range<usize> {
    let first = edges.partition_point(|&e| e <= low).saturating_sub(1);
    let end = edges.partition_point(|&e| e < high).max(first + 1);
    first..end.min(layers(edges))
}

/// Call `visit` with grain, layer and the volume [m³] of the grain within the layer.
fn for_each_share(grains: &Grains, edges: &[f64], mut visit: impl FnMut(usize, usize, f64)) {
    for k in 0..grains.len() {
        let (z, radius) = (grains.position[k].z, grains.radius[k]);
        for layer in layers_between(edges, z - radius, z + radius) {
            let volume = sphere_volume_between(z, radius, edges[layer], edges[layer + 1]);
            if volume > 0.0 {
                visit(k, layer, volume);
            }
        }
    }
}

/// Solid fraction of each layer.
pub fn solid_fraction(model: &Model, grains: &Grains, edges: &[f64]) -> Vec<f64> {
    let mut solid = vec![0.0; layers(edges)];
    for_each_share(grains, edges, |_, layer, volume| solid[layer] += volume);
    let volume = layer_volumes(model, edges);
    solid.iter().zip(volume).map(|(s, v)| s / v).collect()
}

/// Mean over the mass in each layer of a vector that each grain has.
pub fn mass_mean(grains: &Grains, of: &[DVec3], edges: &[f64]) -> Vec<DVec3> {
    let mut sum = vec![DVec3::ZERO; layers(edges)];
    let mut mass = vec![0.0; layers(edges)];
    for_each_share(grains, edges, |k, layer, volume| {
        let share = grains.mass[k] * volume / grains.volume(k);
        sum[layer] += share * of[k];
        mass[layer] += share;
    });
    sum.iter().zip(mass).map(|(&s, m)| s / m).collect()
}

/// Shear strain rate ∂v_x/∂z of each layer [1/s], from the velocities of its neighbours
/// above and below, or its own where there is none.
pub fn strain_rate(grains: &Grains, edges: &[f64]) -> Vec<f64> {
    let velocity = mass_mean(grains, &grains.velocity, edges);
    let height = centres(edges);
    let known = |l: usize| velocity.get(l).is_some_and(|v| v.x.is_finite());
    let slope = |layer: usize| {
        if !known(layer) {
            return f64::NAN;
        }
        let above = if known(layer + 1) { layer + 1 } else { layer };
        let below = match layer.checked_sub(1) {
            Some(below) if known(below) => below,
            _ => layer,
        };
        // 0/0, not a number, where a layer stands alone.
        (velocity[above].x - velocity[below].x) / (height[above] - height[below])
    };
    (0..layers(edges)).map(slope).collect()
}

/// Stress of each layer [Pa], compression positive: column j of the matrix is the force
/// per area on a face across axis j.
///
/// σ_ij = 1/V [ Σ_contacts F_i b_j s + Σ_grains m v'_i v'_j ], with F the force on the
/// grain to which the branch b points, s the part of the branch inside the layer, and v'
/// the velocity relative to the layer's mean. With the branch spread so, the zz component
/// of a bed at rest without gravity equals the stress on its walls in every layer.
/// With compression positive, xz is negative where the upper side is dragged along +x.
pub fn stress(model: &Model, state: &State, edges: &[f64]) -> Vec<DMat3> {
    let mut sum = vec![DMat3::ZERO; layers(edges)];
    for contact in &state.contacts {
        let virial = outer(contact.force, contact.branch);
        let end = state.grains.position[contact.i as usize].z;
        let start = end - contact.branch.z;
        let (low, high) = (start.min(end), start.max(end));
        for layer in layers_between(edges, low, high) {
            sum[layer] += virial * part_inside(low, high, edges[layer], edges[layer + 1]);
        }
    }

    let grains = &state.grains;
    let mean = mass_mean(grains, &grains.velocity, edges);
    for_each_share(grains, edges, |k, layer, volume| {
        let share = grains.mass[k] * volume / grains.volume(k);
        let fluctuation = grains.velocity[k] - mean[layer];
        sum[layer] += outer(fluctuation, fluctuation) * share;
    });

    let volume = layer_volumes(model, edges);
    sum.iter()
        .zip(volume)
        .map(|(&s, v)| s * v.recip())
        .collect()
}

/// Part of the branch between the heights `low` and `high` that lies in a layer; a level
/// branch lies whole in the layer of its height.
fn part_inside(low: f64, high: f64, bottom: f64, top: f64) -> f64 {
    if low == high {
        return if (bottom..top).contains(&low) {
            1.0
        } else {
            0.0
        };
    }
    (high.min(top) - low.max(bottom)).max(0.0) / (high - low)
}

/// The matrix a_i b_j.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Number of layers.
fn layers(edges: &[f64]) -> usize {
    edges.len().saturating_sub(1)
}

/// Middle height of each layer [m].
pub fn centres(edges: &[f64]) -> Vec<f64> {
    edges.windows(2).map(|e| 0.5 * (e[0] + e[1])).collect()
}

/// Volume of each layer [m³].
fn layer_volumes(model: &Model, edges: &[f64]) -> impl Iterator<Item = f64> {
    let area = model.domain.area();
    edges.windows(2).map(move |e| area * (e[1] - e[0]))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{column, contact, lattice, model, walls};
    use super::*;
    use crate::Body;
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use std::f64::consts::PI;

    /// Unequal layers, some of them outside the bed.
    const EDGES: [f64; 8] = [-1.0, 0.0, 0.3, 1.0, 2.5, 2.6, 4.0, 5.0];

    #[test]
    fn a_height_finds_its_layers() {
        let edges = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(layers_between(&edges, 0.5, 1.5), 0..2);
        assert_eq!(layers_between(&edges, 1.0, 2.0), 1..2);
        assert_eq!(layers_between(&edges, -5.0, 9.0), 0..3);
        assert_eq!(layers_between(&edges, 1.0, 1.0), 1..2);
        assert!(layers_between(&edges, 3.0, 4.0).is_empty());
        assert!(layers_between(&[], 3.0, 4.0).is_empty());
    }

    #[test]
    fn a_pressed_column_carries_the_stress_of_the_walls_in_every_layer() {
        let stress = stress(&model([3.0, 4.0]), &column(), &EDGES);
        // 8 N over 12 m², up and down to the walls at 0 and 4.
        for (layer, expected) in [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0].iter().enumerate() {
            let s = stress[layer].to_cols_array();
            assert_relative_eq!(s[8], expected * 8.0 / 12.0, max_relative = 1e-14);
            assert_eq!(s[..8], [0.0; 8]);
        }
    }

    #[test]
    fn a_layer_dragged_along_x_from_above_has_a_negative_xz() {
        let mut state = lattice([1, 1, 2]);
        // The upper grain is held back by the lower one.
        let force = 5.0 * DVec3::NEG_X;
        state.contacts = vec![contact(1, Body::Grain(0), force, 2.0 * DVec3::Z)];
        let stress = stress(&model([2.0, 2.0]), &state, &[1.0, 3.0]);
        // Force along x on a face across z: column z, row x.
        assert_relative_eq!(stress[0].z_axis.x, -5.0 / 4.0, max_relative = 1e-14);
        assert_eq!(stress[0].x_axis, DVec3::ZERO);
    }

    #[test]
    fn a_level_contact_counts_once_even_on_an_edge() {
        let mut state = lattice([2, 1, 1]);
        let force = 3.0 * DVec3::X;
        state.contacts = vec![contact(1, Body::Grain(0), force, 2.0 * DVec3::X)];
        let stress = stress(&model([4.0, 2.0]), &state, &[0.0, 1.0, 2.0]);
        let xx: Vec<_> = stress.iter().map(|s| s.x_axis.x).collect();
        // 3 N x 2 m in a layer of 8 m³.
        assert_eq!(xx, [0.0, 0.75]);
    }

    #[test]
    fn opposite_velocities_push_with_their_kinetic_energy() {
        let mut state = lattice([2, 1, 1]);
        state.grains.velocity = vec![DVec3::new(3.0, 0.0, 7.0), DVec3::new(-1.0, 0.0, 7.0)];
        let stress = stress(&model([4.0, 2.0]), &state, &[0.0, 2.0]);
        // Fluctuations of ±2 about the mean of 1: m 2² twice in a box of 16 m³; the common
        // velocity along z gives nothing.
        let expected = 2.0 * state.grains.mass[0] * 4.0 / 16.0;
        assert_relative_eq!(stress[0].x_axis.x, expected, max_relative = 1e-14);
        assert_abs_diff_eq!(stress[0].z_axis.z, 0.0, epsilon = 1e-14);
    }

    #[test]
    fn shares_of_layers_sum_to_the_grains() {
        let model = model([3.0, 4.0]);
        let fraction = solid_fraction(&model, &column().grains, &EDGES);
        let volume = layer_volumes(&model, &EDGES);
        let sum: f64 = fraction.iter().zip(volume).map(|(f, v)| f * v).sum();
        assert_relative_eq!(sum, 2.0 * 4.0 / 3.0 * PI, max_relative = 1e-14);
        assert_eq!([fraction[0], fraction[6]], [0.0, 0.0]);
    }

    #[test]
    fn a_linear_profile_has_its_slope_everywhere() {
        let mut state = lattice([2, 2, 6]);
        state.walls = walls(16.0);
        for (v, x) in state.grains.velocity.iter_mut().zip(&state.grains.position) {
            v.x = 0.25 * x.z;
        }
        let edges: Vec<_> = (0..=8).map(|l| 2.0 * f64::from(l)).collect();
        let velocity = mass_mean(&state.grains, &state.grains.velocity, &edges);
        let rate = strain_rate(&state.grains, &edges);
        for layer in 0..6 {
            let z = centres(&edges)[layer];
            assert_relative_eq!(velocity[layer].x, 0.25 * z, max_relative = 1e-14);
            assert_relative_eq!(rate[layer], 0.25, max_relative = 1e-13);
        }
        // No grains, no mean.
        assert!(velocity[6].x.is_nan() && rate[7].is_nan());
    }
}
