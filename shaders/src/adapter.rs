//! The devices of this machine, and which one is taken.

use crate::Error;
use wgpu::{Backends, DeviceType, Instance, InstanceDescriptor, InstanceFlags};

/// Which adapter to open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// Real hardware, or none.
    Hardware,
    /// Real hardware, or else a software rasteriser (lavapipe): for tests.
    Any,
}

/// An adapter of this machine.
#[derive(Clone, Debug)]
pub struct Adapter {
    pub(crate) adapter: wgpu::Adapter,
    /// Name, driver and interface.
    pub info: wgpu::AdapterInfo,
    /// What it can do at most.
    pub limits: wgpu::Limits,
}

impl Adapter {
    /// Is it hardware, and not a program that plays one?
    pub fn is_hardware(&self) -> bool {
        matches!(
            self.info.device_type,
            DeviceType::DiscreteGpu | DeviceType::IntegratedGpu | DeviceType::VirtualGpu
        )
    }

    /// The most that a kernel sees of an array through one binding [bytes].
    pub fn largest_binding(&self) -> u64 {
        let limits = &self.limits;
        limits
            .max_buffer_size
            .min(limits.max_storage_buffer_binding_size)
    }

    /// Name, interface and driver in one line.
    pub fn describe(&self) -> String {
        let info = &self.info;
        let driver = format!("{} {}", info.driver, info.driver_info);
        format!("{} ({}, {})", info.name, info.backend, driver.trim())
    }
}

/// All adapters, the best first: discrete, integrated, virtual, then software.
///
/// Empty where there is no graphics driver at all.
pub fn adapters() -> Vec<Adapter> {
    // Sizes of indirect dispatches are written by our own kernels, which bound them, and the check
    // costs a dispatch for each. But DirectX 12 tells kernels no number of workgroups without it.
    let unchecked = match cfg!(windows) {
        true => InstanceFlags::empty(),
        false => InstanceFlags::VALIDATION_INDIRECT_CALL,
    };
    let instance = Instance::new(InstanceDescriptor {
        backends: Backends::VULKAN | Backends::METAL | Backends::DX12,
        flags: InstanceFlags::from_build_config() - unchecked,
        ..InstanceDescriptor::new_without_display_handle()
    });
    let all = pollster::block_on(instance.enumerate_adapters(Backends::all()));
    let mut adapters: Vec<Adapter> = all
        .into_iter()
        .map(|adapter| Adapter {
            info: adapter.get_info(),
            limits: adapter.limits(),
            adapter,
        })
        .collect();
    adapters.sort_by_key(|adapter| match adapter.info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    });
    adapters
}

impl Choice {
    /// The best adapter of the kind.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] that says what is there.
    pub fn pick(self) -> Result<Adapter, Error> {
        let mut all = adapters();
        let wanted = |adapter: &Adapter| self == Self::Any || adapter.is_hardware();
        match all.iter().position(wanted) {
            Some(best) => Ok(all.swap_remove(best)),
            None if all.is_empty() => Err(Error::NoAdapter(
                "no graphics device: neither Vulkan, Metal nor DirectX 12 shows one. On Linux \
                 install the vendor's driver and the Vulkan loader (Debian: libvulkan1)"
                    .into(),
            )),
            None => {
                let names: Vec<String> = all.iter().map(Adapter::describe).collect();
                Err(Error::NoAdapter(format!(
                    "no graphics hardware, only software: {}",
                    names.join("; ")
                )))
            }
        }
    }
}
