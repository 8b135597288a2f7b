//! Periodic lengths in whole units of the GPU's positions, whoever computes.
//!
//! A GPU wraps positions exactly, which whole lengths alone allow. So that one scene is one
//! box on every machine, they are made whole here, once: by at most half a unit, of the order
//! of 1e-7 of a grain.

use dem::gpu::fixed::Grid;
use dem::{Domain, Grains};

/// The unit is a power of two that a solver chooses for the state at hand. This one is as
/// coarse as that of any state of the scene, so that its multiples are whole for all of them:
/// for coordinates so many times as large as those of the start ...
const FARTHEST: f64 = 4.0;
/// ... or as a bed of so small a solid fraction, ...
const LOOSEST: f64 = 0.125;
/// ... and for the largest skin [mean radii].
const SKIN: f64 = 0.5;

/// A grid of positions that is as coarse as any that a GPU takes for a bed of `grains` in
/// `domain` below a wall at `height` [m], if it is known, searched with `skin` [m], if it is
/// given.
///
/// # Errors
/// A box that is too large for the GPU.
pub fn grid(
    domain: &Domain,
    grains: &Grains,
    height: Option<f64>,
    skin: Option<f64>,
) -> Result<Grid, dem::Error> {
    let volume: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    let loose = volume / (LOOSEST * domain.area());
    let places = grains.position.iter().map(|x| x.abs().max_element());
    let [x, y] = domain.size;
    let farthest = places.fold(x.max(y).max(loose).max(height.unwrap_or(0.0)), f64::max);
    let largest = grains.radius.iter().copied().fold(0.0, f64::max);
    let skin = skin.unwrap_or(0.0).max(SKIN * grains.mean_radius());
    Grid::new(domain, FARTHEST * farthest, 2.0 * largest + skin)
}

/// `domain` with periodic lengths in whole units of [`grid`]. A box too large for the GPU stays
/// as it is.
pub fn whole(domain: Domain, grains: &Grains, height: Option<f64>, skin: Option<f64>) -> Domain {
    let grid = grid(&domain, grains, height, skin);
    grid.map_or(domain, |grid| grid.domain(&domain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn lengths_change_by_less_than_a_millionth_of_a_grain_and_only_once() {
        let mut grains = Grains::default();
        for k in 0..10 {
            grains.add_sphere(DVec3::splat(0.02 * f64::from(k)), 0.01, 2600.0);
        }
        let stated = Domain {
            size: [0.3, 0.7],
            periodic: [true, false],
        };
        let domain = whole(stated, &grains, Some(0.5), None);
        assert_ne!(
            domain.size[0], stated.size[0],
            "0.3 has no exact binary form"
        );
        assert!((domain.size[0] - stated.size[0]).abs() < 1e-6 * 0.01);
        assert_eq!(domain.size[1], stated.size[1], "walls stand anywhere");
        assert_eq!(whole(domain, &grains, Some(0.5), None), domain);
        // Of a bed that has settled too.
        assert_eq!(whole(domain, &grains, Some(0.1), None), domain);
    }
}
