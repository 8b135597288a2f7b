//! What the numbers of water imply: said before a run, and by `esker check`.

use super::{AXES, Precision, Water, word};
use lbm::{Ends, Regime, Side};

impl Water {
    /// The lines of [`facts`](Self::facts), for the start of a run of `steps` steps.
    pub fn describe(&self, steps: u64) -> Vec<String> {
        let lines = self.facts(steps).into_iter();
        let lines = lines.map(|(what, value)| format!("{what:<22}{value}"));
        lines
            .chain(
                self.warnings(steps)
                    .into_iter()
                    .map(|w| format!("warning: {w}")),
            )
            .collect()
    }

    /// What a run of `steps` steps is, as pairs of a name and a value.
    pub fn facts(&self, steps: u64) -> Vec<(&'static str, String)> {
        let (scaling, model) = (&self.scaling, &self.model);
        let [nx, ny, nz] = model.cells;
        let size = self
            .lattice()
            .size()
            .map(|length| format!("{length:.4e}"))
            .join(" x ");
        let mut facts = vec![(
            "cells",
            format!("{nx} x {ny} x {nz} of {:.4e} m, {size} m", model.spacing),
        )];
        if !model.solid.is_empty() {
            facts.push(("solid", self.lattice().describe_solid(&model.solid)));
        }
        let numbers = match self.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        facts.push(("regime", format!("{}, in {numbers}", word(scaling.regime))));
        let seconds = steps as f64 * scaling.step;
        let step = scaling.step;
        facts.push((
            "time step",
            format!("{step:.4e} s, {steps} steps at most, {seconds:.4e} s"),
        ));
        facts.push((
            "relaxation times",
            format!(
                "tau {:.4} (even) and {:.4} (odd) steps: a viscosity of {:.3e} m2/s, the water has \
                 {:.3e}",
                scaling.tau_even,
                scaling.tau_odd,
                scaling.lattice_viscosity(),
                scaling.viscosity / scaling.true_density
            ),
        ));
        if model.bed.is_some() {
            let [low, high] = scaling.drag;
            facts.push(("drag", format!("sigma {low:.3e} to {high:.3e} a step")));
            let [low, high] = scaling.diffusivity;
            let real = self.diffusivity();
            if low.is_finite() {
                facts.push((
                    "diffusivity",
                    format!("{low:.3e} to {high:.3e} cells2 a step, at most {real:.3e} m2/s"),
                ));
            }
        }
        if scaling.regime != Regime::Diffusive {
            let mach = match model.speed {
                0.0 => "unknown: no speed is given (water.speed)".into(),
                speed => format!("{:.3e} of the lattice, at {speed:.3e} m/s", scaling.mach),
            };
            facts.push(("Mach number", mach));
        }
        facts.push(("left out", self.left_out().join(", ")));
        facts
    }

    /// What costs nothing because the scene does not need it.
    pub fn left_out(&self) -> Vec<String> {
        let model = &self.model;
        let mut out = Vec::new();
        if !model.inertia {
            out.push("squares of the velocity (no inertia of what is carried along)".into());
        }
        if model.acceleration == [0.0; 3] {
            out.push("body force".into());
        }
        match &model.bed {
            None => out.push("drag, porosity and permeability".into()),
            Some(bed) if bed.forchheimer.is_none() => out.push("drag beyond Darcy's".into()),
            Some(_) => {}
        }
        if model.solid.is_empty() {
            out.push("solid cells".into());
        }
        if model.ends.iter().all(|ends| *ends == Ends::Periodic) {
            out.push("sides".into());
        }
        out
    }

    /// What is possible and yet likely to be a mistake, in a run of `steps` steps.
    pub fn warnings(&self, steps: u64) -> Vec<String> {
        let (model, mut warnings) = (&self.model, Vec::new());
        let (seconds, diffusivity) = (steps as f64 * self.scaling.step, self.diffusivity());
        if self.scaling.is_undrained(seconds) {
            warnings.push(format!(
                "undrained: pressure diffuses at {diffusivity:.2e} m2/s, over less than a tenth of \
                 a cell in all {seconds:.2e} s; each cell keeps its water, a lattice is not needed"
            ));
        }
        if self.other_lattice {
            warnings.push(
                "the state is of a lattice with another step or density: only its pressure and \
                 flow are taken over, and the first steps settle the rest"
                    .into(),
            );
        }
        let open = |side: &Side| matches!(side, Side::Pressure(_) | Side::Flux(_));
        for (axis, ends) in model.ends.iter().enumerate() {
            let along = AXES[axis];
            let accelerated = model.acceleration[axis] != 0.0;
            if let Ends::Walls(lower, upper) = ends
                && accelerated
                && !(open(lower) && open(upper))
            {
                warnings.push(format!(
                    "a body force pushes water along {along} against a side through which none \
                     passes: it only makes pressure; leave it out, since pressure counts from that \
                     at rest"
                ));
            }
        }
        warnings
    }
}
