//! D3Q19: a rest population, and nine pairs of opposite directions.
//!
//! The forward direction of a pair never points to smaller x: then a row of cells reaches
//! beyond its end at one side only. Source of the weights: Qian, d'Humières and Lallemand
//! (1992), Europhys. Lett. 17, 479.

/// Pairs of opposite directions.
pub(crate) const PAIRS: usize = 9;

/// The forward direction of each pair; the backward one is its negative.
pub(crate) const C: [[i32; 3]; PAIRS] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 1, 0],
    [1, -1, 0],
    [1, 0, 1],
    [1, 0, -1],
    [0, 1, 1],
    [0, 1, -1],
];

/// Weight of the directions along an axis.
pub(crate) const W_AXIS: f64 = 1.0 / 18.0;
/// Weight of the directions across two axes.
pub(crate) const W_DIAGONAL: f64 = 1.0 / 36.0;

/// Weight of both directions of a pair.
pub(crate) fn weight(pair: usize) -> f64 {
    if pair < 3 { W_AXIS } else { W_DIAGONAL }
}

/// One of the eighteen moving directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Direction {
    pub pair: usize,
    pub forward: bool,
}

impl Direction {
    /// All moving directions.
    pub fn all() -> impl Iterator<Item = Self> {
        let both = |pair| [true, false].map(|forward| Self { pair, forward });
        (0..PAIRS).flat_map(both)
    }

    /// The direction along `c`.
    pub fn along(c: [i32; 3]) -> Self {
        let found = Self::all().find(|direction| direction.c() == c);
        found.expect("c is a direction of D3Q19")
    }

    pub fn c(self) -> [i32; 3] {
        let sign = if self.forward { 1 } else { -1 };
        C[self.pair].map(|c| sign * c)
    }

    /// c · v
    pub fn dot(self, v: [f64; 3]) -> f64 {
        let c = self.c();
        (0..3).map(|axis| f64::from(c[axis]) * v[axis]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σw = 1, Σ w c c = 1/3 and Σ w c c c c = 1/9 (δδ + δδ + δδ): what the Navier-Stokes
    /// equations need.
    #[test]
    fn moments_of_the_weights_are_isotropic() {
        let sum = |g: &dyn Fn([f64; 3]) -> f64| -> f64 {
            Direction::all()
                .map(|d| weight(d.pair) * g(d.c().map(f64::from)))
                .sum()
        };
        let w_rest = 1.0 / 3.0;
        assert!((w_rest + sum(&|_| 1.0) - 1.0).abs() < 1e-15);
        for a in 0..3 {
            for b in 0..3 {
                let same = f64::from(a == b);
                assert!((sum(&|c| c[a] * c[b]) - same / 3.0).abs() < 1e-15);
                let fourth = sum(&|c| c[a] * c[a] * c[b] * c[b]);
                assert!((fourth - (1.0 + 2.0 * same) / 9.0).abs() < 1e-15);
            }
        }
    }
}
