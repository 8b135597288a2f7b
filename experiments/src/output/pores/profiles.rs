//! What water between grains adds to `profiles.nc`: means over the layers of its cells, at the
//! heights of the layers of the grains.

use super::PoreReading;
use dem::measure::profile;
use dem::output::{Storage, Variable};

/// A quantity along z.
#[derive(Debug)]
pub struct Profile {
    /// How the file describes it.
    pub variable: Variable,
    /// Its values in layers between these edges [m]; NaN in those whose middle is not between the
    /// walls.
    pub read: fn(&PoreReading, &[f64]) -> Vec<f64>,
}

const fn profile(
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    read: fn(&PoreReading, &[f64]) -> Vec<f64>,
) -> Profile {
    let variable = Variable {
        name,
        dims: &["z"],
        units,
        long_name,
        storage: Storage::Single,
    };
    Profile { variable, read }
}

/// All of them.
pub static PROFILES: &[Profile] = &[
    profile(
        "pore_pressure",
        "Pa",
        "mean pressure of the water beyond that at rest",
        |water, edges| {
            let means = means(water, |cell| water.now.pressure[cell]);
            let [bottom, top] = water.prescribed;
            // A tight wall has the pressure of the cells beside it.
            let bottom = bottom.unwrap_or(means[0]);
            let top = top.unwrap_or(means[means.len() - 1]);
            along(water, edges, bottom, &means, top)
        },
    ),
    profile(
        "darcy_flux",
        "m s-1",
        "mean upward flux of water against the grains, per area of the bed",
        |water, edges| {
            let means = means(water, |cell| water.now.flux[cell][2]);
            along(water, edges, means[0], &means, means[means.len() - 1])
        },
    ),
];

/// Means of a quantity of the cells over each of their layers.
fn means(water: &PoreReading, of: impl Fn(usize) -> f64) -> Vec<f64> {
    let layers = water.layers();
    let plane = water.now.pressure.len() / layers;
    let mean = |z: usize| (z * plane..(z + 1) * plane).map(&of).sum::<f64>() / plane as f64;
    (0..layers).map(mean).collect()
}

/// Values at the middles of the layers between `edges` [m], on straight lines from the `bottom`
/// wall over the middles of the cells to the `top` wall.
fn along(water: &PoreReading, edges: &[f64], bottom: f64, cells: &[f64], top: f64) -> Vec<f64> {
    let at = |z: f64| {
        // In cells from the bottom; the first middle is at a half.
        let place = (z - water.now.bottom) / water.now.height;
        let last = cells.len() as f64;
        if !(0.0..=last).contains(&place) {
            return f64::NAN;
        }
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
        if place < 0.5 {
            mix(bottom, cells[0], place / 0.5)
        } else if place >= last - 0.5 {
            mix(cells[cells.len() - 1], top, (place - last + 0.5) / 0.5)
        } else {
            let below = (place - 0.5) as usize;
            mix(cells[below], cells[below + 1], place - 0.5 - below as f64)
        }
    };
    profile::centres(edges).into_iter().map(at).collect()
}
