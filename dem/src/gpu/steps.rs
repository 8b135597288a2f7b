//! Steps on the device: recorded in groups, handed over by the thousand, heard of later.

use super::arrays::Arrays;
use super::control::{CROWDED, Control, FULL, GONE, UNSTABLE};
use super::search::{self, Search};
use super::solver::Solver;
use crate::Error;
use shaders::{Bound, Device, Flags, Kernel, Recording, compose, groups};
use std::collections::VecDeque;

/// Steps between two looks at the neighbour lists: a look costs as much as a few steps, and
/// steps that are not made, because the lists end before the group does, cost their launch.
pub(super) const GROUP: usize = 64;
/// Groups handed over at a time: about a thousand steps.
const GROUPS: u64 = 16;
/// Steps after which sums are taken off the device: a wall may be pressed by k_n R in all of them
/// ([`Units`](super::loading::Units)).
const TAKEN_EVERY: u64 = 1 << 12;
/// Grains times steps of a submission. Drivers that also serve a screen take a device for lost that
/// works on one for seconds.
const SUBMITTED: usize = 1 << 27;
/// Threads of a workgroup in step.wgsl.
pub(super) const THREADS: u32 = 64;

/// The kernels of a step: all of it, or all but the motion and the motion.
pub(super) struct Step {
    whole: Kernel,
    motion: Option<Kernel>,
    /// The whole that leaves how hard grains are pressed, for a companion.
    loads: Option<Kernel>,
}

/// The same with their arrays.
pub(super) struct Dispatches {
    whole: Bound,
    motion: Option<Bound>,
    loads: Option<Bound>,
}

impl Step {
    pub fn new(device: &Device, flags: &Flags) -> Result<Self, Error> {
        let module = compose("dem/step.wgsl", flags)?;
        Ok(Self {
            whole: device.kernel(&module, "time_step")?,
            motion: match flags.has("SHEAR_STRESS") {
                true => Some(device.kernel(&module, "move_all")?),
                false => None,
            },
            loads: match flags.has("COMPANION") {
                true => {
                    let module = compose("dem/step.wgsl", &flags.clone().set("LOADS"))?;
                    Some(device.kernel(&module, "time_step")?)
                }
                false => None,
            },
        })
    }
}

/// The kernel of a reading.
pub(super) fn measure(device: &Device, flags: &Flags) -> Result<Kernel, Error> {
    let flags = flags.clone().set("READ").set("APART");
    Ok(device.kernel(&compose("dem/step.wgsl", &flags)?, "measure_all")?)
}

impl Solver {
    /// The kernels for the arrays as they are now.
    pub(super) fn bind_steps(&mut self) -> Result<(), Error> {
        let flags = self.arrays.entries.flags(&self.device, &self.flags);
        if flags != self.compiled {
            self.measure = measure(&self.device, &flags)?;
            self.step = Step::new(&self.device, &flags)?;
            self.compiled = flags;
        }
        let named = self.arrays.named();
        let bind = |kernel: &Kernel| kernel.bind(&self.device, &named);
        let some = |kernel: &Option<Kernel>| kernel.as_ref().map(bind).transpose();
        self.dispatches = Some(Dispatches {
            whole: bind(&self.step.whole)?,
            motion: some(&self.step.motion)?,
            loads: some(&self.step.loads)?,
        });
        Ok(())
    }

    /// Make `steps` steps, and see that the lists hold for the places they lead to.
    pub(super) fn walk(&mut self, steps: u64) -> Result<(), Error> {
        let mut left = steps;
        while left > 0 {
            let steps = left.min(TAKEN_EVERY);
            self.go(steps)?;
            left -= steps;
            self.made(steps)?;
        }
        self.find_neighbours()
    }

    /// Take the sums of `steps` more steps off the device where it is time.
    pub(super) fn made(&mut self, steps: u64) -> Result<(), Error> {
        self.since_taken += steps;
        if self.since_taken >= TAKEN_EVERY {
            self.take_sums()?;
        }
        Ok(())
    }

    /// Search, if the lists are no longer good for the places of now: the search that the next
    /// step would begin with.
    pub(super) fn find_neighbours(&mut self) -> Result<(), Error> {
        loop {
            let mut recording = self.device.record();
            self.search.record(&mut recording);
            recording.submit()?;
            let control = self.device.read(&self.arrays.control)?[0];
            if !self.heed(control)? {
                return Ok(());
            }
        }
    }

    /// Take the sums over steps off the device, which stands still.
    fn take_sums(&mut self) -> Result<(), Error> {
        let range = self.totals.range();
        let mut reading = self.device.reading();
        let part = reading.add(&self.arrays.sums, range.clone());
        self.totals.add(&reading.wait()?.take(part));
        let nothing = vec![[0; 2]; range.len()];
        self.device.write(&self.arrays.sums, range.start, &nothing);
        self.since_taken = 0;
        Ok(())
    }

