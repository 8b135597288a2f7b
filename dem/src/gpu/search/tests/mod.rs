//! What the search promises, on any adapter.

mod bed;
mod check;
mod cost;
mod histories;
mod layout;
mod lists;
mod scan;

use super::*;
use shaders::Choice;
use std::sync::OnceLock;

/// The device, or none: then the test says that it was skipped, and proves nothing.
fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    let device = DEVICE.get_or_init(|| Device::open(Choice::Any).ok());
    if device.is_none() {
        eprintln!("SKIPPED: no graphics adapter, nothing was tested");
    }
    device.as_ref()
}

/// The stages, compiled once.
fn kernels(device: &Device) -> &'static Kernels {
    static KERNELS: OnceLock<Kernels> = OnceLock::new();
    KERNELS.get_or_init(|| Kernels::new(device, true).unwrap())
}

/// Numbers in [0, 1), always the same.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
