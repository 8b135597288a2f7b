//! The ground floor of the GPU: device, arrays, kernels, recorded dispatches, and the WGSL
//! of all crates under the paths of the Rust that explains them.
//!
//! A kernel is composed from the modules it imports with the flags of the scene
//! ([`compose`]), compiled on a [`Device`], bound to [`Array`]s by the names that the WGSL
//! gives them, and dispatched many times in one [`Recording`]:
//!
//! ```no_run
//! # fn main() -> Result<(), shaders::Error> {
//! let device = shaders::Device::open(shaders::Choice::Any)?;
//! let module = shaders::compose("dem/step.wgsl", &shaders::Flags::new().set("LEDGER"))?;
//! let step = device.kernel(&module, "step")?;
//! let forces = device.array::<[f32; 4]>("forces", 1000)?;
//! let bound = step.bind(&device, &[("forces", &forces)])?;
//! let mut recording = device.record();
//! for tick in 0..32 {
//!     recording.dispatch_at(&bound, tick, shaders::groups(1000, 64));
//! }
//! recording.submit()?;
//! let now = device.read(&forces)?;
//! # Ok(()) }
//! ```

mod adapter;
mod array;
mod device;
mod kernel;
pub mod layout;
mod library;
mod parts;
mod reading;
mod recording;
mod timing;

pub use adapter::{Adapter, Choice, adapters};
pub use array::{Array, Bindable};
pub use device::{Device, Traffic};
pub use kernel::{Bound, Kernel};
pub use library::{Flags, compose, compose_text, files};
pub use naga_oil;
pub use parts::Parts;
pub use reading::{Arrived, Part, Pending, Reading};
pub use recording::{Recording, groups};
pub use wgpu;
pub use wgpu::naga;

/// Why the GPU does not do what it was asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// No adapter of the kind that was asked for.
    #[error("{0}")]
    NoAdapter(String),
    /// An array does not fit.
    #[error("{0}")]
    Memory(String),
    /// The device is gone: driver reset, unplugged, out of memory in the middle.
    #[error("the device was lost: {0}")]
    Lost(String),
    /// WGSL that does not compose or validate, or a name that it does not know.
    #[error("{0}")]
    Shader(String),
}
