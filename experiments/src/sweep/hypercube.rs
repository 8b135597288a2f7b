//! Latin hypercubes: each range is cut into as many parts as there are points, and each part holds
//! one point.
//! Source: McKay, Beckman and Conover (1979), Technometrics 21, 239.

use super::axis::{Axis, Span};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// So many `points` in `spans`, one axis for each.
pub fn hypercube(spans: &[Span], points: usize, seed: u64) -> Vec<Axis> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let axis = |span: &Span| {
        let mut parts: Vec<usize> = (0..points).collect();
        parts.shuffle(&mut random);
        let mut value = |part: usize| {
            let share = (part as f64 + random.random::<f64>()) / points as f64;
            span.at(share)
        };
        Axis {
            paths: span.paths.clone(),
            values: parts.into_iter().map(&mut value).collect(),
        }
    };
    spans.iter().map(axis).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_of_each_range_holds_one_point_and_a_seed_gives_the_same_again() {
        let spans = ["a=0.0..1.0", "b=1e-3..1e3 m log"].map(|text| Span::read(text).unwrap());
        let axes = hypercube(&spans, 50, 7);
        let number = |text: &String| -> f64 { text.trim_end_matches(" m").parse().unwrap() };
        let a = axes[0].values.iter().map(number);
        let b = axes[1]
            .values
            .iter()
            .map(|text| (number(text).log10() + 3.0) / 6.0);
        for shares in [a.collect::<Vec<_>>(), b.collect()] {
            let mut parts: Vec<usize> = shares.iter().map(|x| (50.0 * x) as usize).collect();
            assert_ne!(parts, (0..50).collect::<Vec<_>>(), "not in order");
            parts.sort_unstable();
            assert_eq!(parts, (0..50).collect::<Vec<_>>());
        }
        assert_eq!(hypercube(&spans, 50, 7), axes);
        assert_ne!(hypercube(&spans, 50, 8), axes);
    }
}
