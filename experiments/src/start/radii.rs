//! Laws of grain size.

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, LogNormal};

/// How radii are spread [m].
#[derive(Clone, Debug, PartialEq)]
pub enum RadiusLaw {
    /// All the same.
    Single(f64),
    /// Each as likely between the two.
    Uniform {
        /// Smallest.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// ln R is normal; what falls outside `min` to `max` is drawn again.
    LogNormal {
        /// Radius that half of the grains are below.
        median: f64,
        /// Standard deviation of ln R [-].
        spread: f64,
        /// Smallest.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// These sizes, each with its share of the number of grains.
    Listed {
        /// Radii.
        values: Vec<f64>,
        /// Shares, of any sum [-].
        shares: Vec<f64>,
    },
}

impl RadiusLaw {
    /// Radii of `count` grains [m].
    pub fn draw(&self, count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
        match self {
            Self::Single(radius) => vec![*radius; count],
            Self::Uniform { min, max } => (0..count)
                .map(|_| min + (max - min) * random.random::<f64>())
                .collect(),
            Self::LogNormal {
                median,
                spread,
                min,
                max,
            } => {
                let law = LogNormal::new(median.ln(), *spread).expect("the spread was checked");
                let fits = law.sample_iter(random).filter(|r| r >= min && r <= max);
                fits.take(count).collect()
            }
            Self::Listed { values, shares } => {
                let mut all = listed(count, values, shares);
                all.shuffle(random);
                all
            }
        }
    }
}

/// Each value as often as its share says, to within one grain.
fn listed(count: usize, values: &[f64], shares: &[f64]) -> Vec<f64> {
    let total: f64 = shares.iter().sum();
    let mut all = Vec::with_capacity(count);
    let mut sum = 0.0;
    for (value, share) in values.iter().zip(shares) {
        sum += share;
        let end = (count as f64 * sum / total).round() as usize;
        all.resize(end.clamp(all.len(), count), *value);
    }
    all.resize(count, *values.last().expect("a list has values"));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn draw(law: &RadiusLaw, count: usize) -> Vec<f64> {
        law.draw(count, &mut ChaCha8Rng::seed_from_u64(1))
    }

    #[test]
    fn log_normal_radii_have_their_median_and_stay_within_1_to_10() {
        let law = RadiusLaw::LogNormal {
            median: 1e-2,
            spread: 0.5,
            min: 1e-2 / 10f64.sqrt(),
            max: 1e-2 * 10f64.sqrt(),
        };
        let mut radii = draw(&law, 10_001);
        radii.sort_by(f64::total_cmp);
        assert!((radii[5000] / 1e-2 - 1.0).abs() < 0.02);
        assert!(radii[10_000] / radii[0] <= 10.0 && radii[10_000] / radii[0] > 9.0);
        // Of the untruncated law 16 % lie a spread above the median.
        let above = radii.iter().filter(|&&r| r > 1e-2 * 0.5f64.exp()).count();
        assert!((above as f64 / 10_001.0 - 0.159).abs() < 0.02, "{above}");
    }

    #[test]
    fn listed_radii_come_with_their_shares() {
        let law = RadiusLaw::Listed {
            values: vec![1.0, 2.0, 3.0],
            shares: vec![7.0, 2.0, 1.0],
        };
        let radii = draw(&law, 1000);
        let count = |value: f64| radii.iter().filter(|&&r| r == value).count();
        assert_eq!([count(1.0), count(2.0), count(3.0)], [700, 200, 100]);
        assert!(radii[..100].iter().any(|&r| r > 1.0), "they are mixed");
    }

    #[test]
    fn the_seed_fixes_the_radii() {
        let law = RadiusLaw::Uniform { min: 1.0, max: 2.0 };
        assert_eq!(draw(&law, 10), draw(&law, 10));
        assert!(draw(&law, 10).iter().all(|r| (1.0..2.0).contains(r)));
    }
}
