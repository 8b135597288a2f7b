//! Ergun: flow through packed grains, viscous and turbulent.
//!
//! R = 150 μ (1 - φ)²/(φ³ d²) + 1.75 ρ (1 - φ) |q|/(φ³ d)
//!
//! Holds for packed beds of equal spheres, φ of 0.35 to 0.6, particle Reynolds numbers up to 10³.
//! Source: Ergun (1952), Chem. Eng. Prog. 48, 89.

use lbm::Fluid;

/// R [Pa s/m²] for grains of `diameter` [m] at a flux [m/s].
pub(super) fn resistance(fluid: &Fluid, porosity: f64, flux: f64, diameter: f64) -> f64 {
    let solid = 1.0 - porosity;
    let cube = porosity.powi(3) * diameter;
    let viscous = 150.0 * fluid.viscosity * solid * solid / (cube * diameter);
    viscous + 1.75 * fluid.density * solid * flux / cube
}
