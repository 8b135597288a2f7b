//! The neighbour search on the device: a fixed sequence of dispatches that does nothing
//! where the lists are still good ([`control`](crate::gpu::control)).
//!
//! | stage | what |
//! |---|---|
//! | `measure`, `decide` | is a search due? Lay the grid, set the sizes of all that follows |
//! | `clear`, `bin`, scan, `scatter`, `rank` | counting sort along the cells, by identity within |
//! | `count`, scan | near grains of each, and its entries that touch |
//! | `save`, `fill` | entries that touch are put aside; the new lists find them there |
//! | `take_history`, `put_history` | each array of what contacts remember follows its entry |
//! | `take_rows`, `put_rows` | each array of grain rows follows the new order |
//!
//! Until `save` only scratch is written. So a search that finds too little room for its
//! lists changes nothing and can be repeated with more ([`CROWDED`](super::control::CROWDED)).
//! Nothing depends on which thread comes first: a second run gives the same bits.
//!
//! Cells are about as wide as a mean grain, as on the CPU, but every grain looks as far as
//! the largest one may reach: both grains of a pair find each other, and no list has two
//! writers.
//!
//! Twins: shaders/dem/search/{check,cells,scan,lists,carry}.wgsl.

pub mod plan;
#[cfg(test)]
mod tests;

pub use super::scene::{INDEX, Motion, SLIDING, TOUCHING};

use super::control::Control;
use plan::{Grid, Plan, Shape};
use shaders::{Array, Bindable, Bound, Device, Error, Flags, Kernel, Recording, compose, groups};

/// Cells for each grain at most; a bed that is sparser gets wider cells.
const CELLS_A_GRAIN: usize = 2;

/// Elements of a workgroup of the scan.
const BLOCK: usize = 2048;

/// Where the sizes of a stage stand in the array that `decide` writes: the order of
/// `set_size` in check.wgsl.
#[derive(Clone, Copy)]
enum Size {
    Grains,
    Cells,
    CellBlocks,
    GrainBlocks,
    One,
}

/// Numbers of the sizes of all stages.
const SIZES: usize = 15;

/// What the search must know of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Grains.
    pub count: usize,
    /// Periodic lengths along x and y, 0 where the box is open [units].
    pub lengths: [i32; 2],
    /// Mean diameter [units].
    pub diameter: i32,
    /// Largest radius, rounded up [units].
    pub largest: i32,
    /// Unit of positions [m].
    pub unit: f32,
    /// Time step [s].
    pub step: f32,
    /// Smallest and largest skin [m]; the same number twice for a skin that stays.
    pub skins: [f32; 2],
    /// Steps between searches that the skin aims at.
    pub every: f32,
}

impl Setting {
    /// The plan of a search with room for `entries`, of which `touching` touch.
    pub fn plan(&self, entries: usize, touching: usize) -> Plan {
        Plan {
            count: self.count as u32,
            cell_room: (CELLS_A_GRAIN * self.count + 64) as u32,
            entry_room: entries as u32,
            touching_room: touching as u32,
            lengths: self.lengths,
            diameter: self.diameter,
            largest: self.largest,
            unit: self.unit,
            step: self.step,
            skins: self.skins,
            every: self.every,
            padding: 0,
        }
    }
}

/// The solver's arrays that the search reads and reorders.
pub struct Arrays<'a> {
    /// Progress.
    pub control: &'a Array<Control>,
    /// Position and radius, two halves.
    pub places: &'a dyn Bindable,
    /// Velocity, spin and identity, two halves.
    pub motions: &'a dyn Bindable,
    /// First entry and number of entries of each grain. Before the first search: lists of
    /// the contacts that exist, from both sides, for grains in any order.
    pub lists: &'a Array<[u32; 2]>,
    /// Entries: place of the neighbour, and flags. Its length is the room for them.
    pub neighbours: &'a Array<u32>,
    /// What contacts remember, one vector for each entry.
    pub histories: &'a [&'a Array<[f32; 4]>],
    /// Further rows of grains, with the vectors of four words that each row takes.
    pub rows: &'a [(&'a dyn Bindable, u32)],
}

/// The compiled stages.
#[derive(Clone)]
pub struct Kernels {
    /// What they were compiled with.
    flags: Flags,
    settle: Kernel,
    measure: Kernel,
    decide: Kernel,
    clear: Kernel,
    bin: Kernel,
    scatter: Kernel,
    rank: Kernel,
    scan: [Kernel; 3],
    scan_pairs: [Kernel; 3],
    count: Kernel,
    save: Kernel,
    fill: Kernel,
    /// Where contacts remember anything.
    history: Option<[Kernel; 2]>,
    rows: [Kernel; 2],
}

impl Kernels {
    /// Compile the stages for arrays in one part each; `history`: do contacts remember more than
    /// flags?
    ///
    /// # Errors
    /// [`Error::Shader`] with the compiler's words.
    pub fn new(device: &Device, history: bool) -> Result<Self, Error> {
        Self::compile(device, Flags::new().set_if("HISTORY", history))
    }

