//! Reading arrays back without stopping the device: copies are queued, and waited for later.

use crate::{Array, Device, Error};
use bytemuck::Pod;
use std::marker::PhantomData;
use std::ops::Range;
use wgpu::{BufferUsages, CommandEncoder, MapMode};

/// Copies of arrays on their way to the host.
pub struct Reading {
    device: Device,
    encoder: CommandEncoder,
    staging: Vec<wgpu::Buffer>,
}

/// Copies under way.
pub struct Pending {
    device: Device,
    staging: Vec<wgpu::Buffer>,
    submission: wgpu::SubmissionIndex,
}

/// One of the copies.
pub struct Part<T> {
    index: usize,
    len: usize,
    element: PhantomData<fn() -> T>,
}

/// Copies that have arrived.
pub struct Arrived {
    bytes: Vec<Vec<u8>>,
}

impl Device {
    /// Begin to read.
    pub fn reading(&self) -> Reading {
        Reading {
            device: self.clone(),
            encoder: self.device.create_command_encoder(&Default::default()),
            staging: Vec::new(),
        }
    }

    /// Read all of `array`, waiting for what was submitted before.
    ///
    /// # Errors
    /// Those of [`Reading::wait`].
    pub fn read<T: Pod>(&self, array: &Array<T>) -> Result<Vec<T>, Error> {
        let mut reading = self.reading();
        let part = reading.add(array, 0..array.len());
        Ok(reading.wait()?.take(part))
    }
}

impl Reading {
    /// Copy the elements `range` of `array` as they will be after what was submitted before.
    pub fn add<T: Pod>(&mut self, array: &Array<T>, range: Range<usize>) -> Part<T> {
        let size = size_of::<T>();
        let bytes = (range.len() * size).max(4).next_multiple_of(4) as u64;
        let staging = self.device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("reading"),
            size: bytes,
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        if !range.is_empty() {
            let from = (range.start * size) as u64;
            self.encoder
                .copy_buffer_to_buffer(&array.buffer, from, &staging, 0, bytes);
        }
        self.staging.push(staging);
        Part {
            index: self.staging.len() - 1,
            len: range.len(),
            element: PhantomData,
        }
    }

    /// Start the copies; the host goes on.
    pub fn start(self) -> Pending {
        let submission = self.device.queue.submit([self.encoder.finish()]);
        for staging in &self.staging {
            // A failed mapping shows in the device's own errors, or when the range is taken.
            staging.slice(..).map_async(MapMode::Read, |_| {});
        }
        Pending {
            device: self.device,
            staging: self.staging,
            submission,
        }
    }

    /// Start the copies and wait for them.
    ///
    /// # Errors
    /// What went wrong on the device.
    pub fn wait(self) -> Result<Arrived, Error> {
        self.start().wait()
    }
}

impl Pending {
    /// Wait for the copies, not for what was submitted after them.
    ///
    /// # Errors
    /// What went wrong on the device.
    pub fn wait(self) -> Result<Arrived, Error> {
        let waited = self.device.device.poll(wgpu::PollType::Wait {
            submission_index: Some(self.submission),
            timeout: None,
        });
        self.device.check()?;
        waited.map_err(|e| Error::Lost(e.to_string()))?;
        let mut bytes = Vec::new();
        for staging in &self.staging {
            let view = staging.slice(..).get_mapped_range();
            let view = view.map_err(|e| Error::Lost(e.to_string()))?;
            bytes.push(view.to_vec());
        }
        Ok(Arrived { bytes })
    }
}

impl Arrived {
    /// The elements of `part`.
    pub fn take<T: Pod>(&self, part: Part<T>) -> Vec<T> {
        let bytes = &self.bytes[part.index][..part.len * size_of::<T>()];
        bytemuck::pod_collect_to_vec(bytes)
    }
}
