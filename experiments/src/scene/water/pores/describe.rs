//! What the numbers of water between grains imply, before a step is made.

use super::{Edges, Pores, Stiffness};
use coupling::NormalStress;
use lbm::{Side, Signal};

impl Pores {
    /// Pairs of a name and a value for a bed of this `porosity` and `height` [m] that makes steps
    /// of `step` [s].
    pub fn facts(&self, porosity: f64, height: f64, step: f64) -> Vec<(&'static str, String)> {
        let [nx, ny, nz] = self.cells;
        let thickness = height / nz as f64;
        let permeability = self.permeability(porosity);
        let storage = porosity * self.fluid.compressibility;
        let diffusivity = permeability / (self.fluid.viscosity * storage);
        let cell = thickness.min(self.spacing);
        let stiffness = match self.stiffness {
            Stiffness::Unknown => {
                "unknown: the report of the run has no B, and counts grains rigid".into()
            }
            Stiffness::Given(m) => format!(
                "{m:.3e} Pa, S M {:.3e}, Skempton's B {:.4}",
                storage * m,
                1.0 / (1.0 + storage * m)
            ),
            Stiffness::Measured => "measured when water comes to a bed under load".into(),
        };
        vec![
            (
                "water",
                format!(
                    "{nx} x {ny} x {nz} cells of {:.4e} m, about {thickness:.4e} m high; a grain \
                     reaches {} of them",
                    self.spacing,
                    self.reach.count()
                ),
            ),
            (
                "permeability",
                format!("about {permeability:.2e} m2, at a porosity of {porosity:.3}"),
            ),
            (
                "diffusion",
                format!(
                    "of pressure over {:.2e} cells2 in a grain step; the fluid steps after 0.25 at \
                     most, or in every one",
                    diffusivity * step / (cell * cell)
                ),
            ),
            (
                "drainage",
                format!(
                    "of a rigid bed in {:.2e} s, storage S {storage:.2e} 1/Pa",
                    height * height / diffusivity
                ),
            ),
            ("skeleton", stiffness),
        ]
    }

    /// Time in which pressure drains from a bed of this `porosity` and `height` [m], by the
    /// stiffness that the scene gives, or as if it were rigid [s].
    pub fn drainage_time(&self, porosity: f64, height: f64) -> f64 {
        let yielding = match self.stiffness {
            Stiffness::Given(m) => 1.0 / m,
            Stiffness::Unknown | Stiffness::Measured => 0.0,
        };
        let compliance = porosity * self.fluid.compressibility + yielding;
        height * height * self.fluid.viscosity * compliance / self.permeability(porosity)
    }
}

impl Edges {
    /// What is at the walls, and what the stress is.
    pub fn describe(&self) -> String {
        let [bottom, top] = [0, 1].map(|side| match &self.sides[side] {
            Side::Pressure(Signal::Steady(p)) => format!("at {p:.4e} Pa"),
            Side::Pressure(_) => "at a pressure that varies".into(),
            Side::Flux(Signal::Steady(q)) => format!("takes in {q:.4e} m/s"),
            Side::Flux(_) => "takes in a flux that varies".into(),
            _ => "tight".into(),
        });
        let stress = match self.normal_stress {
            NormalStress::Total => "total",
            NormalStress::Effective => "effective",
        };
        format!("bottom {bottom}, top {top}; a normal stress is {stress}")
    }
}
