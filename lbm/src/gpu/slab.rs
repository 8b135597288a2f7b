//! Numbers of some cells between the lattice and the host, slab by slab. Twin:
//! shaders/lbm/slab.wgsl.

use super::setting::Range;
use super::solver::Solver;
use crate::Error;
use shaders::{Bound, Part, Pending, groups};

/// Cells of a slab at most: 20 MB of populations.
pub(super) const SLAB: usize = 1 << 18;
/// Threads of a workgroup in slab.wgsl.
const THREADS: u32 = 64;

/// Numbers of the cells of a slab.
pub(super) struct Slab {
    first: usize,
    count: usize,
    numbers: Vec<f32>,
}

impl Slab {
    /// Its cells.
    pub fn cells(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.count
    }

    /// Number `number` of `cell`.
    pub fn at(&self, cell: usize, number: usize) -> f32 {
        self.numbers[number * self.count + cell - self.first]
    }

    /// The same, to write.
    pub fn at_mut(&mut self, cell: usize, number: usize) -> &mut f32 {
        &mut self.numbers[number * self.count + cell - self.first]
    }
}

impl Solver {
    /// All cells, slab by slab.
    fn ranges(&self) -> impl Iterator<Item = Range> + use<> {
        let cells = self.fluid.len();
        (0..cells).step_by(SLAB).map(move |first| Range {
            // The solver refuses more cells than there are u32.
            first: first as u32,
            count: SLAB.min(cells - first) as u32,
            unused: [0; 2],
        })
    }

    /// Let `kernel` take over `numbers` numbers a cell, which `fill` writes.
    pub(super) fn write_slabs(
        &self,
        kernel: &Bound,
        numbers: usize,
        fill: impl Fn(&mut Slab),
    ) -> Result<(), Error> {
        for range in self.ranges() {
            let count = range.count as usize;
            let mut slab = Slab {
                first: range.first as usize,
                count,
                numbers: vec![0.0; numbers * count],
            };
            fill(&mut slab);
            self.device.write(&self.arrays.range, 0, &[range]);
            self.device.write(&self.arrays.slab, 0, &slab.numbers);
            let mut recording = self.device.record();
            recording.dispatch(kernel, groups(count, THREADS));
            recording.submit()?;
            // Else copies of all slabs would wait at a time.
            self.device.wait()?;
        }
        Ok(())
    }

    /// Show `see` the `numbers` numbers a cell that `kernel` tells.
    pub(super) fn read_slabs(
        &self,
        kernel: &Bound,
        numbers: usize,
        mut see: impl FnMut(&Slab),
    ) -> Result<(), Error> {
        let tick = self.write_last();
        let mut under_way: Option<(Range, Pending, Part<f32>)> = None;
        // The device makes one slab while the host looks at the one before.
        for range in self.ranges().map(Some).chain([None]) {
            let next = match range {
                Some(range) => {
                    let count = range.count as usize;
                    self.device.write(&self.arrays.range, 0, &[range]);
                    let mut recording = self.device.record();
                    recording.dispatch_at(kernel, tick, groups(count, THREADS));
                    recording.submit()?;
                    let mut reading = self.device.reading();
                    let part = reading.add(&self.arrays.slab, 0..numbers * count);
                    Some((range, reading.start(), part))
                }
                None => None,
            };
            if let Some((range, pending, part)) = std::mem::replace(&mut under_way, next) {
                see(&Slab {
                    first: range.first as usize,
                    count: range.count as usize,
                    numbers: pending.wait()?.take(part),
                });
            }
        }
        Ok(())
    }
}
