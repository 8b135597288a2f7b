//! Models of few parts, and measures of error.

use lbm::{Bed, Ends, Field, Fluid, Model, Regime, Side, Signal};

/// A liquid in which numbers are easy: density, viscosity and compressibility [SI].
pub fn fluid(density: f64, viscosity: f64, compressibility: f64) -> Fluid {
    Fluid {
        density,
        viscosity,
        compressibility,
    }
}

/// Free water, periodic along each axis, in cells of one metre.
pub fn free(cells: [usize; 3], viscosity: f64) -> Model {
    Model {
        cells,
        spacing: 1.0,
        fluid: fluid(1.0, viscosity, 1.0),
        bed: None,
        ends: [Ends::Periodic, Ends::Periodic, Ends::Periodic],
        solid: Vec::new(),
        acceleration: [0.0; 3],
        inertia: false,
        regime: None,
        step: None,
        speed: 0.0,
    }
}

/// A uniform bed in a column of `n` cells along z over `height` [m], tight at the base and
/// drained at the top.
pub fn column(n: usize, height: f64, permeability: f64) -> Model {
    Model {
        spacing: height / n as f64,
        fluid: Fluid::COLD_WATER,
        bed: Some(Bed {
            porosity: Field::Uniform(0.4),
            permeability: Field::Uniform(permeability),
            forchheimer: None,
        }),
        ends: [
            Ends::Periodic,
            Ends::Periodic,
            Ends::Walls(Side::FreeSlip, Side::Pressure(Signal::Steady(0.0))),
        ],
        regime: Some(Regime::Diffusive),
        ..free([1, 1, n], 1.0)
    }
}

/// Walls at rest, to which water sticks, at both ends of an axis.
pub fn no_slip() -> Ends {
    Ends::Walls(Side::NoSlip([0.0; 3]), Side::NoSlip([0.0; 3]))
}

/// √(Σ(a - b)² / Σb²)
pub fn relative_error(a: impl IntoIterator<Item = f64>, b: &[f64]) -> f64 {
    let (mut difference, mut scale) = (0.0, 0.0);
    let mut count = 0;
    for (a, b) in a.into_iter().zip(b) {
        difference += (a - b).powi(2);
        scale += b * b;
        count += 1;
    }
    assert_eq!(count, b.len());
    (difference / scale).sqrt()
}

/// Order of convergence between errors at spacings that halve each time.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

/// Numbers between 0 and 1 without structure, the same each time.
pub fn scatter(n: usize) -> Vec<f64> {
    let mut x = 0x2545_f491_4f6c_dd1d_u64;
    let next = |_| {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(next).collect()
}
