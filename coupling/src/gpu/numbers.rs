//! What the kernels know of a bed and its water. Twin: shaders/coupling/numbers.wgsl.

use crate::choice::Steps;
use crate::drag::Law;
use crate::faces::DRAG_EVERY;
use crate::lattice::Lattice;
use crate::{Model, NormalStress};
use bytemuck::{Pod, Zeroable};
use dem::gpu::fixed::Grid;
use dem::gpu::wide::Wide;
use lbm::{Extremes, Scaling, Side};
use shaders::Flags;

/// What never changes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct Numbers {
    pub cells: [u32; 3],
    pub count: u32,
    pub lengths: [u32; 2],
    pub grains: u32,
    pub unit: f32,
    pub step: f32,
    pub spacing: f32,
    pub compressibility: f32,
    pub viscosity: f32,
    pub density: f32,
    pub gravity: f32,
    pub solid_density: f32,
    pub loose: f32,
    pub cavitation: f32,
    pub flow: [f32; 3],
    pub walls: [u32; 2],
    pub shares: [f32; 2],
}

/// What follows from the lattice of the water, and when weights are renewed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct Course {
    pub storage_unit: f32,
    pub drag_unit: f32,
    pub speed: f32,
    pub source_unit: f32,
    pub renew_at: u32,
    pub memory: f32,
    pub stretch: f32,
    pub passed: f32,
    pub exchange: u32,
    pub drag_every: u32,
    pub share: f32,
    pub towed: f32,
}

/// Of the bed at the last renewal.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct Span {
    pub bottom: Wide,
    pub height: f32,
    pub bed: i32,
    pub mean_load: f32,
    pub half: f32,
    pub unused: [u32; 2],
}

/// Words of the extremes of the bed: bits of least and greatest porosity, permeability and
/// mobility, whether a cell holds too little water, and vapour in cells, hi and lo.
pub(super) const EXTREMES: usize = 9;

impl Numbers {
    pub fn new(
        model: &Model,
        grains: &dem::Model,
        state: &dem::State,
        grid: &Grid,
        (lattice, walls): (&Lattice, [usize; 2]),
    ) -> Self {
        // The solvers refuse more cells and grains than there are u32.
        let fluid = &model.fluid;
        let (volume, mass) = solid(state);
        let law = model.resistance.law();
        Self {
            cells: lattice.cells.map(|n| n as u32),
            count: lattice.count() as u32,
            lengths: [grid.length.x as u32, grid.length.y as u32],
            grains: state.grains.len() as u32,
            unit: grid.unit as f32,
            step: grains.step as f32,
            spacing: lattice.spacing as f32,
            compressibility: fluid.compressibility as f32,
            viscosity: fluid.viscosity as f32,
            density: fluid.density as f32,
            gravity: grains.gravity.z as f32,
            solid_density: (mass / volume) as f32,
            loose: model.loose as f32,
            cavitation: model.cavitation.map_or(0.0, |c| c.pressure as f32),
            flow: law.numbers().map(|x| x as f32),
            walls: walls.map(|k| k as u32),
            shares: [0, 1].map(|side| match (model.normal_stress, &model.sides[side]) {
                (NormalStress::Total, _) | (_, Side::Pressure(_)) => 1.0,
                (NormalStress::Effective, _) => 0.0,
            }),
        }
    }
}

/// Volume [m³] and mass [kg] of all grains.
pub(super) fn solid(state: &dem::State) -> (f64, f64) {
    let grains = &state.grains;
    let volume = (0..grains.len()).map(|k| grains.volume(k)).sum();
    (volume, grains.mass.iter().sum())
}

impl Course {
    /// For a lattice that makes such `steps` of grains with steps of `step` [s], in cells `stretch`
    /// spacings high; loose grains get so much of their drag.
    pub fn new(scaling: &Scaling, steps: &Steps, step: f64, stretch: f64, towed: f64) -> Self {
        let sub_steps = steps.sub_steps as f64;
        Self {
            storage_unit: (scaling.compressibility * scaling.pressure_unit()) as f32,
            drag_unit: (0.5 * scaling.viscosity * scaling.step / scaling.density) as f32,
            speed: (scaling.spacing / scaling.step) as f32,
            source_unit: (1.0 / (scaling.spacing.powi(3) * sub_steps)) as f32,
            renew_at: 0,
            memory: 0.0,
            stretch: stretch as f32,
            passed: (steps.interval as f64 * step) as f32,
            exchange: steps.exchange as u32,
            drag_every: drags_every(steps) as u32,
            share: (1.0 / steps.exchange as f64) as f32,
            towed: towed as f32,
        }
    }

    /// Before there is a lattice: fluxes are in m/s, and grains exchange in every step.
    pub fn before(towed: f64) -> Self {
        Self {
            towed: towed as f32,
            speed: 1.0,
            stretch: 1.0,
            exchange: 1,
            drag_every: DRAG_EVERY as u32,
            share: 1.0,
            ..Self::default()
        }
    }
}

/// Extremes from their words, for a bed of this mean porosity.
pub(super) fn extremes(words: &[u32], mean_porosity: f64) -> Extremes {
    let pair = |k: usize| [words[2 * k], words[2 * k + 1]].map(|bits| f32::from_bits(bits).into());
    Extremes {
        porosity: pair(0),
        mean_porosity,
        permeability: pair(1),
        mobility: pair(2),
        free_cells: false,
    }
}

/// Grain steps from one drag of loose grains to the next.
pub(super) fn drags_every(steps: &Steps) -> u64 {
    steps.exchange.max(DRAG_EVERY)
}

/// Is a pressure prescribed at both walls?
pub(super) fn both_open(model: &Model) -> bool {
    let open = |side: &Side| matches!(side, Side::Pressure(_));
    model.sides.iter().all(open)
}

/// What a bed compiles in.
pub(super) fn flags(model: &Model, reach: usize) -> Flags {
    Flags::new()
        .set_if("WIDE", reach > 3)
        .set_if("CAVITATION", model.cavitation.is_some())
        .set_if("THROUGH", both_open(model))
        .set_if("UNPREDICTED", !model.predicts)
        .set_if(
            "POROSITY",
            matches!(model.resistance.law(), Law::Porosity(_)),
        )
        .set_if("ERGUN", matches!(model.resistance.law(), Law::Ergun(_)))
        .set_if(
            "DI_FELICE",
            matches!(model.resistance.law(), Law::DiFelice(_)),
        )
}