    fn compile(device: &Device, flags: Flags) -> Result<Self, Error> {
        let history = flags.has("HISTORY");
        let pairs = Flags::new().set("PAIRS");
        let file = |name: &str, flags: &Flags| compose(&format!("dem/search/{name}.wgsl"), flags);
        let check = file("check", &flags)?;
        let cells = file("cells", &flags)?;
        let scan = file("scan", &flags)?;
        let scan_pairs = file("scan", &pairs)?;
        let lists = file("lists", &flags)?;
        let carry = file("carry", &flags)?;
        let three = |module| -> Result<[Kernel; 3], Error> {
            Ok([
                device.kernel(module, "sums")?,
                device.kernel(module, "top")?,
                device.kernel(module, "scan")?,
            ])
        };
        Ok(Self {
            settle: device.kernel(&check, "settle")?,
            measure: device.kernel(&check, "measure")?,
            decide: device.kernel(&check, "decide")?,
            clear: device.kernel(&cells, "clear")?,
            bin: device.kernel(&cells, "bin")?,
            scatter: device.kernel(&cells, "scatter")?,
            rank: device.kernel(&cells, "rank")?,
            scan: three(&scan)?,
            scan_pairs: three(&scan_pairs)?,
            count: device.kernel(&lists, "count")?,
            save: device.kernel(&lists, "save")?,
            fill: device.kernel(&lists, "fill")?,
            history: match history {
                true => Some([
                    device.kernel(&carry, "take_history")?,
                    device.kernel(&carry, "put_history")?,
                ]),
                false => None,
            },
            rows: [
                device.kernel(&carry, "take_rows")?,
                device.kernel(&carry, "put_rows")?,
            ],
            flags,
        })
    }

    /// Compile them anew, if they are not for arrays of these lengths.
    fn suit(&mut self, device: &Device, room: &Room) -> Result<(), Error> {
        let words = |len| device.parts::<u32>(len);
        let vectors = |len| device.parts::<[u32; 4]>(len);
        let flags = Flags::new()
            .set_if("HISTORY", self.flags.has("HISTORY"))
            .parts("neighbours", words(room.entries))
            .parts("origins", words(room.origins))
            .parts("history", vectors(room.entries))
            .parts("saved", words(room.touching))
            .parts("saved_entries", words(room.remembered))
            .parts("scratch", vectors(room.scratch));
        if flags != self.flags {
            *self = Self::compile(device, flags)?;
        }
        Ok(())
    }
}

/// Lengths of the arrays that may lie in parts.
struct Room {
    entries: usize,
    origins: usize,
    touching: usize,
    remembered: usize,
    scratch: usize,
}

/// The search with its scratch, bound to the arrays of a solver.
pub struct Search {
    count: usize,
    settle: Bound,
    measure: Bound,
    decide: Bound,
    stages: Vec<(Bound, Size)>,
    sizes: Array<u32>,
    bytes: u64,
}

/// Scratch of the search.
struct Scratch<'a> {
    device: &'a Device,
    bytes: u64,
}

impl Scratch<'_> {
    fn array<T: bytemuck::Pod>(&mut self, name: &str, len: usize) -> Result<Array<T>, Error> {
        let array = self.device.array(name, len)?;
        self.bytes += array.bytes();
        Ok(array)
    }

    fn in_parts<T: bytemuck::Pod>(&mut self, name: &str, len: usize) -> Result<Array<T>, Error> {
        let array = self.device.array_in_parts(name, len)?;
        self.bytes += array.bytes();
        Ok(array)
    }
}