    fn go(&mut self, steps: u64) -> Result<(), Error> {
        let until = u64::from(self.control.base) + steps;
        let end = self.count(until)?;
        self.write_end(end);
        let mut pending = VecDeque::new();
        while self.control.base < end {
            // What is under way is taken to be made in full; early searches come as a surprise.
            let under_way = pending.len() as u64 * GROUPS * GROUP as u64;
            let missing = (until - u64::from(self.control.base)).saturating_sub(under_way);
            let groups = missing.div_ceil(GROUP as u64).min(GROUPS);
            if groups > 0 && pending.len() < 2 {
                self.submit(groups)?;
                let mut reading = self.device.reading();
                let part = reading.add(&self.arrays.control, 0..1);
                pending.push_back((reading.start(), part));
                continue;
            }
            let (reading, part) = pending
                .pop_front()
                .expect("nothing missing, nothing under way");
            let control = reading.wait()?.take(part)[0];
            if self.heed(control)? {
                // What was under way did nothing.
                pending.clear();
                self.write_end(end);
            }
        }
        Ok(())
    }

    /// The number of a step as the device counts it.
    pub(super) fn count(&self, step: u64) -> Result<u32, Error> {
        u32::try_from(step).map_err(|_| Error::Unstable {
            step: u64::from(self.control.base),
            what: "the GPU counts 4e9 steps in one phase; divide the phase".into(),
        })
    }

    pub(super) fn write_end(&self, end: u32) {
        // The first word, `end`, is the host's; the others are the device's.
        self.device.write(&self.arrays.control.words(), 0, &[end]);
    }

    /// Hand over `groups` groups of steps.
    fn submit(&self, count: u64) -> Result<(), Error> {
        let most = (SUBMITTED / self.arrays.parts.grains.max(1)).max(1);
        let mut recording = self.device.record();
        let mut recorded = 0;
        for _ in 0..count {
            self.search.record(&mut recording);
            for tick in 0..GROUP as u32 {
                if recorded == most {
                    std::mem::replace(&mut recording, self.device.record()).submit()?;
                    recorded = 0;
                }
                self.record_step(&mut recording, tick, false);
                recorded += 1;
            }
            self.search.settle(&mut recording);
        }
        Ok(recording.submit()?)
    }

    /// The step `tick` of a group; where `loads`, it leaves how hard grains are pressed.
    pub(super) fn record_step(&self, recording: &mut Recording, tick: u32, loads: bool) {
        let n = self.arrays.parts.grains;
        let shared = groups(n * self.numbers.lanes as usize, THREADS);
        let Some(step) = &self.dispatches else {
            return;
        };
        let whole = step.loads.as_ref().filter(|_| loads);
        recording.dispatch_at(whole.unwrap_or(&step.whole), tick, shared);
        if let Some(motion) = &step.motion {
            recording.dispatch_at(motion, tick, groups(n, THREADS));
        }
    }

    /// Take note of how far the device is. True if it stood still for want of room, which it
    /// now has.
    pub(super) fn heed(&mut self, control: Control) -> Result<bool, Error> {
        self.control = control;
        let step = u64::from(control.base);
        let unstable = |what: String| Err(Error::Unstable { step, what });
        if control.flags & (UNSTABLE | GONE) != 0 {
            return unstable(format!(
                "a grain or wall went more than half the smallest radius in one step, or out of \
                 range; the time step {:.3e} s is too long for this motion",
                self.model.step
            ));
        }
        if control.flags & FULL != 0 {
            return unstable(
                "a running sum is full: within a few thousand steps contacts lose more energy, or \
                 press harder, than stiffness and radius let expect; use the CPU"
                    .into(),
            );
        }
        if control.flags & CROWDED == 0 {
            return Ok(false);
        }
        let room = |needed: u32| needed as usize + needed as usize / 4 + 64;
        if control.entries as usize > self.arrays.entries.neighbours.len() {
            let entries = &self.arrays.entries;
            let room = room(control.entries);
            self.arrays.entries = entries.grown(&self.device, &self.arrays.parts, room)?;
            self.bind_steps()?;
        }
        self.touching_room = self.touching_room.max(room(control.touching));
        self.search = bind_search(
            &self.device,
            &mut self.search_kernels,
            &self.numbers.setting(&self.model),
            &self.arrays,
            self.touching_room,
        )?;
        self.control.flags = 0;
        self.device.write(&self.arrays.control, 0, &[self.control]);
        Ok(true)
    }
}

/// The search, bound to `arrays`, with room for `touching` entries that touch.
pub(super) fn bind_search(
    device: &Device,
    kernels: &mut search::Kernels,
    setting: &search::Setting,
    arrays: &Arrays,
    touching: usize,
) -> Result<Search, Error> {
    let histories: Vec<_> = arrays.entries.histories().collect();
    let rows = arrays.rows();
    let bound = search::Arrays {
        control: &arrays.control,
        places: &arrays.places,
        motions: &arrays.motions,
        lists: &arrays.lists,
        neighbours: &arrays.entries.neighbours,
        histories: &histories,
        rows: &rows,
    };
    Ok(Search::new(device, kernels, setting, &bound, touching)?)
}
