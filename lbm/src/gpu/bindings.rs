//! Nineteen populations over as many bindings as a device needs.
//!
//! wgpu limits what a kernel can bind in one piece, to 2 GiB on large GPUs and to 128 MiB where
//! software plays one. A binding holds all populations, an even number of them, so that the two
//! slots of a pair are neighbours, or one. Twin: shaders/lbm/populations.wgsl.

use crate::check::refuse;
use crate::lattice::PAIRS;
use crate::{Error, Model};

/// Populations of a cell.
pub(super) const POPULATIONS: usize = 1 + 2 * PAIRS;
/// Other arrays of the step at most: five of the bed, three of the sides.
const OTHERS: usize = 8;

/// How the populations are bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bindings {
    /// Populations in one binding; the last may have fewer.
    pub each: usize,
    /// Bindings.
    pub parts: usize,
}

impl Bindings {
    /// The fewest for populations at `places` places, if a binding has up to `largest` bytes
    /// and a kernel up to `count` bindings.
    pub fn new(model: &Model, places: usize, largest: u64, count: u32) -> Result<Self, Error> {
        // Kernels count bytes in words.
        let largest = largest.min(u64::from(u32::MAX));
        let fit = (largest / (4 * places as u64)) as usize;
        let each = match fit {
            0 => {
                return refuse(format!(
                    "{:?} cells: one population of all of them is {:.0} MiB, and the device holds \
                     at most {:.0} MiB in one array, enough for about {:.2e} cells; use fewer",
                    model.cells,
                    4.0 * places as f64 / MIB,
                    largest as f64 / MIB,
                    largest as f64 / 4.0
                ));
            }
            1 => 1,
            POPULATIONS.. => POPULATIONS,
            // As even as it goes.
            fit => POPULATIONS
                .div_ceil(POPULATIONS.div_ceil(fit / 2 * 2))
                .next_multiple_of(2),
        };
        let parts = POPULATIONS.div_ceil(each);
        if parts + OTHERS > count as usize {
            return refuse(format!(
                "{:?} cells: the populations would have to be bound in {parts} parts, and the \
                 device knows {count} arrays at a time, {OTHERS} of them for other things; use \
                 fewer cells",
                model.cells
            ));
        }
        Ok(Self { each, parts })
    }

    /// Populations in part `part`.
    pub fn populations(self, part: usize) -> usize {
        self.each.min(POPULATIONS - part * self.each)
    }
}

const MIB: f64 = 1_048_576.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_whole_pairs_and_no_more_than_needed() {
        let model = Model {
            cells: [10, 10, 10],
            spacing: 1.0,
            fluid: crate::Fluid::COLD_WATER,
            bed: None,
            ends: [
                crate::Ends::Periodic,
                crate::Ends::Periodic,
                crate::Ends::Periodic,
            ],
            solid: Vec::new(),
            acceleration: [0.0; 3],
            inertia: false,
            regime: None,
            step: None,
            speed: 0.0,
        };
        let parts = |fit: u64| {
            let found = Bindings::new(&model, 1000, 4000 * fit + 1, 32).unwrap();
            let all: usize = (0..found.parts).map(|part| found.populations(part)).sum();
            assert_eq!(all, POPULATIONS);
            assert!(found.each <= fit as usize);
            assert!(
                [1, 2, 3, 4, 5, 10, 19].contains(&found.parts),
                "populations.wgsl"
            );
            (found.each, found.parts)
        };
        assert_eq!(parts(25), (19, 1));
        assert_eq!(parts(19), (19, 1));
        assert_eq!(parts(18), (10, 2));
        assert_eq!(parts(10), (10, 2));
        assert_eq!(parts(9), (8, 3));
        assert_eq!(parts(7), (6, 4));
        assert_eq!(parts(5), (4, 5));
        assert_eq!(parts(3), (2, 10));
        assert_eq!(parts(1), (1, 19));
        let refusal = Bindings::new(&model, 1000, 3999, 32)
            .unwrap_err()
            .to_string();
        assert!(refusal.contains("1.00e3 cells"), "{refusal}");
        assert!(Bindings::new(&model, 1000, 4000, 26).is_err());
    }
}
