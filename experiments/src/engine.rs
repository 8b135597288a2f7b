//! The solver of a run, on whichever machine: all that the rest of the program knows of it.

use crate::backend::{Machine, largest_array};
use anyhow::{Result, ensure};
use dem::gpu::{self, memory::Memory};
use dem::{Error, Model, Snapshot, State};

/// Grains in motion.
pub enum Engine {
    /// On the CPU, in double precision.
    Cpu(Box<dem::Solver>),
    /// On a GPU, in fixed point and single precision.
    Gpu(Box<gpu::Solver>),
}

impl Engine {
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

    /// Advance by `steps` time steps.
    ///
    /// # Errors
    /// Numbers that run away, a device that fails.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        match self {
            Self::Cpu(solver) => solver.advance(steps),
            Self::Gpu(solver) => solver.advance(steps),
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
        }
    }

    /// The description it was made with.
    pub fn model(&self) -> &Model {
        match self {
            Self::Cpu(solver) => solver.model(),
            Self::Gpu(solver) => solver.model(),
        }
    }

    /// Memory in use for the grains, on the device where there is one [bytes].
    pub fn memory(&self) -> u64 {
        match self {
            Self::Cpu(solver) => solver.memory() as u64,
            Self::Gpu(solver) => solver.memory(),
        }
    }
}

/// What to say where `grains` do not fit on `adapter`.
fn too_little(grains: usize, memory: &Memory, adapter: &shaders::Adapter) -> String {
    format!(
        "{grains} grains take about {:.1} GiB on the GPU, {:.0} MiB of it in one array. {} holds \
         at most {:.0} MiB in one array, enough for about {} grains. Use fewer, or the CPU with \
         --backend cpu",
        (memory.bytes + memory.reading) as f64 / GIB,
        memory.largest as f64 / MIB,
        adapter.info.name,
        largest_array(adapter) as f64 / MIB,
        memory.most_grains(grains, largest_array(adapter)),
    )
}

const MIB: f64 = 1_048_576.0;
const GIB: f64 = 1024.0 * MIB;
