//! Measures of a packing, written independently of the solver.

use dem::{Domain, Grains};
use glam::DVec3;
use std::f64::consts::PI;

/// Volume [m³] of the part of a sphere that lies below the plane at height `z` above its
/// centre [m].
pub fn volume_below(radius: f64, z: f64) -> f64 {
    let h = (z + radius).clamp(0.0, 2.0 * radius);
    PI / 3.0 * h * h * (3.0 * radius - h)
}

/// Solid fraction [-] between the heights `low` and `high` [m], from exact volumes of spheres.
pub fn solid_fraction(grains: &Grains, domain: &Domain, low: f64, high: f64) -> f64 {
    let inside = |k: usize| {
        let (radius, z) = (grains.radius[k], grains.position[k].z);
        volume_below(radius, high - z) - volume_below(radius, low - z)
    };
    (0..grains.len()).map(inside).sum::<f64>() / (domain.area() * (high - low))
}

/// From `b` to `a` [m] along the shortest way through periodic sides.
pub fn separation(a: DVec3, b: DVec3, domain: &Domain) -> DVec3 {
    let mut d = a - b;
    for axis in 0..2 {
        if domain.periodic[axis] {
            d[axis] -= domain.size[axis] * (d[axis] / domain.size[axis]).round();
        }
    }
    d
}

/// All pairs of overlapping grains, `i < j`, by looking at every pair.
pub fn touching_pairs(grains: &Grains, domain: &Domain) -> Vec<(u32, u32)> {
    let mut pairs = vec![];
    for i in 0..grains.len() {
        for j in i + 1..grains.len() {
            let d = separation(grains.position[i], grains.position[j], domain);
            let reach = grains.radius[i] + grains.radius[j];
            if d.length_squared() < reach * reach {
                pairs.push((i as u32, j as u32));
            }
        }
    }
    pairs
}

/// Total momentum [kg m/s].
pub fn momentum(grains: &Grains) -> DVec3 {
    let each = grains.mass.iter().zip(&grains.velocity);
    each.map(|(m, v)| *m * *v).sum()
}

/// Total angular momentum about the origin [kg m²/s], of positions that never wrapped.
pub fn angular_momentum(grains: &Grains) -> DVec3 {
    let each = |k: usize| {
        let orbit = grains.position[k].cross(grains.mass[k] * grains.velocity[k]);
        orbit + grains.moment_of_inertia[k] * grains.angular_velocity[k]
    };
    (0..grains.len()).map(each).sum()
}
