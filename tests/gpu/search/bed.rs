//! Beds for the tests, on the host and on the device.

use super::*;
pub use dem::gpu::fixed::Place;
pub use dem::gpu::search::{INDEX, Motion, SLIDING, TOUCHING};

/// Grains on the host.
#[derive(Clone)]
pub struct Bed {
    pub lengths: [i32; 2],
    pub unit: f32,
    pub step: f32,
    /// Skin [units].
    pub skin: f64,
    /// Bounds of the adapted skin, in parts of the first.
    pub skins: [f32; 2],
    pub places: Vec<Place>,
    pub motions: Vec<Motion>,
}

impl Bed {
    /// `n` grains at random in a box of `size` [units], of radii `radius` times 1 to
    /// `ratio` [units].
    pub fn random(n: usize, size: [i32; 3], periodic: bool, radius: f64, ratio: f64) -> Self {
        let mut dice = Dice(n as u64 + 99);
        let unit = 2f32.powi(-29);
        let mut bed = Self {
            lengths: if periodic { [size[0], size[1]] } else { [0; 2] },
            unit,
            step: 1e-6,
            skin: 0.05 * radius,
            skins: [1.0; 2],
            places: Vec::new(),
            motions: Vec::new(),
        };
        for id in 0..n as u32 {
            let radius = radius * ratio.powf(dice.next());
            let whole = radius.round();
            bed.places.push(Place {
                hi: size.map(|length| (dice.next() * f64::from(length)) as i32),
                radius_hi: whole as i32,
                lo: [0; 3].map(|_: u32| (dice.next() * 4e9) as u32),
                radius_lo: (radius - whole) as f32,
            });
            bed.motions.push(Motion {
                velocity: [0.0; 3],
                radius: (radius * f64::from(unit)) as f32,
                spin: [0.0, 0.0, id as f32],
                id,
            });
        }
        bed
    }

    /// `along` cubed grains of one size on a cubic lattice, each overlapping with six.
    pub fn lattice(along: i32) -> Self {
        let radius = 2_000_000;
        let spacing = 2 * radius - 1000;
        let n = along.pow(3) as usize;
        let mut bed = Self::random(n, [along * spacing; 3], true, f64::from(radius), 1.0);
        for (k, place) in (0..).zip(&mut bed.places) {
            let at = [k % along, k / along % along, k / along.pow(2)];
            place.hi = at.map(|cell| cell * spacing);
        }
        bed
    }

    pub fn len(&self) -> usize {
        self.places.len()
    }

    pub fn setting(&self) -> Setting {
        let radii = self.places.iter().map(|p| p.radius_hi);
        let mean = radii.clone().map(f64::from).sum::<f64>() / self.len() as f64;
        Setting {
            count: self.len(),
            lengths: self.lengths,
            diameter: (2.0 * mean) as i32,
            largest: radii.max().unwrap_or(0) + 1,
            unit: self.unit,
            step: self.step,
            skins: self.skins.map(|skin| skin * self.skin as f32 * self.unit),
            every: 100.0,
        }
    }

    /// Distance of two places [units].
    fn distance(&self, a: &Place, b: &Place) -> f64 {
        let mut square = 0.0;
        for axis in 0..3 {
            let lo = |p: &Place| f64::from(p.lo[axis]) / 2f64.powi(32);
            let mut d = f64::from(a.hi[axis]) - f64::from(b.hi[axis]) + lo(a) - lo(b);
            if axis < 2 && self.lengths[axis] > 0 {
                let length = f64::from(self.lengths[axis]);
                d -= length * (d / length).round();
            }
            square += d * d;
        }
        square.sqrt()
    }

    /// Gap between grains `a` and `b` [units].
    pub fn gap(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (&self.places[a], &self.places[b]);
        let radius = |p: &Place| f64::from(p.radius_hi) + f64::from(p.radius_lo);
        self.distance(a, b) - radius(a) - radius(b)
    }

    /// How far grain `k` went since `then` [units].
    pub fn way(&self, then: &Self, k: usize) -> f64 {
        self.distance(&self.places[k], &then.places[k])
    }

    /// The same grains, the first one last.
    pub fn reversed(&self) -> Self {
        let mut bed = self.clone();
        bed.places.reverse();
        bed.motions.reverse();
        bed
    }
}

/// Grains on the device, with the arrays that follow them.
pub struct World {
    pub device: Device,
    pub setting: Setting,
    pub control: Array<Control>,
    pub places: Array<Place>,
    pub motions: Array<Motion>,
    pub lists: Array<[u32; 2]>,
    pub neighbours: Array<u32>,
    pub springs: Array<[f32; 4]>,
    pub forces: Array<[f32; 4]>,
    /// A row of three vectors that tells the identity.
    pub rows: Array<[u32; 12]>,
    pub search: Search,
}

