//! The overlap of two grains, against integers of 128 bits, wherever in the box they are.

use crate::lab::{Suite, kernel, map};
use bytemuck::{Pod, Zeroable};
use dem::Domain;
use dem::gpu::fixed::{Grid, Place};
use dem::gpu::wide::Wide;
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::{Device, Flags, Kernel};
use std::fmt;

pub fn list(suite: &mut Suite) {
    suite.gpu(
        "overlaps_of_40_nm_in_boxes_of_half_a_metre_and_50_m",
        poster,
    );
    suite.gpu("overlaps_across_the_periodic_seam", seam);
    suite.gpu("overlaps_of_radii_one_to_ten", polydisperse);
    suite.gpu("overlaps_in_boxes_from_1_mm_to_100_m", boxes);
    suite.gpu("grains_apart_are_apart_at_any_distance", distant);
    suite.gpu("both_grains_see_the_same_pair", symmetric);
    suite.gpu("overlaps_with_a_wall", wall);
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Pair {
    i: Place,
    j: Place,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Seen {
    normal: [f32; 3],
    overlap: f32,
    back: [f32; 3],
    overlap_back: f32,
    distance: f32,
    closeness: f32,
    unused: [f32; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Extent {
    length: [i32; 3],
    unit: f32,
}

/// What the exact difference of two places says.
struct Exact {
    normal: DVec3,
    distance: f64,
    overlap: f64,
}

/// A part of a unit in which coordinates and radii of these tests are whole numbers, and
/// squares of reaches fit 128 bits.
const FINE: u32 = 40;

/// From j to i along the shortest way, in parts of 2^-32 unit.
fn shortest(grid: &Grid, pair: &Pair) -> [i128; 3] {
    std::array::from_fn(|axis| {
        let parts = |p: &Place| {
            let (hi, lo) = (p.hi[axis], p.lo[axis]);
            i128::from(Wide { hi, lo }.parts())
        };
        let length = i128::from(grid.length[axis]) << 32;
        let d = parts(&pair.i) - parts(&pair.j);
        match length > 0 {
            true if 2 * d > length => d - length,
            true if 2 * d < -length => d + length,
            _ => d,
        }
    })
}

fn exact(grid: &Grid, pair: &Pair) -> Exact {
    let way = shortest(grid, pair).map(|d| d << (FINE - 32));
    let squared: i128 = way.iter().map(|d| d * d).sum();
    let scale = f64::from(FINE).exp2();
    let radius = |p: &Place| {
        let rest = f64::from(p.radius_lo) * scale;
        (i128::from(p.radius_hi) << FINE) + rest.round() as i128
    };
    let reach = radius(&pair.i) + radius(&pair.j);
    let distance = (squared as f64).sqrt();
    let overlap = (reach * reach - squared) as f64 / (reach as f64 + distance);
    Exact {
        normal: DVec3::from_array(way.map(|d| d as f64)) / distance,
        distance: distance / scale * grid.unit,
        overlap: overlap / scale * grid.unit,
    }
}

/// Largest errors: of the overlap against itself, of the normal, of the distance.
#[derive(Default)]
struct Errors {
    pairs: usize,
    overlap: f64,
    normal: f64,
    distance: f64,
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "largest errors over {} pairs: overlap {:.2e}, normal {:.2e}, distance {:.2e}",
            self.pairs, self.overlap, self.normal, self.distance
        )
    }
}

struct Case {
    /// Length of the box [m], periodic along x and y.
    size: f64,
    radii: [f64; 2],
    overlap: f64,
    /// Do pairs straddle the seam?
    seam: bool,
    pairs: usize,
}

impl Case {
    fn grid(&self) -> Grid {
        let domain = Domain {
            size: [self.size; 2],
            periodic: [true; 2],
        };
        let largest = self.radii[1];
        Grid::new(&domain, self.size, 2.1 * largest).unwrap()
    }

    fn pair(&self, grid: &Grid, random: &mut ChaCha8Rng) -> Pair {
        let mut inside = |margin: f64| random.random_range(margin..self.size - margin);
        let mut centre = DVec3::new(inside(0.0), inside(0.0), inside(self.radii[1]));
        if self.seam {
            centre.x = 0.0;
            centre.y = self.size;
        }
        let mut direction = DVec3::ZERO;
        while !(0.1..1.0).contains(&direction.length()) {
            direction = DVec3::from_array(random.random()) * 2.0 - 1.0;
        }
        let radii: [f64; 2] = std::array::from_fn(|_| match self.radii[0] < self.radii[1] {
            true => random.random_range(self.radii[0]..self.radii[1]),
            false => self.radii[0],
        });
        let apart = direction.normalize() * (radii[0] + radii[1] - self.overlap);
        let along = random.random_range(0.0..1.0);
        Pair {
            i: grid.place(centre + apart * along, radii[0]).unwrap(),
            j: grid
                .place(centre - apart * (1.0 - along), radii[1])
                .unwrap(),
        }
    }

    /// Errors over random pairs, all of which must be symmetric.
    fn run(&self, device: &Device, kernel: &Kernel) -> Errors {
        let grid = self.grid();
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut errors = Errors::default();
        while errors.pairs < self.pairs {
            let count = (self.pairs - errors.pairs).min(1 << 18);
            let pairs: Vec<Pair> = (0..count).map(|_| self.pair(&grid, &mut random)).collect();
            let seen = look(device, kernel, &grid, &pairs);
            for (pair, seen) in pairs.iter().zip(&seen) {
                let exact = exact(&grid, pair);
                // Of the wanted overlap: rounding places and radii moves it by 2^-25 unit.
                let fault = f64::from(seen.overlap) - exact.overlap;
                errors.overlap = errors.overlap.max((fault / exact.overlap).abs());
                let normal = DVec3::from_array(seen.normal.map(f64::from));
                errors.normal = errors.normal.max((normal - exact.normal).length());
                let distance = f64::from(seen.distance) / exact.distance - 1.0;
                errors.distance = errors.distance.max(distance.abs());
                assert_eq!(seen.normal.map(|x| -x), seen.back, "not opposite");
                assert_eq!(seen.overlap.to_bits(), seen.overlap_back.to_bits());
            }
            errors.pairs += count;
        }
        let unit = grid.unit;
        println!(
            "box {} m, radii {:?} m, overlap {:e} m, unit {unit:.3e} m{}: {errors}",
            self.size,
            self.radii,
            self.overlap,
            if self.seam { ", at the seam" } else { "" },
        );
        errors
    }

    fn check(&self, device: &Device) {
        let errors = self.run(device, &compile(device));
        assert!(errors.overlap < 1e-6, "{errors}");
        // Two f32 roundings a component, and those of a reciprocal root.
        assert!(errors.normal < 6e-7 && errors.distance < 6e-7, "{errors}");
    }
}

fn compile(device: &Device) -> Kernel {
    kernel(
        device,
        "overlap.wgsl",
        include_str!("overlap.wgsl"),
        &Flags::new(),
    )
}

fn look(device: &Device, kernel: &Kernel, grid: &Grid, pairs: &[Pair]) -> Vec<Seen> {
    let extent = Extent {
        length: grid.length.to_array(),
        unit: grid.unit as f32,
    };
    let extent = device.array_of("extent", &[extent]).unwrap();
    map(device, kernel, pairs, &[("extent", &extent)])
}

fn poster(device: &Device) {
    for size in [0.5, 50.0] {
        let case = Case {
            size,
            radii: [1e-2; 2],
            overlap: 4e-8,
            seam: false,
            pairs: 1_000_000,
        };
        case.check(device);
    }
}

fn seam(device: &Device) {
    for size in [0.5, 50.0] {
        let case = Case {
            size,
            radii: [1e-2; 2],
            overlap: 4e-8,
            seam: true,
            pairs: 200_000,
        };
        case.check(device);
    }
}

fn polydisperse(device: &Device) {
    for overlap in [4e-9, 4e-8, 1e-4] {
        let case = Case {
            size: 0.5,
            radii: [1e-3, 1e-2],
            overlap,
            seam: false,
            pairs: 200_000,
        };
        case.check(device);
    }
}

fn boxes(device: &Device) {
    for size in [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0] {
        let radius = size / 50.0;
        let case = Case {
            size,
            radii: [radius; 2],
            overlap: 4e-6 * radius,
            seam: false,
            pairs: 100_000,
        };
        case.check(device);
    }
}

/// Pairs that a stale list still holds, or that lie in neighbouring cells: no overflow of the
/// squares makes them touch.
fn distant(device: &Device) {
    let case = Case {
        size: 50.0,
        radii: [1e-3, 1e-2],
        overlap: 0.0,
        seam: false,
        pairs: 100_000,
    };
    let grid = case.grid();
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let place = |random: &mut ChaCha8Rng| {
        let centre = DVec3::from_array(random.random()) * case.size;
        grid.place(centre, case.radii[1]).unwrap()
    };
    let pairs = Vec::from_iter((0..case.pairs).map(|_| Pair {
        i: place(&mut random),
        j: place(&mut random),
    }));
    let seen = look(device, &compile(device), &grid, &pairs);
    let mut touching = 0;
    for (pair, seen) in pairs.iter().zip(&seen) {
        // These are so far apart that f64 is exact enough, and 128 bits would overflow.
        let way = shortest(&grid, pair).map(|d| d as f64 / 2f64.powi(32));
        let distance = DVec3::from_array(way).length() * grid.unit;
        let overlap = 2.0 * case.radii[1] - distance;
        assert_eq!(seen.closeness > 0.0, overlap > 0.0);
        let fault = f64::from(seen.overlap) / overlap - 1.0;
        assert!(fault.abs() < 1e-6, "{seen:?}, exactly {overlap}");
        touching += usize::from(seen.closeness > 0.0);
    }
    println!("{touching} of {} pairs touch", pairs.len());
}

/// Halves of a unit, halves of the box, and carries between the words: the differences from
/// both sides are opposite to the bit.
fn symmetric(device: &Device) {
    let case = Case {
        size: 0.5,
        radii: [1e-2; 2],
        overlap: 4e-8,
        seam: false,
        pairs: 100_000,
    };
    let grid = case.grid();
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let length = grid.length.x;
    let place = |random: &mut ChaCha8Rng| {
        let his = [0, 1, 17, length / 4, length / 2, length / 2 + 1, length - 1];
        let los = [0, 1, 0x7FFF_FFFF, 0x8000_0000, 0x8000_0001, 0xFFFF_FFFF];
        Place {
            hi: std::array::from_fn(|_| his[random.random_range(0..his.len())]),
            lo: std::array::from_fn(|_| los[random.random_range(0..los.len())]),
            radius_hi: 2_684_354,
            radius_lo: 0.25,
        }
    };
    let pairs = Vec::from_iter((0..case.pairs).map(|_| Pair {
        i: place(&mut random),
        j: place(&mut random),
    }));
    let mut halves = 0;
    let seen = look(device, &compile(device), &grid, &pairs);
    for (pair, seen) in pairs.iter().zip(&seen) {
        let [i, j] = [pair.i, pair.j];
        if (i.hi, i.lo) == (j.hi, j.lo) {
            continue;
        }
        let halved = |axis: usize| i.lo[axis].wrapping_sub(j.lo[axis]) == 1 << 31;
        halves += usize::from((0..3).any(halved));
        assert_eq!(seen.normal.map(|x| -x), seen.back, "{i:?}, {j:?}");
        assert_eq!(seen.overlap.to_bits(), seen.overlap_back.to_bits());
        // Half a box away either image is the nearest, but the distance is the same.
        let way = shortest(&grid, pair).map(|d| d as f64 / 2f64.powi(32));
        let distance = DVec3::from_array(way).length() * grid.unit;
        assert!(
            (f64::from(seen.distance) / distance - 1.0).abs() < 6e-7,
            "{i:?}, {j:?}"
        );
    }
    println!("{halves} of {} pairs with a half of a unit", pairs.len());
    assert!(halves > 1000);
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Near {
    place: Place,
    wall: Wide,
    side: i32,
    unit: f32,
}

/// Walls of both kinds, anywhere: the only rounding is that of the rest of a unit.
fn wall(device: &Device) {
    let text = "
        #import dem::fixed::{Place, wall_overlap}
        #import dem::wide::Wide
        struct Near { place: Place, wall: Wide, side: i32, unit: f32 }
        @group(0) @binding(0) var<storage, read> inputs: array<Near>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<f32>;
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            if id.x < arrayLength(&inputs) {
                let near = inputs[id.x];
                let x = Wide(near.place.hi.z, near.place.lo.z);
                outputs[id.x] = wall_overlap(x, near.place.radius_hi, near.place.radius_lo, near.wall, near.side, near.unit);
            }
        }";
    let kernel = kernel(device, "wall.wgsl", text, &Flags::new());
    for size in [1e-3, 0.5, 50.0] {
        let case = Case {
            size,
            radii: [size / 50.0; 2],
            overlap: 4e-6 * size / 50.0,
            seam: false,
            pairs: 100_000,
        };
        let grid = case.grid();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let near = Vec::from_iter((0..case.pairs).map(|k| {
            let z = random.random_range(0.0..size);
            let side = if k % 2 == 0 { 1 } else { -1 };
            let wall = z - f64::from(side) * (case.radii[0] - case.overlap);
            Near {
                place: grid.place(DVec3::new(0.0, 0.0, z), case.radii[0]).unwrap(),
                wall: grid.coordinate(wall).unwrap(),
                side,
                unit: grid.unit as f32,
            }
        }));
        let overlaps: Vec<f32> = map(device, &kernel, &near, &[]);
        let mut largest = 0f64;
        for (near, overlap) in near.iter().zip(&overlaps) {
            let (hi, lo) = (near.place.hi[2], near.place.lo[2]);
            let way = Wide { hi, lo }.parts() - near.wall.parts();
            let rest = f64::from(near.place.radius_lo) * 2f64.powi(32);
            let whole = (i64::from(near.place.radius_hi) << 32) - i64::from(near.side) * way;
            let exact = (whole as f64 + rest) / 2f64.powi(32) * grid.unit;
            largest = largest.max((f64::from(*overlap) / exact - 1.0).abs());
        }
        println!("wall in a box of {size} m: largest relative error {largest:.2e}");
        assert!(largest < 1e-6);
    }
}
