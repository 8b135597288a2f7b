//! `esker info`: who could compute here, and who would.

use super::check::line;
use crate::backend::{Backend, FEWEST, Machine, processor};
use anyhow::Result;
use dem::contact::{Linear, Tension};
use dem::{ContactLaw, Domain, Grains, Model, Solver, State};
use glam::DVec3;
use shaders::{Adapter, adapters};
use std::process::ExitCode;

const MIB: u64 = 1 << 20;

/// `esker info`
///
/// # Errors
/// None that a user can cause.
pub fn info() -> Result<ExitCode> {
    let threads = std::thread::available_parallelism()?;
    println!("processor");
    line("  name", &processor());
    line("  threads", &threads.to_string());
    line("  vectors", vectors()?);
    let adapters = adapters();
    if adapters.is_empty() {
        println!(
            "no graphics device: neither Vulkan, Metal nor DirectX 12 shows one; on Linux install \
             the vendor's driver and the Vulkan loader (Debian: libvulkan1)"
        );
    }
    for adapter in &adapters {
        describe(adapter);
    }
    println!("--backend auto takes");
    for (sign, grains) in [("below", FEWEST - 1), ("from", FEWEST)] {
        let text = match Backend::Auto.choose(grains, 0) {
            Ok(chosen) => {
                let machine = match chosen.machine {
                    Machine::Cpu { .. } => "the processor".into(),
                    Machine::Gpu(device) => device.adapter.info.name.clone(),
                };
                format!("{machine}: {}", chosen.why)
            }
            Err(error) => format!("nothing: {error:#}"),
        };
        line(&format!("  {sign} {FEWEST} grains"), &text);
    }
    Ok(ExitCode::SUCCESS)
}

fn describe(adapter: &Adapter) {
    let info = &adapter.info;
    println!("graphics device");
    line("  name", &info.name);
    line("  interface", &info.backend.to_string());
    line(
        "  driver",
        format!("{} {}", info.driver, info.driver_info).trim(),
    );
    let kind = match adapter.is_hardware() {
        true => format!("hardware ({:?})", info.device_type),
        false => "software that plays a device: right, and slow".into(),
    };
    line("  kind", &kind);
    let limits = &adapter.limits;
    line(
        "  largest binding",
        &format!(
            "{} MiB (buffer {} MiB, binding {} MiB); lists of neighbours may take several",
            adapter.largest_binding() / MIB,
            limits.max_buffer_size / MIB,
            limits.max_storage_buffer_binding_size / MIB
        ),
    );
    line(
        "  bindings a kernel",
        &limits.max_storage_buffers_per_shader_stage.to_string(),
    );
}

/// The vector instructions that the solver of the CPU takes here.
fn vectors() -> Result<&'static str> {
    let mut grains = Grains::default();
    grains.add_sphere(DVec3::ONE, 1.0, 1.0);
    let model = Model {
        domain: Domain {
            size: [10.0; 2],
            periodic: [true; 2],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::Linear(Linear {
            normal_stiffness: 1.0,
            normal_damping: 0.0,
            tension: Tension::Clip,
            sliding: None,
            rolling: None,
            twisting: None,
        }),
        walls: Vec::new(),
        drive: None,
        step: 1e-3,
        skin: None,
        ledger: false,
    };
    let state = State {
        grains,
        ..State::default()
    };
    Ok(Solver::new(model, state, 1)?.vectors())
}
