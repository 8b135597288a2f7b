//! Time stamps: how long the sections of a recording take on the device.

use crate::{Device, Error, Recording};
use wgpu::{
    BufferDescriptor, BufferUsages, ComputePassTimestampWrites, Features, MapMode, QuerySet,
    QuerySetDescriptor, QueryType,
};

/// Sections that a recording can time.
const MOST: u32 = 1024;

/// Stamps at the beginning and end of the passes of a recording, one pass a section.
pub(crate) struct Stamps {
    set: QuerySet,
    section: &'static str,
    /// Of the passes so far.
    names: Vec<&'static str>,
}

impl Stamps {
    /// What the pass that begins now is to write.
    pub fn of_pass(&mut self) -> Option<ComputePassTimestampWrites<'_>> {
        let first = 2 * self.names.len() as u32;
        if first >= 2 * MOST {
            return None;
        }
        self.names.push(self.section);
        Some(ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }
}

impl Device {
    /// Begin to record dispatches whose [sections](Recording::section) are timed; none where
    /// the device has no time stamps.
    pub fn record_timed(&self) -> Option<Recording> {
        if !self.device.features().contains(Features::TIMESTAMP_QUERY) {
            return None;
        }
        let set = self.device.create_query_set(&QuerySetDescriptor {
            label: Some("stamps"),
            ty: QueryType::Timestamp,
            count: 2 * MOST,
        });
        let mut recording = self.record();
        recording.stamps = Some(Stamps {
            set,
            section: "",
            names: Vec::new(),
        });
        Some(recording)
    }
}

impl Recording {
    /// What follows belongs to the section `name`. Without [stamps](Device::record_timed) this
    /// does nothing.
    pub fn section(&mut self, name: &'static str) {
        if let Some(stamps) = &mut self.stamps {
            stamps.section = name;
            self.pass = None;
        }
    }

    /// Hand everything to the device and wait: the time of each section in the order of their
    /// passes [s].
    ///
    /// # Errors
    /// What went wrong on the device.
    pub fn submit_timed(mut self) -> Result<Vec<(&'static str, f64)>, Error> {
        self.pass = None;
        let Some(stamps) = self.stamps.take() else {
            self.submit()?;
            return Ok(Vec::new());
        };
        let device = self.device.clone();
        let count = 2 * stamps.names.len() as u32;
        let buffer = |label, usage| {
            device.device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size: u64::from(2 * MOST) * 8,
                usage,
                mapped_at_creation: false,
            })
        };
        let ticks = buffer(
            "ticks",
            BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
        );
        let staging = buffer("staging", BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        self.encoder
            .resolve_query_set(&stamps.set, 0..count, &ticks, 0);
        self.encoder
            .copy_buffer_to_buffer(&ticks, 0, &staging, 0, ticks.size());
        self.submit()?;
        staging.slice(..).map_async(MapMode::Read, |_| {});
        device.wait()?;
        let view = staging.slice(..).get_mapped_range();
        let view = view.map_err(|e| Error::Lost(e.to_string()))?;
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&view[..8 * count as usize]);
        let period = f64::from(device.queue.get_timestamp_period()) * 1e-9;
        let seconds = ticks
            .chunks_exact(2)
            .map(|pair| pair[1].saturating_sub(pair[0]) as f64 * period);
        Ok(stamps.names.into_iter().zip(seconds).collect())
    }
}
