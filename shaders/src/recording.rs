//! Recording dispatches: many steps in one pass, submitted at once.

use crate::kernel::Bound;
use crate::timing::Stamps;
use crate::{Array, Bindable, Device, Error};
use std::sync::atomic::Ordering;
use wgpu::{CommandEncoder, ComputePass, ComputePassDescriptor};

/// Workgroups along x at most, everywhere; beyond it they spread along y.
const MOST_ALONG_X: u32 = 65_535;

/// Bytes between two ticks: the largest alignment of uniforms that any device asks for.
const TICK_STRIDE: usize = 256;

/// Workgroups of `size` threads for `count` threads, along x and y. A kernel finds its
/// number as `group.x + group.y * groups.x`, and must bound it by `count` itself.
pub fn groups(count: usize, size: u32) -> [u32; 3] {
    let groups = count.div_ceil(size as usize) as u32;
    let y = groups.div_ceil(MOST_ALONG_X).max(1);
    [groups.div_ceil(y), y, 1]
}

/// Dispatches, in order, each after the writes of those before.
pub struct Recording {
    pub(crate) device: Device,
    pub(crate) encoder: CommandEncoder,
    pub(crate) pass: Option<ComputePass<'static>>,
    /// Only where sections are timed.
    pub(crate) stamps: Option<Stamps>,
}

impl Recording {
    pub(crate) fn new(device: &Device) -> Self {
        Self {
            device: device.clone(),
            encoder: device.device.create_command_encoder(&Default::default()),
            pass: None,
            stamps: None,
        }
    }

    fn pass(&mut self) -> &mut ComputePass<'static> {
        let (encoder, stamps) = (&mut self.encoder, &mut self.stamps);
        self.pass.get_or_insert_with(|| {
            let pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                label: None,
                timestamp_writes: stamps.as_mut().and_then(Stamps::of_pass),
            });
            pass.forget_lifetime()
        })
    }

    /// Run `bound` on this many workgroups.
    pub fn dispatch(&mut self, bound: &Bound, groups: [u32; 3]) {
        self.dispatch_at(bound, 0, groups);
    }

    /// The same, with `tick` in the kernel's uniform `tick` (see [`Device::ticks`]).
    pub fn dispatch_at(&mut self, bound: &Bound, tick: u32, [x, y, z]: [u32; 3]) {
        let pass = self.set(bound, tick);
        pass.dispatch_workgroups(x, y, z);
    }

    /// Run `bound` on as many workgroups as the three numbers from element `first` of
    /// `sizes` say.
    pub fn dispatch_indirect(&mut self, bound: &Bound, sizes: &Array<u32>, first: usize) {
        let pass = self.set(bound, 0);
        pass.dispatch_workgroups_indirect(&sizes.parts()[0], 4 * first as u64);
    }

    fn set(&mut self, bound: &Bound, tick: u32) -> &mut ComputePass<'static> {
        self.device.traffic[2].fetch_add(1, Ordering::Relaxed);
        let pass = self.pass();
        pass.set_pipeline(&bound.pipeline);
        let offset = [tick * TICK_STRIDE as u32];
        let offsets = if bound.ticks { &offset[..] } else { &[] };
        pass.set_bind_group(0, &bound.group, offsets);
        pass
    }

    /// Copy `count` elements from element `from` of `source` to element `to` of `target`.
    pub fn copy<T>(
        &mut self,
        source: &Array<T>,
        from: usize,
        target: &Array<T>,
        to: usize,
        count: usize,
    ) {
        self.pass = None;
        let mut done = 0;
        while done < count {
            let source = source.piece(from + done, count - done);
            let target = target.piece(to + done, source.count);
            self.encoder.copy_buffer_to_buffer(
                source.buffer,
                source.offset,
                target.buffer,
                target.offset,
                (target.count * size_of::<T>()) as u64,
            );
            done += target.count;
        }
    }

    /// Set all of `array` to zero bytes.
    pub fn clear<T>(&mut self, array: &Array<T>) {
        self.pass = None;
        for part in array.parts() {
            self.encoder.clear_buffer(part, 0, None);
        }
    }

    /// Hand everything to the device; it runs while the host goes on.
    ///
    /// # Errors
    /// What went wrong on the device so far.
    pub fn submit(mut self) -> Result<(), Error> {
        self.pass = None;
        self.device.queue.submit([self.encoder.finish()]);
        // Without a poll finished work is never tidied up.
        let _ = self.device.device.poll(wgpu::PollType::Poll);
        self.device.check()
    }
}

impl Device {
    /// The numbers 0 to `count` for kernels that have a uniform `tick`.
    ///
    /// # Errors
    /// Those of [`array`](Self::array).
    pub fn ticks(&self, count: usize) -> Result<Array<u32>, Error> {
        let stride = TICK_STRIDE / size_of::<u32>();
        let mut numbers = vec![0; count * stride];
        for (k, number) in numbers.iter_mut().step_by(stride).enumerate() {
            *number = k as u32;
        }
        self.array_of("tick", &numbers)
    }
}
