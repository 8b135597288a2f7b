//! Reading arrays back without stopping the device: copies are queued, and waited for later.

use crate::{Array, Device, Error};
use bytemuck::Pod;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::atomic::Ordering;
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

/// One of the copies, of an array in one part or several.
pub struct Part<T> {
    staging: Range<usize>,
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
        let (first, len) = (self.staging.len(), range.len());
        for piece in array.pieces(range) {
            let bytes = (piece.count * size_of::<T>()).next_multiple_of(4) as u64;
            self.device.traffic[1].fetch_add(bytes, Ordering::Relaxed);
            let staging = self.device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("reading"),
                size: bytes,
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let (from, at) = (piece.buffer, piece.offset);
            self.encoder
                .copy_buffer_to_buffer(from, at, &staging, 0, bytes);
            self.staging.push(staging);
        }
        Part {
            staging: first..self.staging.len(),
            len,
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
        // Each copy is given back as soon as the host has its own.
        for staging in self.staging {
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
        let mut elements = Vec::with_capacity(part.len);
        for bytes in &self.bytes[part.staging] {
            let whole = bytes.chunks_exact(size_of::<T>());
            elements.extend(whole.map(bytemuck::pod_read_unaligned::<T>));
        }
        elements.truncate(part.len);
        elements
    }
}
