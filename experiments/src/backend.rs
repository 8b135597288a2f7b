//! Who computes a scene: the CPU or a GPU. The choice, and its reasons.

use crate::scene::Scene;
use crate::scene::water::Precision;
use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use shaders::{Adapter, Choice, Device, adapters};
use sysinfo::{CpuRefreshKind, RefreshKind, System};

/// What a user asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// Graphics hardware if there is any and the bed is large enough for it, else the CPU
    #[default]
    Auto,
    /// The processor
    Cpu,
    /// The best graphics device, software that plays one included
    Gpu,
}

/// Grains from which on [`Backend::Auto`] takes a GPU. A step of theirs takes at least as long
/// as it takes to start it, some 10 us; that is what a few threads of a CPU need for a step of a
/// thousand grains.
pub const FEWEST: usize = 1000;

/// Cells of water from which on [`Backend::Auto`] takes a GPU: what a few threads step in some
/// 100 us, several times what it takes to start a step on a GPU.
pub const FEWEST_CELLS: usize = 20_000;

/// Who computes.
#[derive(Clone, Debug)]
pub enum Machine {
    /// This many threads.
    Cpu {
        /// 1 or more.
        threads: usize,
    },
    /// An open device.
    Gpu(Device),
}

/// A machine, and why it was chosen.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// Who computes.
    pub machine: Machine,
    /// The reason, as the end of a sentence.
    pub why: String,
}

impl Backend {
    /// The machine for `scene`; `threads` of the CPU, 0: one for each core.
    ///
    /// # Errors
    /// A GPU that is asked for and is not there, or does not open: never another machine
    /// instead.
    pub fn choose_for(self, scene: &Scene, threads: usize) -> Result<Chosen> {
        match (&scene.water, self) {
            (Some(_), Self::Auto) => {
                let mut chosen = Self::Cpu.choose(scene.start.grains.len(), threads)?;
                chosen.why =
                    "with water between the grains a GPU is taken where --backend gpu asks \
                              for it: how fast it is has not been measured"
                        .into();
                Ok(chosen)
            }
            _ => self.choose(scene.start.grains.len(), threads),
        }
    }

    /// The machine for a bed of `grains`; `threads` of the CPU, 0: one for each core.
    ///
    /// # Errors
    /// A GPU that is asked for and is not there, or does not open: never another machine
    /// instead.
    pub fn choose(self, grains: usize, threads: usize) -> Result<Chosen> {
        let few = (grains < FEWEST)
            .then(|| format!("fewer than {FEWEST} grains are faster here than on a GPU"));
        self.take(few, &format!("{FEWEST} grains or more"), threads)
    }

    /// The machine for water in so many `cells`; `threads` of the CPU, 0: one for each core.
    ///
    /// # Errors
    /// As [`choose`](Self::choose), and double precision that is asked of a GPU.
    pub fn choose_for_water(
        self,
        cells: usize,
        precision: Precision,
        threads: usize,
    ) -> Result<Chosen> {
        let double = precision == Precision::F64;
        ensure!(
            self != Self::Gpu || !double,
            "--backend gpu: the scene asks for f64, and a GPU computes water in f32; write \
             water.precision = \"f32\" (--set water.precision=f32), or --backend cpu"
        );
        let few = match double {
            true => Some("the scene asks for water in f64, which a GPU has not".into()),
            false => (cells < FEWEST_CELLS)
                .then(|| format!("fewer than {FEWEST_CELLS} cells are faster here than on a GPU")),
        };
        self.take(
            few,
            &format!("{FEWEST_CELLS} cells or more, in f32"),
            threads,
        )
    }

    /// The machine where the CPU is better because of what is `few`, if it is, and a GPU where
    /// there is `enough`.
    fn take(self, few: Option<String>, enough: &str, threads: usize) -> Result<Chosen> {
        let cpu = |why: &str| Chosen {
            machine: Machine::Cpu {
                threads: match threads {
                    0 => std::thread::available_parallelism().map_or(1, Into::into),
                    _ => threads,
                },
            },
            why: why.into(),
        };
        match self {
            Self::Cpu => Ok(cpu("as asked for")),
            Self::Gpu => {
                let device = Device::open(Choice::Any)
                    .context("--backend gpu: cannot compute on a GPU here")?;
                let why = match device.adapter.is_hardware() {
                    true => "as asked for",
                    false => "as asked for; this is software that plays a GPU, for tests: slow",
                };
                Ok(Chosen {
                    machine: Machine::Gpu(device),
                    why: why.into(),
                })
            }
            Self::Auto => {
                let Some(adapter) = adapters().into_iter().find(Adapter::is_hardware) else {
                    return Ok(cpu("no graphics hardware here"));
                };
                if let Some(few) = few {
                    return Ok(cpu(&few));
                }
                let device = Device::open_adapter(adapter)
                    .context("use the CPU with --backend cpu; the GPU does not open")?;
                Ok(Chosen {
                    machine: Machine::Gpu(device),
                    why: format!("graphics hardware, and {enough}"),
                })
            }
        }
    }
}

impl Machine {
    /// `cpu` or `gpu`.
    pub fn backend(&self) -> &'static str {
        match self {
            Self::Cpu { .. } => "cpu",
            Self::Gpu(_) => "gpu",
        }
    }

    /// Name of the processor with its threads, or of the graphics device with its driver.
    pub fn describe(&self) -> String {
        match self {
            Self::Cpu { threads: 1 } => format!("{}, 1 thread", processor()),
            Self::Cpu { threads } => format!("{}, {threads} threads", processor()),
            Self::Gpu(device) => device.adapter.describe(),
        }
    }
}

/// Name of the processor, or its architecture where the system does not tell.
pub fn processor() -> String {
    let wanted = RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing());
    let system = System::new_with_specifics(wanted).ok();
    let brand = system.and_then(|s| s.cpus().first().map(|cpu| cpu.brand().trim().to_owned()));
    brand
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| std::env::consts::ARCH.into())
}