impl Search {
    /// Bind the search to `arrays`, with room for `touching` entries that touch.
    ///
    /// Kernels that were compiled for arrays in other parts are compiled anew.
    ///
    /// To be made anew when arrays have grown; [`Control::flags`] are then to be cleared. It
    /// knows of no lists: unless the last search was crowded, set [`Control::skin`] to 0 and
    /// [`Control::good`] to [`Control::base`], so that it makes new ones.
    ///
    /// # Errors
    /// [`Error::Memory`] if the scratch does not fit.
    pub fn new(
        device: &Device,
        kernels: &mut Kernels,
        setting: &Setting,
        arrays: &Arrays,
        touching: usize,
    ) -> Result<Self, Error> {
        let n = setting.count;
        let plan = setting.plan(arrays.neighbours.len(), touching);
        let cell_room = plan.cell_room as usize;
        let plan = device.array_of("plan", &[plan])?;
        let history = kernels.history.is_some();
        let entries = arrays.neighbours.len();
        let remembered = if history { touching } else { 0 };
        let widest = arrays.rows.iter().map(|&(_, width)| width as usize);
        let widest = widest.fold(2, usize::max);
        let room = Room {
            entries,
            origins: if history { entries } else { 0 },
            touching,
            remembered,
            scratch: remembered.max(widest * n),
        };
        kernels.suit(device, &room)?;

        let mut scratch = Scratch { device, bytes: 0 };
        let grid = scratch.array::<Grid>("grid", 1)?;
        let sizes = scratch.array::<u32>("sizes", SIZES)?;
        let searched = scratch.array::<i32>("searched", 3 * n)?;
        let starts = scratch.array::<u32>("starts", cell_room + 1)?;
        let blocks = scratch.array::<[u32; 2]>("blocks", (cell_room + 1).div_ceil(BLOCK))?;
        let bins = scratch.array::<[u32; 2]>("bins", n)?;
        let members = scratch.array::<u32>("members", n)?;
        let order = scratch.array::<u32>("order", n)?;
        let heads = scratch.array::<[u32; 2]>("heads", n + 1)?;
        let saved = scratch.in_parts::<u32>("saved", touching)?;
        let saved_entries = scratch.in_parts::<u32>("saved_entries", remembered)?;
        let origins = scratch.in_parts::<u32>("origins", room.origins)?;
        let vectors = scratch.in_parts::<[u32; 4]>("scratch", room.scratch)?;
        let bytes = scratch.bytes;
        let far = [i32::MAX; 3].into_iter().chain([-i32::MAX; 3]);
        let extent = device.array_of("extent", &far.collect::<Vec<i32>>())?;

        let common: Vec<(&str, &dyn Bindable)> = vec![
            ("control", arrays.control),
            ("plan", &plan),
            ("grid", &grid),
            ("extent", &extent),
            ("sizes", &sizes),
            ("searched", &searched),
            ("places", arrays.places),
            ("motions", arrays.motions),
            ("starts", &starts),
            ("blocks", &blocks),
            ("bins", &bins),
            ("members", &members),
            ("order", &order),
            ("heads", &heads),
            ("saved", &saved),
            ("saved_entries", &saved_entries),
            ("origins", &origins),
            ("scratch", &vectors),
            ("lists", arrays.lists),
            ("neighbours", arrays.neighbours),
        ];
        let bind = |kernel: &Kernel, more: &[(&str, &dyn Bindable)]| {
            kernel.bind(device, &[&common[..], more].concat())
        };

        let mut stages = vec![
            (bind(&kernels.clear, &[])?, Size::Cells),
            (bind(&kernels.bin, &[])?, Size::Grains),
        ];
        let scan = |kernels: &[Kernel; 3], items: &dyn Bindable, size| {
            let sizes = [size, Size::One, size];
            let stage = |(kernel, size)| Ok((bind(kernel, &[("items", items)])?, size));
            let stages: Result<Vec<_>, Error> = kernels.iter().zip(sizes).map(stage).collect();
            stages
        };
        stages.extend(scan(&kernels.scan, &starts, Size::CellBlocks)?);
        for kernel in [&kernels.scatter, &kernels.rank, &kernels.count] {
            stages.push((bind(kernel, &[])?, Size::Grains));
        }
        stages.extend(scan(&kernels.scan_pairs, &heads, Size::GrainBlocks)?);
        for kernel in [&kernels.save, &kernels.fill] {
            stages.push((bind(kernel, &[])?, Size::Grains));
        }
        for &array in arrays.histories {
            for kernel in kernels.history.iter().flatten() {
                stages.push((bind(kernel, &[("history", array)])?, Size::Grains));
            }
        }
        let halved = [(arrays.places, 2, 2), (arrays.motions, 2, 2)];
        let whole = arrays.rows.iter().map(|&(array, width)| (array, width, 1));
        for (array, width, halves) in halved.into_iter().chain(whole) {
            let shape = device.array_of("shape", &[Shape { width, halves }])?;
            for kernel in &kernels.rows {
                let more: [(&str, &dyn Bindable); 2] = [("rows", array), ("shape", &shape)];
                stages.push((bind(kernel, &more)?, Size::Grains));
            }
        }
        Ok(Self {
            count: n,
            settle: bind(&kernels.settle, &[])?,
            measure: bind(&kernels.measure, &[])?,
            decide: bind(&kernels.decide, &[])?,
            stages,
            sizes,
            bytes,
        })
    }

    /// Record the check and the search that may follow it: before each group of steps, and
    /// before forces are measured.
    pub fn record(&self, recording: &mut Recording) {
        recording.section("check");
        recording.dispatch(&self.measure, groups(self.count, 256));
        recording.dispatch(&self.decide, [1, 1, 1]);
        recording.section("search");
        for (stage, size) in &self.stages {
            recording.dispatch_indirect(stage, &self.sizes, 3 * *size as usize);
        }
    }

    /// Record the end of a group of steps.
    pub fn settle(&self, recording: &mut Recording) {
        recording.dispatch(&self.settle, [1, 1, 1]);
    }

    /// Scratch of the search [bytes].
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}
