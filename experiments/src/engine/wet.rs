//! Grains with water between them, on the CPU or a GPU.

use crate::backend::Machine;
use crate::output::pores::PoreReading;
use crate::scene::water::pores::Reach;
use anyhow::Result;
use coupling::{Coupled, Error, gpu};
use dem::measure::{bed_height, top_wall};
use dem::{Body, StressLoad, WallMotion};
use glam::DVec3;
use lbm::Side;

/// A bed with its water, by how many cells the weights of a grain reach, and by who computes.
pub enum Wet {
    /// Three.
    Three(Coupled<3>),
    /// Five.
    Five(Coupled<5>),
    /// Three, on a GPU.
    ThreeOnGpu(gpu::Coupled<3>),
    /// Five, on a GPU.
    FiveOnGpu(gpu::Coupled<5>),
}

/// `$cpu` of a bed on the CPU, `$gpu` of one on a GPU.
macro_rules! of {
    ($wet:expr, $bed:ident => $cpu:expr, $gpu:expr) => {
        match $wet {
            Wet::Three($bed) => $cpu,
            Wet::Five($bed) => $cpu,
            Wet::ThreeOnGpu($bed) => $gpu,
            Wet::FiveOnGpu($bed) => $gpu,
        }
    };
}

impl Wet {
    /// Fill the pores of `state` with water, with the state `before` or at rest, on `machine`.
    ///
    /// # Errors
    /// Descriptions or states that cannot be right, or stable, or accurate, or not on this machine.
    pub fn new(
        machine: &Machine,
        reach: Reach,
        grains: dem::Model,
        state: dem::State,
        water: coupling::Model,
        before: Option<&coupling::State>,
    ) -> Result<Self, Error> {
        Ok(match (machine, reach) {
            (&Machine::Cpu { threads }, Reach::Three) => {
                Self::Three(Coupled::new(grains, state, water, before, threads)?)
            }
            (&Machine::Cpu { threads }, Reach::Five) => {
                Self::Five(Coupled::new(grains, state, water, before, threads)?)
            }
            (Machine::Gpu(device), Reach::Three) => {
                Self::ThreeOnGpu(gpu::Coupled::new(device, grains, state, water, before)?)
            }
            (Machine::Gpu(device), Reach::Five) => {
                Self::FiveOnGpu(gpu::Coupled::new(device, grains, state, water, before)?)
            }
        })
    }

    /// Advance by `steps` grain steps.
    ///
    /// # Errors
    /// Numbers that run away, a bed that has become one that cannot be coupled, a device that fails.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        of!(self, bed => bed.advance(steps), bed.advance(steps))
    }

    /// The description of the grains.
    pub fn model(&self) -> &dem::Model {
        of!(self, bed => bed.grains().model(), bed.grains().model())
    }

    /// The grains now.
    ///
    /// # Errors
    /// A device that fails.
    pub fn snapshot(&self) -> Result<dem::Snapshot, dem::Error> {
        of!(self, bed => Ok(bed.grains().snapshot()), bed.grains().snapshot())
    }

    /// Memory in use, on the device where there is one [bytes].
    pub fn memory(&self) -> u64 {
        of!(
            self,
            bed => bed.grains().memory() as u64,
            bed.grains().memory() + bed.memory()
        )
    }

    /// The water.
    ///
    /// # Errors
    /// A device that fails.
    pub fn reading(&self) -> Result<PoreReading, Error> {
        of!(
            self,
            bed => Ok(PoreReading {
                now: bed.snapshot(),
                report: bed.report(),
                ledger: bed.ledger(),
                on_walls: bed.water().on_walls(),
                prescribed: prescribed(bed.water().model(), bed.grains().bed().time),
                left: bed.water().left(),
            }),
            {
                let (now, report, ledger) = bed.read()?;
                Ok(PoreReading {
                    on_walls: bed.on_walls()?,
                    prescribed: prescribed(bed.model(), bed.time()),
                    left: bed.left(&now)?,
                    now,
                    report,
                    ledger,
                })
            }
        )
    }

    /// Number of cells along x, y, z.
    pub fn cells(&self) -> [usize; 3] {
        of!(self, bed => bed.water().model().cells, bed.model().cells)
    }

    /// What must be known of the water to go on, on any machine.
    ///
    /// # Errors
    /// A device that fails.
    pub fn water_state(&self) -> Result<coupling::State, Error> {
        of!(self, bed => Ok(bed.state()), bed.state())
    }

    /// What the numbers of the coupling are.
    ///
    /// # Errors
    /// A device that fails.
    pub fn report(&self) -> Result<coupling::Report, Error> {
        of!(self, bed => Ok(bed.report()), Ok(bed.read()?.1))
    }
}

/// Pressures at the bottom and the top, where they are prescribed [Pa].
fn prescribed(water: &coupling::Model, time: f64) -> [Option<f64>; 2] {
    water.sides.each_ref().map(|side| match side {
        Side::Pressure(signal) => Some(signal.at(time)),
        _ => None,
    })
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
