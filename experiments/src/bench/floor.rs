//! What no step on a device can undercut: the start of a dispatch, and the way of its bytes
//! through the memory.

use anyhow::Result;
use shaders::{Device, Flags, compose_text};
use std::time::Instant;

/// Speeds of a device that bound every kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// Time of a dispatch that does next to nothing, in a row of such, each after the writes of
    /// the one before [s].
    pub dispatch: f64,
    /// Bytes read and written a second when an array is copied.
    pub bandwidth: f64,
}

/// A dispatch that waits for the one before.
const COUNTER: &str = "
@group(0) @binding(0) var<storage, read_write> counter: array<u32>;
@compute @workgroup_size(1)
fn count() { counter[0] += 1u; }
";
/// Dispatches in the row.
const ROW: u32 = 2000;
/// Copies on the clock.
const COPIES: u32 = 20;

impl Floor {
    /// Measure `device`: the best of a few tries each.
    ///
    /// # Errors
    /// A device that fails.
    pub fn measure(device: &Device) -> Result<Self> {
        let kernel = device.kernel(&compose_text("counter", COUNTER, &Flags::new())?, "count")?;
        let counter = device.array::<u32>("counter", 1)?;
        let bound = kernel.bind(device, &[("counter", &counter)])?;
        let dispatch = best(|| {
            let mut recording = device.record();
            for _ in 0..ROW {
                recording.dispatch(&bound, [1, 1, 1]);
            }
            device.wait()?;
            let clock = Instant::now();
            recording.submit()?;
            device.wait()?;
            Ok(clock.elapsed().as_secs_f64() / f64::from(ROW))
        })?;

        // Far beyond the caches of a large GPU; software has no memory of its own to measure.
        let wanted = match device.adapter.is_hardware() {
            true => 1 << 29,
            false => 1 << 26,
        };
        let bytes = device.adapter.largest_binding().min(wanted) as usize;
        let from = device.array::<u32>("from", bytes / 4)?;
        let to = device.array::<u32>("to", bytes / 4)?;
        let copy = best(|| {
            let mut recording = device.record();
            for _ in 0..COPIES {
                recording.copy(&from, 0, &to, 0, bytes / 4);
            }
            device.wait()?;
            let clock = Instant::now();
            recording.submit()?;
            device.wait()?;
            Ok(clock.elapsed().as_secs_f64() / f64::from(COPIES))
        })?;
        Ok(Self {
            dispatch,
            bandwidth: 2.0 * bytes as f64 / copy,
        })
    }
}

fn best(mut time: impl FnMut() -> Result<f64>) -> Result<f64> {
    let mut least = f64::INFINITY;
    for _ in 0..4 {
        least = least.min(time()?);
    }
    Ok(least)
}
