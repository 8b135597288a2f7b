//! Kernels: one entry point of a composed module, bound to arrays by name.

use crate::library::plain;
use crate::naga::valid::{Capabilities, GlobalUse, ValidationFlags, Validator};
use crate::naga::{AddressSpace, Module, StorageAccess};
use crate::parts::part_of;
use crate::{Bindable, Device, Error};
use std::borrow::Cow;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingType, BufferBindingType, ComputePipeline,
    ComputePipelineDescriptor, PipelineLayoutDescriptor, ShaderModuleDescriptor, ShaderSource,
    ShaderStages,
};

/// A uniform of this name is a number that changes from dispatch to dispatch
/// ([`Recording::dispatch_at`](crate::Recording::dispatch_at)).
const TICK: &str = "tick";

/// A compiled entry point.
#[derive(Clone, Debug)]
pub struct Kernel {
    name: String,
    pipeline: ComputePipeline,
    layout: BindGroupLayout,
    /// Names in the order of the bindings.
    names: Vec<String>,
    /// Threads of a workgroup.
    pub workgroup: u32,
}

/// A kernel with its arrays.
#[derive(Clone, Debug)]
pub struct Bound {
    pub(crate) pipeline: ComputePipeline,
    pub(crate) group: BindGroup,
    pub(crate) ticks: bool,
}

impl Kernel {
    pub(crate) fn new(device: &Device, module: &Module, entry: &str) -> Result<Self, Error> {
        let wrong = |what: String| Error::Shader(format!("{entry}: {what}"));
        let index = module.entry_points.iter().position(|e| e.name == entry);
        let index = index.ok_or_else(|| wrong("no such entry point".into()))?;
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        let info = validator
            .validate(module)
            .map_err(|e| wrong(e.emit_to_string("")))?;
        let uses = info.get_entry_point(index);

        let mut module = module.clone();
        let mut names = Vec::new();
        let mut entries = Vec::new();
        for (handle, global) in module.global_variables.iter_mut() {
            let Some(binding) = &mut global.binding else {
                continue;
            };
            // Numbers are ours to give: WGSL names, and what an entry point does not touch
            // (modules bring more than one kernel needs) is out of its way.
            let name = plain(global.name.as_deref().unwrap_or_default()).to_string();
            binding.group = 0;
            if uses[handle] == GlobalUse::empty() {
                binding.binding = 1000 + handle.index() as u32;
                continue;
            }
            binding.binding = names.len() as u32;
            let ty = match global.space {
                AddressSpace::Uniform => BufferBindingType::Uniform,
                AddressSpace::Storage { access } => BufferBindingType::Storage {
                    read_only: !access.contains(StorageAccess::STORE),
                },
                _ => return Err(wrong(format!("{name} is neither storage nor uniform"))),
            };
            entries.push(BindGroupLayoutEntry {
                binding: binding.binding,
                visibility: ShaderStages::COMPUTE,
                ty: BindingType::Buffer {
                    ty,
                    has_dynamic_offset: name == TICK,
                    min_binding_size: None,
                },
                count: None,
            });
            names.push(name);
        }
        // A device may have fewer than the kernels of a scene with all its parts.
        let storage = |entry: &&BindGroupLayoutEntry| {
            let storage = |ty| matches!(ty, BufferBindingType::Storage { .. });
            matches!(entry.ty, BindingType::Buffer { ty, .. } if storage(ty))
        };
        let arrays = entries.iter().filter(storage).count();
        let most = device.adapter.limits.max_storage_buffers_per_shader_stage;
        if arrays > most as usize {
            return Err(Error::Memory(format!(
                "{entry} needs {arrays} arrays at a time, and {} shows a kernel at most {most}",
                device.adapter.info.name
            )));
        }
        let workgroup = module.entry_points[index].workgroup_size.iter().product();

        let scope = device
            .device
            .push_error_scope(wgpu::ErrorFilter::Validation);
        let layout = BindGroupLayoutDescriptor {
            label: Some(entry),
            entries: &entries,
        };
        let layout = device.device.create_bind_group_layout(&layout);
        let pipeline_layout = device
            .device
            .create_pipeline_layout(&PipelineLayoutDescriptor {
                label: Some(entry),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
        let compiled = device.device.create_shader_module(ShaderModuleDescriptor {
            label: Some(entry),
            source: ShaderSource::Naga(Cow::Owned(module)),
        });
        let pipeline = ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(&pipeline_layout),
            module: &compiled,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        };
        let pipeline = device.device.create_compute_pipeline(&pipeline);
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(wrong(error.to_string()));
        }
        Ok(Self {
            name: entry.into(),
            pipeline,
            layout,
            names,
            workgroup,
        })
    }

    /// Give the kernel its arrays. More than it uses may be offered: one list serves all
    /// kernels of a solver.
    ///
    /// # Errors
    /// [`Error::Shader`] for an array that it uses and that is not offered.
    pub fn bind(&self, device: &Device, arrays: &[(&str, &dyn Bindable)]) -> Result<Bound, Error> {
        let mut entries = Vec::new();
        for (binding, name) in self.names.iter().enumerate() {
            let found = arrays.iter().find_map(|(offered, array)| {
                let part = part_of(name, offered)?;
                Some((offered, part, array.parts()))
            });
            let (whole, part, parts) = found.ok_or_else(|| {
                Error::Shader(format!("{} uses {name}, which it is not given", self.name))
            })?;
            let known = self.names.iter().filter(|n| part_of(n, whole).is_some());
            let known = known.count();
            if parts.len() != known {
                return Err(Error::Shader(format!(
                    "{} takes {whole} in {known} parts, and it lies in {}",
                    self.name,
                    parts.len()
                )));
            }
            let mut buffer = parts[part].as_entire_buffer_binding();
            if name == TICK {
                buffer.size = wgpu::BufferSize::new(4);
            }
            entries.push(BindGroupEntry {
                binding: binding as u32,
                resource: wgpu::BindingResource::Buffer(buffer),
            });
        }
        let scope = device
            .device
            .push_error_scope(wgpu::ErrorFilter::Validation);
        let group = device.device.create_bind_group(&BindGroupDescriptor {
            label: Some(&self.name),
            layout: &self.layout,
            entries: &entries,
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(Error::Shader(format!("{}: {error}", self.name)));
        }
        Ok(Bound {
            pipeline: self.pipeline.clone(),
            group,
            ticks: self.names.iter().any(|name| name == TICK),
        })
    }

    /// Names of the arrays that it uses.
    pub fn names(&self) -> &[String] {
        &self.names
    }
}
