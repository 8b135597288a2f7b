//! What the neighbour search promises.

mod bed;
mod check;
mod cost;
mod histories;
mod lists;
mod scan;

use crate::lab::Suite;
use dem::gpu::control::Control;
use dem::gpu::search::plan::{Grid, Plan};
use dem::gpu::search::{Arrays, Kernels, Search, Setting};
use shaders::{Array, Bindable, Bound, Device, Flags, compose, groups};
use std::sync::OnceLock;

pub fn list(suite: &mut Suite) {
    check::list(suite);
    cost::list(suite);
    histories::list(suite);
    lists::list(suite);
    scan::list(suite);
}

/// The stages, compiled once for arrays in one part.
fn kernels(device: &Device) -> Kernels {
    static KERNELS: OnceLock<Kernels> = OnceLock::new();
    let kernels = KERNELS.get_or_init(|| Kernels::new(device, true).unwrap());
    kernels.clone()
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
