//! Di Felice: from a packed bed to a single grain that settles, at any Reynolds number.
//!
//! The drag on a grain of diameter d in a suspension with superficial slip q is
//!
//! > f = ½ ρ C (π d²/4) q² φ^(-χ),   C = (0.63 + 4.8/√Re)²,   Re = ρ |q| d/μ,
//! > χ = 3.7 - 0.65 exp(-(1.5 - log₁₀Re)²/2),
//!
//! and φ V Δρ g of it hold a grain of volume V in suspension, the pressure of the others' weight
//! the rest. So R = (1 - φ) f/(φ V q). Slow grains in a closed vessel, where q is the speed of
//! the grains, settle with φ^4.7: Richardson and Zaki's exponent is 4.65.
//!
//! Sources: Di Felice (1994), Int. J. Multiphase Flow 20, 153; Dallavalle (1948), Micromeritics,
//! for C, which is 4 % below Stokes at Re → 0.

use lbm::Fluid;
use std::f64::consts::PI;

/// R [Pa s/m²] for grains of `diameter` [m] at a flux [m/s].
pub(super) fn resistance(fluid: &Fluid, porosity: f64, flux: f64, diameter: f64) -> f64 {
    let reynolds = fluid.density * flux * diameter / fluid.viscosity;
    let exponent = match reynolds > 0.0 {
        true => 3.7 - 0.65 * (-0.5 * (1.5 - reynolds.log10()).powi(2)).exp(),
        false => 3.7,
    };
    // C q, finite at rest.
    let root = 0.63 * flux.sqrt() + 4.8 * (fluid.viscosity / (fluid.density * diameter)).sqrt();
    let drag = 0.5 * fluid.density * root * root * PI / 4.0 * diameter * diameter;
    let volume = PI / 6.0 * diameter.powi(3);
    (1.0 - porosity) * drag * porosity.powf(-exponent) / (porosity * volume)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLUID: Fluid = Fluid::COLD_WATER;

    /// Flux at which the drag on suspended grains is in balance with their weight: R q = (1-φ)Δρ g.
    fn balance(porosity: f64, diameter: f64) -> f64 {
        let weight = (1.0 - porosity) * 1600.0 * 9.81;
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let q = 0.5 * (low + high);
            let more = resistance(&FLUID, porosity, q, diameter) * q < weight;
            *if more { &mut low } else { &mut high } = q;
        }
        low
    }

    #[test]
    fn a_small_grain_settles_as_stokes_says_within_dallavalles_four_per_cent() {
        let d = 2e-5;
        let stokes = 1600.0 * 9.81 * d * d / (18.0 * FLUID.viscosity);
        let ratio = balance(1.0 - 1e-9, d) / stokes;
        assert!((ratio - 18.0 / (4.8 * 4.8 * 0.75)).abs() < 0.03, "{ratio}");
    }

    #[test]
    fn suspensions_settle_with_the_exponents_of_richardson_and_zaki() {
        for (diameter, exponent) in [(2e-5, 4.65), (5e-2, 2.39)] {
            let slope = (balance(0.9, diameter) / balance(0.6, diameter)).ln() / (1.5f64).ln();
            assert!(
                (slope / exponent - 1.0).abs() < 0.06,
                "{slope} for {exponent}"
            );
        }
    }
}
