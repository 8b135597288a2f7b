//! An open device: it makes arrays and kernels, runs recordings, and says when it is lost.

use crate::kernel::Kernel;
use crate::{Adapter, Array, Choice, Error, Parts, Recording};
use bytemuck::Pod;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use wgpu::{DeviceDescriptor, ErrorFilter, ExperimentalFeatures, Features, MemoryHints, Trace};

/// An open device with its queue. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Device {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// The adapter that was opened.
    pub adapter: Arc<Adapter>,
    /// What went wrong outside of any call.
    trouble: Arc<Mutex<Option<Error>>>,
    /// Bytes that crossed to the device and back.
    pub(crate) traffic: Arc<[AtomicU64; 3]>,
}

/// Bytes that have crossed between the host and a device since it was opened, and what it was told to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Written to the device.
    pub written: u64,
    /// Read from it.
    pub read: u64,
    /// Dispatches recorded.
    pub dispatches: u64,
}

impl Device {
    /// Open the best device of the kind.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] if there is none, or if it refuses.
    pub fn open(choice: Choice) -> Result<Self, Error> {
        Self::open_adapter(choice.pick()?)
    }

    /// Open `adapter`, with all of its limits and no optional feature but time stamps,
    /// where it has them.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] if it refuses.
    pub fn open_adapter(adapter: Adapter) -> Result<Self, Error> {
        let wanted = DeviceDescriptor {
            label: Some("esker"),
            required_features: adapter.adapter.features() & Features::TIMESTAMP_QUERY,
            required_limits: adapter.limits.clone(),
            experimental_features: ExperimentalFeatures::disabled(),
            memory_hints: MemoryHints::Performance,
            trace: Trace::Off,
        };
        let opened = pollster::block_on(adapter.adapter.request_device(&wanted));
        let (device, queue) = opened
            .map_err(|e| Error::NoAdapter(format!("{} does not open: {e}", adapter.describe())))?;
        let trouble = Arc::new(Mutex::new(None));
        let lost = trouble.clone();
        device.set_device_lost_callback(move |reason, message| {
            // Dropping a device at the end of a run "loses" it too.
            if reason != wgpu::DeviceLostReason::Destroyed {
                note(&lost, Error::Lost(message));
            }
        });
        let wrong = trouble.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let error = match error {
                wgpu::Error::OutOfMemory { source } => Error::Memory(source.to_string()),
                other => Error::Shader(other.to_string()),
            };
            note(&wrong, error);
        }));
        Ok(Self {
            device,
            queue,
            adapter: Arc::new(adapter),
            trouble,
            traffic: Arc::default(),
        })
    }

    /// What went wrong since the device was opened, if anything did.
    ///
    /// # Errors
    /// The first thing that went wrong.
    pub fn check(&self) -> Result<(), Error> {
        let trouble = self.trouble.lock();
        let trouble = trouble.unwrap_or_else(std::sync::PoisonError::into_inner);
        trouble.clone().map_or(Ok(()), Err)
    }

    /// An array of `len` zeros in one part, called `name` in messages.
    ///
    /// # Errors
    /// [`Error::Memory`] if it is larger than a binding or does not fit.
    pub fn array<T: Pod>(&self, name: &str, len: usize) -> Result<Array<T>, Error> {
        let bytes = bytes_of::<T>(len);
        let largest = self.adapter.largest_binding();
        if bytes > largest {
            return Err(Error::Memory(format!(
                "{name} would take {bytes} bytes, and {} lets a kernel see at most {largest} of it",
                self.adapter.info.name
            )));
        }
        Ok(Array::new(
            [self.buffer(name, bytes)?].into(),
            len.max(1),
            len,
        ))
    }

    /// The same in as many parts as it needs, for kernels that know of them
    /// ([`Flags::parts`](crate::Flags::parts)).
    ///
    /// # Errors
    /// [`Error::Memory`] if it does not fit.
    pub fn array_in_parts<T: Pod>(&self, name: &str, len: usize) -> Result<Array<T>, Error> {
        let Parts { count, bits } = self.parts::<T>(len);
        if count == 1 {
            return self.array(name, len);
        }
        let chunk = 1 << bits;
        let parts = (0..count as usize).map(|part| {
            let elements = chunk.min(len - part * chunk);
            self.buffer(name, bytes_of::<T>(elements))
        });
        let parts = parts.collect::<Result<Vec<_>, _>>()?;
        Ok(Array::new(parts.into(), chunk, len))
    }

    /// How [`array_in_parts`](Self::array_in_parts) lays `len` elements.
    pub fn parts<T: Pod>(&self, len: usize) -> Parts {
        Parts::of(len, size_of::<T>(), self.adapter.largest_binding())
    }

    fn buffer(&self, name: &str, bytes: u64) -> Result<wgpu::Buffer, Error> {
        let scope = self.device.push_error_scope(ErrorFilter::OutOfMemory);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::UNIFORM
                | wgpu::BufferUsages::INDIRECT
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(Error::Memory(format!(
                "no room on {} for {name}, {bytes} bytes: {error}",
                self.adapter.info.name
            )));
        }
        Ok(buffer)
    }

    /// An array that holds `values`.
    ///
    /// # Errors
    /// Those of [`array`](Self::array).
    pub fn array_of<T: Pod>(&self, name: &str, values: &[T]) -> Result<Array<T>, Error> {
        let array = self.array(name, values.len())?;
        self.write(&array, 0, values);
        Ok(array)
    }

    /// Write `values` into `array` from element `first` on, before what is submitted next.
    pub fn write<T: Pod>(&self, array: &Array<T>, first: usize, values: &[T]) {
        let mut left = values;
        for piece in array.pieces(first..first + values.len()) {
            let (now, rest) = left.split_at(piece.count);
            let bytes: &[u8] = bytemuck::cast_slice(now);
            self.traffic[0].fetch_add(bytes.len() as u64, Ordering::Relaxed);
            self.queue.write_buffer(piece.buffer, piece.offset, bytes);
            left = rest;
        }
    }

    /// What has crossed so far.
    pub fn traffic(&self) -> Traffic {
        let [written, read, dispatches] =
            [0, 1, 2].map(|k| self.traffic[k].load(Ordering::Relaxed));
        Traffic {
            written,
            read,
            dispatches,
        }
    }

    /// Compile entry point `entry` of `module`.
    ///
    /// # Errors
    /// [`Error::Shader`] with the compiler's words.
    pub fn kernel(&self, module: &crate::naga::Module, entry: &str) -> Result<Kernel, Error> {
        Kernel::new(self, module, entry)
    }

    /// Begin to record dispatches.
    pub fn record(&self) -> Recording {
        Recording::new(self)
    }

    /// Give the device back now: everything on it fails from here on, as when it is lost.
    pub fn destroy(&self) {
        let reason = Error::Lost("it was given back".into());
        note(&self.trouble, reason);
        self.device.destroy();
    }

    /// Wait until everything submitted is done.
    ///
    /// # Errors
    /// Those of [`check`](Self::check).
    pub fn wait(&self) -> Result<(), Error> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited.map(|_| ()).map_err(|e| Error::Lost(e.to_string()))
    }
}

/// Bytes of a buffer for `len` elements: a binding cannot be empty, and takes whole words.
fn bytes_of<T>(len: usize) -> u64 {
    (len.max(1) * size_of::<T>()).next_multiple_of(4) as u64
}

/// Keep the first trouble: the others follow from it.
fn note(trouble: &Mutex<Option<Error>>, error: Error) {
    let mut trouble = trouble
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    trouble.get_or_insert(error);
}
