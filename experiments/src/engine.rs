//! The solver of a run, on whichever machine: all that the rest of the program knows of it.

mod ahead;
mod wet;

pub use ahead::see_water;
pub use wet::{Wet, stiffness};

use crate::backend::Machine;
use crate::output::pores::PoreReading;
use crate::protocol::Past;
use crate::scene::{Phase, Pores, Scene};
use anyhow::{Result, ensure};
use dem::gpu::{
    self,
    memory::{Bounds, Memory},
};
use dem::{Error, Model, Snapshot, State};

/// Grains in motion.
pub enum Engine {
    /// On the CPU, in double precision.
    Cpu(Box<dem::Solver>),
    /// On a GPU, in fixed point and single precision.
    Gpu(Box<gpu::Solver>),
    /// With water between them, on either.
    Wet(Box<Wet>),
}

impl Engine {
    /// The solver of `phase`: with water only where there is some, as it was in the `past`. A
    /// skeleton so stiff [Pa], if that is known.
    ///
    /// # Errors
    /// What cannot be computed, or not on this machine, with the remedy.
    pub fn of_phase(
        scene: &Scene,
        phase: &Phase,
        machine: &Machine,
        model: Model,
        state: State,
        past: &Past,
        stiffness: Option<f64>,
    ) -> Result<Self> {
        let (Some(pores), Some(edges)) = (&scene.water, &phase.water) else {
            return Self::new(machine, model, state);
        };
        let water = pores.model(edges, stiffness);
        let before = past.water.as_ref().map(|past| &past.state);
        Self::wet(machine, model, state, pores, water, before)
    }

    /// Take over `state` under `model`. Periodic lengths are whole units of the GPU's positions
    /// ([`crate::scene::whole`]), or the GPU refuses.
    ///
    /// # Errors
    /// What cannot be computed, or not on this machine, with the remedy.
    pub fn new(machine: &Machine, model: Model, state: State) -> Result<Self> {
        match machine {
            Machine::Cpu { threads } => Ok(Self::Cpu(Box::new(dem::Solver::new(
                model, state, *threads,
            )?))),
            Machine::Gpu(device) => {
                let domain = model.domain;
                let (grains, memory) = (state.grains.len(), Memory::of(&model, &state)?);
                // Said before anything is allocated, where it is known.
                let most = memory.most_grains(grains, Bounds::of(&device.adapter));
                ensure!(
                    grains as u64 <= most,
                    too_little(grains, &memory, &device.adapter)
                );
                let solver = gpu::Solver::new(device, model, state);
                let solver = solver.map_err(|error| match error {
                    Error::Device(shaders::Error::Memory(_)) => anyhow::Error::new(error)
                        .context(too_little(grains, &memory, &device.adapter)),
                    other => other.into(),
                })?;
                let own = solver.model().domain;
                ensure!(
                    own == domain,
                    "the box of {:?} m does not have whole units of the GPU's positions, {:?} m: \
                     it was made for a much lower bed; use the CPU with --backend cpu",
                    domain.size,
                    own.size
                );
                Ok(Self::Gpu(Box::new(solver)))
            }
        }
    }

    /// Take over `state` under `model`, its pores filled with `water` in the state `before` or at
    /// rest.
    ///
    /// # Errors
    /// What cannot be computed, or not on this machine, with the remedy.
    pub fn wet(
        machine: &Machine,
        model: Model,
        state: State,
        pores: &Pores,
        water: coupling::Model,
        before: Option<&coupling::State>,
    ) -> Result<Self> {
        let wet = Wet::new(machine, pores.reach, model, state, water, before)?;
        Ok(Self::Wet(Box::new(wet)))
    }

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// Numbers that run away, a device that fails, a bed that water cannot be in any more.
    pub fn advance(&mut self, steps: u64) -> Result<()> {
        match self {
            Self::Cpu(solver) => solver.advance(steps)?,
            Self::Gpu(solver) => solver.advance(steps)?,
            Self::Wet(bed) => bed.advance(steps)?,
        }
        Ok(())
    }

    /// The water between the grains, if there is any.
    ///
    /// # Errors
    /// A device that fails.
    pub fn water(&self) -> Result<Option<PoreReading>> {
        match self {
            Self::Wet(bed) => Ok(Some(bed.reading()?)),
            Self::Cpu(_) | Self::Gpu(_) => Ok(None),
        }
    }

    /// Everything that can be read now.
    ///
    /// # Errors
    /// A device that fails.
    pub fn snapshot(&self) -> Result<Snapshot, Error> {
        match self {
            Self::Cpu(solver) => Ok(solver.snapshot()),
            Self::Gpu(solver) => solver.snapshot(),
            Self::Wet(bed) => bed.snapshot(),
        }
    }

    /// The description it was made with.
    pub fn model(&self) -> &Model {
        match self {
            Self::Cpu(solver) => solver.model(),
            Self::Gpu(solver) => solver.model(),
            Self::Wet(bed) => bed.model(),
        }
    }

    /// Memory in use for the grains, on the device where there is one [bytes].
    pub fn memory(&self) -> u64 {
        match self {
            Self::Cpu(solver) => solver.memory() as u64,
            Self::Gpu(solver) => solver.memory(),
            Self::Wet(bed) => bed.memory(),
        }
    }
}

/// What to say where `grains` do not fit on `adapter`.
fn too_little(grains: usize, memory: &Memory, adapter: &shaders::Adapter) -> String {
    let bounds = Bounds::of(adapter);
    format!(
        "{grains} grains take about {:.1} GiB on the GPU, {:.0} MiB of it in one binding. {} holds \
         at most {:.0} MiB in one binding and {} bindings, enough for about {} grains where there \
         is memory for them. Use fewer, or the CPU with --backend cpu",
        (memory.bytes + memory.reading) as f64 / GIB,
        memory.largest as f64 / MIB,
        adapter.info.name,
        bounds.binding as f64 / MIB,
        bounds.arrays,
        memory.most_grains(grains, bounds),
    )
}

const MIB: f64 = 1_048_576.0;
const GIB: f64 = 1024.0 * MIB;
