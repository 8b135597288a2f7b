//! What the numbers of a coupled run imply, and what was seen while it went on.

use crate::choice::{REFUSED, Steps, WARNED};
use crate::lattice::Lattice;
use crate::softness::Softness;
use crate::{Model, Water};
use std::fmt;

/// Convection of momentum over drag that is worth a warning.
const CONVECTION: f64 = 0.1;

/// What happened that a user must know.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Events {
    /// D_n and C of the present steps.
    pub diffusivity: f64,
    pub courant: f64,
    /// Convection of momentum over drag in open pores, so far.
    pub convection: Option<f64>,
    /// Lattices laid anew.
    pub relaid: u64,
    /// Time with vapour [s], and the most of it [m³].
    pub vapour_time: f64,
    pub vapour_most: f64,
}

impl Events {
    /// Vapour of this volume [m³] for a further `time` [s].
    pub fn see_vapour(&mut self, volume: f64, time: f64) {
        if volume > 0.0 {
            self.vapour_time += time;
            self.vapour_most = self.vapour_most.max(volume);
        }
    }
}

/// The numbers of the coupling.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Grain steps from one exchange between grains and water to the next.
    pub exchange: u64,
    /// Grain steps from one fluid step to the next.
    pub interval: u64,
    /// Lattice steps in each.
    pub sub_steps: u64,
    /// Greatest diffusivity of an interval D_n, in cells².
    pub diffusivity: f64,
    /// Greatest drag of a lattice step σ.
    pub drag: f64,
    /// Cells that undrained sound crosses in an interval.
    pub courant: f64,
    /// Mean porosity of the bed.
    pub porosity: f64,
    /// Mean permeability [m²].
    pub permeability: f64,
    /// Storage S = φβ [1/Pa].
    pub storage: f64,
    /// Stiffness M of the skeleton [Pa], if it was given.
    pub stiffness: Option<f64>,
    /// Skempton's B = 1/(1 + S M): the share of a load that the water takes at once.
    pub skempton: Option<f64>,
    /// Time in which pressure drains from the bed, H²/c_v with c_v = k/(μ (S + 1/M)) [s]; without
    /// M that of a rigid bed.
    pub drainage_time: f64,
    /// Height of the bed [m].
    pub height: f64,
    /// Share of grains that carry less than a hundredth of the mean load.
    pub rattlers: f64,
    /// How far the solid in the cells has drifted from what flowed into them with the mean velocity
    /// of the faces since the water joined: root of the mean square, as a solid fraction; none where
    /// the grains keep no ledger.
    pub drift: Option<f64>,
    /// Times that the lattice was laid anew for a bed that had changed.
    pub relaid: u64,
    /// Time in which there was vapour [s].
    pub vapour_time: f64,
    /// The greatest volume of vapour [m³].
    pub vapour_most: f64,
    /// In open pores, once water has moved: convection of momentum, which is left out, over the
    /// drag, as root mean squares over cells and time.
    pub convection: Option<f64>,
    /// What is wrong with water that is softer than water.
    softness: Option<Softness>,
    /// The lattice; none where pores are open and the water's momentum is solved instead.
    pub lattice: Option<lbm::Scaling>,
}

/// What a report is made from, whoever computes.
pub(crate) struct Numbers<'a> {
    pub model: &'a Model,
    pub lattice: &'a Lattice,
    /// Mean of the bed.
    pub porosity: f64,
    pub steps: Steps,
    pub rattlers: f64,
    pub drift: Option<f64>,
    pub events: &'a Events,
    pub scaling: Option<&'a lbm::Scaling>,
}

impl Report {
    pub(crate) fn of<const N: usize>(water: &Water<N>) -> Self {
        Self::of_numbers(Numbers {
            model: &water.model,
            lattice: &water.lattice,
            porosity: water.porosity(),
            steps: water.steps,
            rattlers: water.loads.rattlers(),
            drift: water.drift.rms(),
            events: &water.events,
            scaling: water.flow.lattice().map(|solver| solver.scaling()),
        })
    }

