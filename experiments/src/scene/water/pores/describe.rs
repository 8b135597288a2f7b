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
                    self.crossed(porosity, height, step)
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

    /// Over how many cells² pressure diffuses in a grain step [s] in such a bed.
    pub fn crossed(&self, porosity: f64, height: f64, step: f64) -> f64 {
        let cell = (height / self.cells[2] as f64).min(self.spacing);
        let storage = porosity * self.fluid.compressibility;
        let diffusivity = self.permeability(porosity) / (self.fluid.viscosity * storage);
        diffusivity * step / (cell * cell)
    }

    /// Time in which pressure drains from a bed of this `porosity` and `height` [m], by the
    /// stiffness that the scene gives, or as if it were rigid [s].
    pub fn drainage_time(&self, porosity: f64, height: f64) -> f64 {
        let compliance = self.compliance(porosity);
        height * height * self.fluid.viscosity * compliance / self.permeability(porosity)
    }
}

/// Dilation of dense beds of spheres over shear strain, as found in `experiments/wet-shear`.
pub const DILATION: f64 = 0.25;

impl Pores {
    /// How far dilation lowers the pressure of a bed of this `porosity` and `height` [m], sheared at
    /// `rate` [1/s] between such `edges`, if it dilates by [`DILATION`] at all heights alike: where
    /// water flows in through both walls, through one, or through none.
    pub fn suction(&self, edges: &Edges, porosity: f64, height: f64, rate: f64) -> Suction {
        let opens = |side: &&Side| matches!(side, Side::Pressure(_));
        let drop = self.fluid.viscosity * DILATION * rate.abs() * height * height
            / self.permeability(porosity);
        match edges.sides.iter().filter(opens).count() {
            0 => Suction::Grows(DILATION / self.compliance(porosity)),
            1 => Suction::Steady(0.5 * drop),
            _ => Suction::Steady(0.125 * drop),
        }
    }

    /// Of water and skeleton, φ β + 1/M, with M as the scene gives it, or as if it were rigid [1/Pa].
    fn compliance(&self, porosity: f64) -> f64 {
        let yielding = match self.stiffness {
            Stiffness::Given(m) => 1.0 / m,
            Stiffness::Unknown | Stiffness::Measured => 0.0,
        };
        porosity * self.fluid.compressibility + yielding
    }
}

/// What dilation makes of the pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Suction {
    /// In the long run, at the place that drains worst [Pa].
    Steady(f64),
    /// For each unit of shear strain [Pa].
    Grows(f64),
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
