//! Grains with water between them, on the CPU.

use crate::output::pores::PoreReading;
use crate::scene::water::pores::Reach;
use anyhow::Result;
use coupling::{Coupled, Error};
use dem::measure::{bed_height, top_wall};
use dem::{Body, StressLoad, WallMotion};
use glam::DVec3;

/// A bed with its water, by how many cells the weights of a grain reach.
pub enum Wet {
    /// Three.
    Three(Coupled<3>),
    /// Five.
    Five(Coupled<5>),
}

macro_rules! of {
    ($wet:expr, $bed:ident => $value:expr) => {
        match $wet {
            Wet::Three($bed) => $value,
            Wet::Five($bed) => $value,
        }
    };
}

impl Wet {
    /// Fill the pores of `state` with water, with the state `before` or at rest, on `threads`
    /// threads (0: one for each core).
    ///
    /// # Errors
    /// Descriptions or states that cannot be right, or stable, or accurate.
    pub fn new(
        reach: Reach,
        grains: dem::Model,
        state: dem::State,
        water: coupling::Model,
        before: Option<&coupling::State>,
        threads: usize,
    ) -> Result<Self, Error> {
        Ok(match reach {
            Reach::Three => Self::Three(Coupled::new(grains, state, water, before, threads)?),
            Reach::Five => Self::Five(Coupled::new(grains, state, water, before, threads)?),
        })
    }

    /// Advance by `steps` grain steps.
    ///
    /// # Errors
    /// Numbers that run away, a bed that has become one that cannot be coupled.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        of!(self, bed => bed.advance(steps))
    }

    /// The grains.
    pub fn grains(&self) -> &dem::Solver {
        of!(self, bed => bed.grains())
    }

    /// The water.
    pub fn reading(&self) -> PoreReading {
        of!(self, bed => PoreReading {
            now: bed.water().snapshot(),
            report: bed.report(),
            ledger: bed.ledger(),
            on_walls: bed.water().on_walls(),
        })
    }

    /// Number of cells along x, y, z.
    pub fn cells(&self) -> [usize; 3] {
        of!(self, bed => bed.water().model().cells)
    }

    /// What must be known of the water to go on.
    pub fn water_state(&self) -> coupling::State {
        of!(self, bed => bed.water().state())
    }

    /// What the numbers of the coupling are.
    pub fn report(&self) -> coupling::Report {
        of!(self, bed => bed.report())
    }
}

/// The load that is added to measure the stiffness, over that which the grains carry.
const MORE: f64 = 0.1;
/// How long it is held, in √(m H/(A M)) of the wall on the bed: `coupling` damps the wall by 40 of
/// its mass in that time, which is critical at 20.
const HELD: f64 = 30.0;

/// Stiffness of the dry skeleton under the load that it carries and a tenth more [Pa]; none where
/// no stress pushes the top wall, or no grain carries it.
///
/// # Errors
/// Numbers that run away.
pub fn stiffness(model: &dem::Model, state: &dem::State) -> Result<Option<f64>, Error> {
    let Some(top) = top_wall(model) else {
        return Ok(None);
    };
    let WallMotion::Stress(load) = model.walls[top].motion else {
        return Ok(None);
    };
    let on_top = state
        .contacts
        .iter()
        .filter(|c| c.j == Body::Wall(top as u32));
    let carried = -on_top.map(|contact| contact.force.z).sum::<f64>() / load.area;
    if carried <= 0.0 {
        return Ok(None);
    }
    let (mut model, mut state) = (model.clone(), state.clone());
    model.drive = None;
    model.ledger = false;
    model.walls[top].motion = WallMotion::Stress(StressLoad {
        mean: carried,
        amplitude: 0.0,
        ..load
    });
    state.grains.velocity.fill(DVec3::ZERO);
    state.grains.angular_velocity.fill(DVec3::ZERO);
    state.walls[top].velocity = 0.0;
    let diameter = 2.0 * state.grains.mean_radius();
    let about = 0.5 * model.law.normal_stiffness() / diameter;
    let height = bed_height(&model, &state);
    let time = HELD * (load.mass * height / (load.area * about)).sqrt();
    let found = coupling::skeleton_stiffness(&model, &state, MORE * carried, time)?;
    Ok((found > 0.0 && found.is_finite()).then_some(found))
}