    pub(crate) fn of_numbers(numbers: Numbers) -> Self {
        let Numbers {
            model,
            lattice,
            porosity,
            ..
        } = numbers;
        let fluid = model.fluid;
        let permeability = fluid.viscosity / model.resistance.at(&fluid, porosity, 0.0);
        let storage = porosity * fluid.compressibility;
        let stiffness = model.stiffness;
        let compliance = storage + stiffness.map_or(0.0, |m| 1.0 / m);
        let height = lattice.height * lattice.cells[2] as f64;
        let events = numbers.events;
        let lattice = numbers.scaling.copied();
        Self {
            exchange: numbers.steps.exchange,
            interval: numbers.steps.interval,
            sub_steps: numbers.steps.sub_steps,
            diffusivity: events.diffusivity,
            drag: lattice.map_or(0.0, |lattice| lattice.drag[1]),
            courant: events.courant,
            porosity,
            permeability,
            storage,
            stiffness,
            skempton: stiffness.map(|m| 1.0 / (1.0 + storage * m)),
            drainage_time: height * height * fluid.viscosity * compliance / permeability,
            height,
            rattlers: numbers.rattlers,
            drift: numbers.drift,
            relaid: events.relaid,
            vapour_time: events.vapour_time,
            vapour_most: events.vapour_most,
            convection: events.convection,
            softness: Softness::of(model, porosity),
            lattice,
        }
    }

    /// Deborah number: drainage time times `rate` of deformation [1/s]. Far above one the bed is
    /// undrained; but far below it need not be drained, since suction is as great as a load σ already
    /// from σ (S + 1/M)/ψ on, ψ the dilation over strain.
    pub fn deborah(&self, rate: f64) -> f64 {
        self.drainage_time * rate
    }

    /// What may be wrong with the numbers.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.interval > self.exchange && self.diffusivity > WARNED {
            warnings.push(format!(
                "pressure diffuses over {:.2} cells² in the {} grain steps between two fluid \
                 steps: above {WARNED} it is off by 10 % and more, above {REFUSED} a run invents \
                 strength",
                self.diffusivity, self.interval
            ));
        }
        warnings.extend(self.softness.and_then(|softness| softness.warning()));
        if let Some(share) = self.convection.filter(|share| *share > CONVECTION) {
            warnings.push(format!(
                "convection of momentum, which open pores leave out, would be {:.0} % of the drag: \
                 wakes and jets of several cells are not right, nor what follows from them",
                100.0 * share
            ));
        }
        if self.vapour_time > 0.0 {
            warnings.push(format!(
                "the water broke for {:.3e} s; at most {:.3e} m³ of vapour opened",
                self.vapour_time, self.vapour_most
            ));
        }
        warnings
    }
}

impl fmt::Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let known = |x: Option<f64>| x.map_or("unknown".to_owned(), |x| format!("{x:.3e}"));
        if self.lattice.is_some() {
            writeln!(
                out,
                "coupling: exchange every {} grain steps, fluid every {} in {} of its own, D_n {:.3}, sigma {:.2}, C {:.2}",
                self.exchange,
                self.interval,
                self.sub_steps,
                self.diffusivity,
                self.drag,
                self.courant
            )?;
        } else {
            writeln!(
                out,
                "coupling: open pores, the water's momentum every grain step"
            )?;
        }
        writeln!(
            out,
            "  bed: porosity {:.3}, permeability {:.2e} m², drained in {:.3e} s, {:.1} % rattlers",
            self.porosity,
            self.permeability,
            self.drainage_time,
            100.0 * self.rattlers
        )?;
        writeln!(
            out,
            "  stiffness M {} Pa, Skempton's B {}",
            known(self.stiffness),
            known(self.skempton)
        )?;
        for warning in self.warnings() {
            writeln!(out, "  warning: {warning}")?;
        }
        match &self.lattice {
            Some(lattice) => write!(out, "  {lattice}"),
            None => write!(
                out,
                "  open pores: momentum of the water, pressure implicit in time"
            ),
        }
    }
}