impl World {
    /// `bed` on `device` at step `base`, with room for this many entries.
    pub fn new(device: &Device, bed: &Bed, base: u32, room: usize) -> Self {
        let n = bed.len();
        let control = Control {
            end: 1_000_000,
            base,
            good: base,
            ..Control::new(32, 1e3, bed.skin as f32 * bed.unit)
        };
        let control = device.array_of("control", &[control]).unwrap();
        let places = device.array("places", 2 * n).unwrap();
        let motions = device.array("motions", 2 * n).unwrap();
        let half = (base & 1) as usize * n;
        device.write(&places, half, &bed.places);
        device.write(&motions, half, &bed.motions);
        let rows: Vec<[u32; 12]> = bed.motions.iter().map(|m| [m.id; 12]).collect();
        let lists = device.array("lists", n).unwrap();
        let neighbours = device.array("neighbours", room).unwrap();
        let springs = device.array("springs", room).unwrap();
        let forces = device.array("forces", room).unwrap();
        let rows = device.array_of("rows", &rows).unwrap();
        let setting = bed.setting();
        let arrays = Arrays {
            control: &control,
            places: &places,
            motions: &motions,
            lists: &lists,
            neighbours: &neighbours,
            histories: &[&springs, &forces],
            rows: &[(&rows, 3)],
        };
        let kernels = &mut kernels(device);
        let search = Search::new(device, kernels, &setting, &arrays, room).unwrap();
        Self {
            device: device.clone(),
            setting,
            control,
            places,
            motions,
            lists,
            neighbours,
            springs,
            forces,
            rows,
            search,
        }
    }

    /// Give lists room for `entries`, of which `touching` touch, and go on.
    pub fn grow(&mut self, entries: usize, touching: usize) {
        let device = &self.device;
        let mut recording = device.record();
        let neighbours = device.array("neighbours", entries).unwrap();
        recording.copy(&self.neighbours, 0, &neighbours, 0, self.neighbours.len());
        self.neighbours = neighbours;
        for array in [&mut self.springs, &mut self.forces] {
            let grown = device.array("history", entries).unwrap();
            recording.copy(array, 0, &grown, 0, array.len());
            *array = grown;
        }
        recording.submit().unwrap();
        let arrays = Arrays {
            control: &self.control,
            places: &self.places,
            motions: &self.motions,
            lists: &self.lists,
            neighbours: &self.neighbours,
            histories: &[&self.springs, &self.forces],
            rows: &[(&self.rows, 3)],
        };
        let kernels = &mut kernels(device);
        self.search = Search::new(device, kernels, &self.setting, &arrays, touching).unwrap();
        self.change(|control| control.flags = 0);
    }

    /// The plan of the search, with room for `touching` entries that touch.
    pub fn plan(&self, touching: usize) -> Array<Plan> {
        let plan = self.setting.plan(self.neighbours.len(), touching);
        self.device.array_of("plan", &[plan]).unwrap()
    }

    pub fn control(&self) -> Control {
        self.device.read(&self.control).unwrap()[0]
    }

    pub fn change(&self, change: impl FnOnce(&mut Control)) {
        let mut control = self.control();
        change(&mut control);
        self.device.write(&self.control, 0, &[control]);
    }

    /// Check, and search if it is due.
    pub fn check(&self) {
        let mut recording = self.device.record();
        self.search.record(&mut recording);
        recording.submit().unwrap();
    }

    /// Search in any case.
    pub fn search(&self) {
        self.change(|control| {
            control.skin = 0.0;
            control.good = control.base;
        });
        self.check();
    }

    /// The grains as they are on the device now.
    pub fn bed(&self, bed: &Bed) -> Bed {
        let n = bed.len();
        let half = (self.control().base & 1) as usize * n;
        Bed {
            places: self.device.read(&self.places).unwrap()[half..half + n].to_vec(),
            motions: self.device.read(&self.motions).unwrap()[half..half + n].to_vec(),
            ..bed.clone()
        }
    }

    /// Words of the neighbours of each grain.
    pub fn neighbours(&self) -> Vec<Vec<u32>> {
        let entries = self.device.read(&self.neighbours).unwrap();
        let lists = self.device.read(&self.lists).unwrap();
        let list = |[first, count]: [u32; 2]| entries[first as usize..][..count as usize].to_vec();
        lists.into_iter().map(list).collect()
    }
}
