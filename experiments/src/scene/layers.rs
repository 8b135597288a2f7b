//! Is there room for the held and the driven layer? Said before the run where it can be known,
//! since the bed that a phase shears is there only after the phases before it.

use super::Scene;
use crate::protocol;
use crate::start::highest;
use dem::Grains;

/// Solid fraction of the loosest bed that carries a load: spheres at high friction jam at
/// 0.55.
pub const LOOSEST: f64 = 0.5;

/// A bed overlaps its walls by less than this, in radii.
const OVERLAP: f64 = 0.1;

/// What can be known of a bed before it is there, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Height of the grains at the start, or more.
    start: f64,
    /// Height of the bed once it lies or is pressed, or more.
    settled: f64,
    smallest_radius: f64,
    largest_radius: f64,
}

impl Room {
    /// Where nothing is known, nothing is refused.
    pub const ENDLESS: Self = Self {
        start: f64::INFINITY,
        settled: f64::INFINITY,
        smallest_radius: 0.0,
        largest_radius: 0.0,
    };

    /// Of `grains` over `area` [m²], still without places if they are thrown in, to fill this
    /// fraction of the room.
    pub fn of(grains: &Grains, area: f64, loose: Option<f64>) -> Self {
        let volume: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
        let radius = || grains.radius.iter().copied();
        let largest_radius = radius().fold(0.0, f64::max);
        // The uppermost grains stand out.
        let at = |fraction| volume / (fraction * area) + 2.0 * largest_radius;
        Self {
            start: loose.map_or_else(|| highest(grains), at),
            settled: at(LOOSEST),
            smallest_radius: radius().fold(f64::INFINITY, f64::min),
            largest_radius,
        }
    }

    /// Why two layers of this thickness [m] cannot be in a bed that has `settled` or is as at the
    /// start; none: they may be.
    pub fn refuses(&self, layer: f64, settled: bool) -> Option<String> {
        let tallest = if settled { self.settled } else { self.start };
        if 2.0 * layer >= tallest {
            return Some(format!(
                "two layers of {layer:.4e} m, held and driven, are thicker than the whole bed, \
                 {tallest:.4e} m at most; write less, or use more grains"
            ));
        }
        if layer < (1.0 - OVERLAP) * self.smallest_radius {
            return Some(format!(
                "a layer of {layer:.4e} m holds no grain: the centre of the smallest stands \
                 {:.4e} m from a wall; write e.g. the largest diameter, {:.4e} m",
                self.smallest_radius,
                2.0 * self.largest_radius
            ));
        }
        None
    }
}

impl Scene {
    /// What is possible and yet likely to be a mistake.
    pub fn warnings(&self) -> Vec<String> {
        let sheared = self.phases.iter().filter(|phase| phase.shear.is_some());
        let height = protocol::expected_height(self);
        let radius = self.start.grains.radius.iter().copied().fold(0.0, f64::max);
        let warning = |phase: &super::Phase| {
            let (name, layer) = (&phase.name, phase.layer);
            let share = 2.0 * layer / height;
            if share > 0.5 {
                return Some(format!(
                    "phase {name}: the held and the driven layer of {layer:.4} m each take {:.0} % \
                     of the bed, which will be about {height:.4} m high; the phase cannot begin if \
                     nothing is left between them: write a thinner layer, or use more grains",
                    100.0 * share
                ));
            }
            (layer < radius).then(|| {
                format!(
                    "phase {name}: a layer of {layer:.4e} m holds only grains that are smaller, and \
                     the largest radius is {radius:.4e} m; the phase cannot begin if none is there: \
                     write e.g. the largest diameter, {:.4e} m",
                    2.0 * radius
                )
            })
        };
        let mut warnings: Vec<String> = sheared.filter_map(warning).collect();
        warnings.extend(self.phases.iter().flat_map(super::water::pores::warnings));
        if self.water.is_none() && self.past.water.is_some() {
            let what = "the state has water between its grains, and the scene no [water]";
            warnings.push(format!("{what}: they go on dry"));
        }
        warnings
    }
}
