//! What a scene needs on a device: grid of positions, units of sums, parts, sizes.

use super::arrays::Parts;
use super::fixed::Grid;
use super::loading::Units;
use super::scene::{Slots, spread};
use super::search::Setting;
use super::steps::THREADS;
use crate::{Drive, Error, Horizontal, Model, State, Surface};
use shaders::{Device, Flags};

/// First surplus of the neighbour search, in mean radii.
const SKIN: f64 = 0.02;
/// Bounds of the adapted skin, in mean radii.
const SKIN_RANGE: [f64; 2] = [0.005, 0.5];
/// Steps between searches that the adapted skin aims at.
const SEARCH_EVERY: f32 = 1000.0;
/// Entries of the lists for each grain at first, and those of them that touch; they grow where
/// that is too few.
const ENTRIES: usize = 12;
const TOUCHING: usize = 7;
/// Threads that keep a large GPU busy.
const BUSY: usize = 200_000;
/// Threads that may share a grain.
const LANES: [u32; 4] = [1, 2, 4, 8];

/// Threads that share each of `n` grains on `device`: few grains would leave hardware idle, and
/// a longer list hides the latency of memory; software has no use for more threads.
pub(super) fn lanes(device: &Device, n: usize) -> u32 {
    let wanted = match device.adapter.is_hardware() {
        true => (BUSY / n.max(1)) as u32,
        false => 1,
    };
    let enough = LANES.into_iter().rev().find(|&lanes| lanes <= wanted);
    enough.unwrap_or(1)
}

/// The numbers of a scene.
#[derive(Clone, Debug)]
pub(super) struct Numbers {
    pub grid: Grid,
    pub units: Units,
    pub parts: Parts,
    pub slots: Slots,
    /// Mass of the driven layer [kg].
    pub driven_mass: f64,
    /// Threads that share a grain.
    pub lanes: u32,
    /// First skin [m].
    pub skin: f64,
    /// Speed of a grain that has run away: half the smallest radius a step [m/s].
    pub limit: f64,
    /// Room for entries of the lists, and for those that touch, at first.
    pub entries: usize,
    pub touching: usize,
    mean_radius: f64,
    largest_radius: f64,
}

impl Numbers {
    /// Those of `model` and `state` with `lanes` threads a grain, and a companion that keeps so many
    /// vectors a grain, if there is one.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the numbers of the GPU cannot hold the scene.
    pub fn of(
        model: &Model,
        state: &State,
        lanes: u32,
        companion: Option<usize>,
    ) -> Result<Self, Error> {
        if !LANES.contains(&lanes) {
            let what = format!("{lanes} threads a grain; it may be one of {LANES:?}");
            return Err(Error::Invalid(what));
        }
        let grains = &state.grains;
        let n = grains.len();
        let mean_radius = grains.mean_radius();
        let largest_radius = grains.radius.iter().copied().fold(0.0, f64::max);
        let smallest_radius = grains.radius.iter().copied().fold(f64::INFINITY, f64::min);
        let skin = model.skin.unwrap_or(SKIN * mean_radius);
        let reach = 2.0 * largest_radius + skin.max(SKIN_RANGE[1] * mean_radius);
        let driven = |k: &usize| grains.constraint[*k].horizontal == Horizontal::Driven;
        let full = model.walls.iter().any(|wall| wall.surface == Surface::Full);
        let parts = Parts {
            grains: n,
            walls: model.walls.len(),
            slides: model.law.slides(),
            turns: model.law.turns(),
            ledger: model.ledger,
            full_walls: full && model.law.slides(),
            shear_stress: matches!(model.drive, Some(Drive::ShearStress(_))),
            companion,
        };
        Ok(Self {
            grid: Grid::new(&model.domain, extent(model, state), reach)?,
            units: Units::of(model, mean_radius),
            parts,
            slots: Slots {
                walls: parts.walls,
                spread: spread(n),
                companion: companion.is_some(),
            },
            driven_mass: (0..n).filter(driven).map(|k| grains.mass[k]).sum(),
            lanes,
            skin,
            limit: 0.5 * smallest_radius / model.step,
            entries: (ENTRIES * n).max(2 * state.contacts.len()) + 64,
            touching: (TOUCHING * n).max(2 * state.contacts.len()) + 64,
            mean_radius,
            largest_radius,
        })
    }

    /// What the scene compiles in.
    pub fn flags(&self, model: &Model) -> Flags {
        flags(model, &self.parts, self.lanes)
    }

    /// What the neighbour search must know.
    pub fn setting(&self, model: &Model) -> Setting {
        let unit = self.grid.unit;
        Setting {
            count: self.parts.grains,
            lengths: [self.grid.length.x, self.grid.length.y],
            diameter: (2.0 * self.mean_radius / unit) as i32,
            largest: (self.largest_radius / unit).ceil() as i32,
            unit: unit as f32,
            step: model.step as f32,
            skins: match model.skin {
                Some(skin) => [skin as f32; 2],
                None => SKIN_RANGE.map(|skin| (skin * self.mean_radius) as f32),
            },
            every: SEARCH_EVERY,
        }
    }
}

/// What a scene of `parts` compiles in.
pub(super) fn flags(model: &Model, parts: &Parts, lanes: u32) -> Flags {
    let walls = parts.walls as u32;
    super::law::flags(&model.law, model.ledger)
        .set_if("FULL_WALLS", parts.full_walls)
        .set_if("SHEAR_STRESS", parts.shear_stress)
        .set_if("APART", parts.shear_stress)
        .set_if("SHARED_GRAINS", lanes > 1)
        .set_if("COMPANION", parts.companion.is_some())
        .number("LANES", lanes)
        .number("PARTIALS", if lanes > 1 { THREADS } else { 1 })
        .number("SPREAD", spread(parts.grains) as u32)
        .number("WALLS", walls)
        .number("BODIES", walls + 1)
        .number("GATHERED_WORDS", 2 * (walls + 6))
}

/// Coordinates stay below this [m]: grains that settle go no farther than they are.
fn extent(model: &Model, state: &State) -> f64 {
    let each = state.grains.position.iter().map(|x| x.abs().max_element());
    let offsets = state.walls.iter().map(|wall| wall.offset.abs());
    let sides = model.domain.size;
    2.0 * each.chain(offsets).chain(sides).fold(0.0, f64::max)
}
