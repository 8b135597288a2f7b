//! `[water.solid]`: cells filled by the grains of a bed, cut to the box of the scene.

use super::Lattice;
use crate::output::state;
use crate::scene::reader::{Range, Table};
use crate::scene::units::LENGTH;
use glam::DVec3;

const SOLID: &str = "[water.solid] with bed = \"bed.csv\", or state = \"state.h5\"";

/// Spheres, and the lengths of the periodic box that they were made in [m].
struct Packing {
    centre: Vec<DVec3>,
    radius: Vec<f64>,
    period: [Option<f64>; 3],
}

/// Which cells are solid; empty: none. `periodic`: is the water, along each axis?
pub fn read(water: &Table, lattice: &Lattice, periodic: [bool; 3]) -> Option<Vec<bool>> {
    if !water.has("solid") {
        return Some(Vec::new());
    }
    let table = water.table("solid", SOLID)?;
    let corner = corner(&table);
    let mut packing = packing(&table)?;
    // Where a file says nothing of a box, it is that of the scene.
    for (axis, period) in packing.period.iter_mut().enumerate().take(2) {
        let of_scene = periodic[axis].then(|| lattice.size()[axis]);
        *period = period.or(of_scene);
    }
    let solid = voxels(&packing, lattice, corner?);
    let filled = solid.iter().filter(|&&solid| solid).count();
    if filled == 0 || filled == solid.len() {
        let what = if filled == 0 {
            "no grain fills a cell"
        } else {
            "grains fill all cells"
        };
        table.wrong_here(format!("{what} of the box; look at box.size and corner"));
        return None;
    }
    Some(solid)
}

fn corner(table: &Table) -> Option<DVec3> {
    if !table.has("corner") {
        table.choose("corner", toml_edit::Array::from_iter(["0 m"; 3]));
        return Some(DVec3::ZERO);
    }
    let corner = table.quantities("corner", &LENGTH, Range::Any)?;
    let count = corner.len();
    let wrong = |_| {
        let what = "write three: where in the bed the box begins along x, y, z";
        table.wrong("corner", format!("has {count} lengths; {what}"));
    };
    corner.try_into().map_err(wrong).ok().map(DVec3::from_array)
}

fn packing(table: &Table) -> Option<Packing> {
    let cannot = |key, error| table.wrong(key, format!("cannot be read: {error:#}"));
    match table.present(&["bed", "state"])[..] {
        ["bed"] => {
            let path = table.path("bed")?;
            let bed = crate::bed::read(&path)
                .map_err(|error| cannot("bed", error))
                .ok()?;
            Some(Packing {
                period: bed
                    .size
                    .map_or([None; 3], |[x, y, _]| [Some(x), Some(y), None]),
                centre: bed.position,
                radius: bed.radius,
            })
        }
        ["state"] => {
            let path = table.path("state")?;
            let saved = state::load(&path)
                .map_err(|error| cannot("state", error))
                .ok()?;
            let (domain, grains) = (saved.domain, saved.state.grains);
            let period = |axis: usize| domain.periodic[axis].then_some(domain.size[axis]);
            Some(Packing {
                period: [period(0), period(1), None],
                centre: grains.position,
                radius: grains.radius,
            })
        }
        [] => {
            table.wrong_here(format!("names no file; write e.g. {SOLID}"));
            None
        }
        _ => {
            table.wrong("bed", "contradicts state; remove one of them".into());
            None
        }
    }
}

/// Cells whose middle lies in a sphere or in one of its periodic images; `corner` [m] is where
/// the lattice begins.
fn voxels(packing: &Packing, lattice: &Lattice, corner: DVec3) -> Vec<bool> {
    let cells = lattice.cells;
    let mut solid = vec![false; cells.iter().product()];
    for (&centre, &radius) in packing.centre.iter().zip(&packing.radius) {
        let own = (centre - corner).to_array();
        let images = [0, 1, 2].map(|axis| {
            let (size, period) = (lattice.size()[axis], packing.period[axis]);
            images(own[axis], radius, size, period)
        });
        for &x in &images[0] {
            for &y in &images[1] {
                for &z in &images[2] {
                    fill(&mut solid, lattice, [x, y, z], radius);
                }
            }
        }
    }
    solid
}

/// Places along one axis where a sphere or an image of it reaches into the box from 0 to `size`.
fn images(place: f64, radius: f64, size: f64, period: Option<f64>) -> Vec<f64> {
    let reaches = |x: &f64| x + radius > 0.0 && x - radius < size;
    let Some(period) = period else {
        return [place].into_iter().filter(reaches).collect();
    };
    let first = ((-radius - place) / period).floor();
    let last = ((size + radius - place) / period).ceil();
    let count = (last - first) as usize;
    let each = (0..=count).map(|k| place + (first + k as f64) * period);
    each.filter(reaches).collect()
}

fn fill(solid: &mut [bool], lattice: &Lattice, centre: [f64; 3], radius: f64) {
    let (dx, cells) = (lattice.spacing, lattice.cells);
    let range = |axis: usize| {
        let low = ((centre[axis] - radius) / dx - 0.5).ceil().max(0.0) as usize;
        let high = ((centre[axis] + radius) / dx + 0.5).floor().max(0.0) as usize;
        low..high.min(cells[axis])
    };
    let away = |axis: usize, k: usize| ((k as f64 + 0.5) * dx - centre[axis]).powi(2);
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                if away(0, x) + away(1, y) + away(2, z) < radius * radius {
                    solid[(z * cells[1] + y) * cells[0] + x] = true;
                }
            }
        }
    }
}

impl Lattice {
    /// One line about cells filled by grains.
    pub fn describe_solid(&self, solid: &[bool]) -> String {
        let filled = solid.iter().filter(|&&solid| solid).count();
        let porosity = 1.0 - filled as f64 / solid.len() as f64;
        format!(
            "{filled} solid cells of {}, porosity {porosity:.4}",
            solid.len()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere on a corner of a periodic box is there once, in eight parts (four and a half
    /// sphere where z is not periodic).
    #[test]
    fn periodic_images_make_a_cut_sphere_whole() {
        let lattice = Lattice {
            cells: [40, 40, 40],
            spacing: 0.025,
        };
        let at = |centre| {
            let packing = Packing {
                centre: vec![centre],
                radius: vec![0.3],
                period: [Some(1.0), Some(1.0), None],
            };
            let solid = voxels(&packing, &lattice, DVec3::ZERO);
            solid.iter().filter(|&&solid| solid).count()
        };
        let middle = at(DVec3::splat(0.5));
        let exact = 4.0 / 3.0 * std::f64::consts::PI * (0.3f64 / 0.025).powi(3);
        assert!(
            (middle as f64 / exact - 1.0).abs() < 0.01,
            "{middle} {exact}"
        );
        assert_eq!(at(DVec3::new(0.0, 1.0, 0.5)), middle);
        assert_eq!(at(DVec3::new(3.0, -2.0, 0.5)), middle);
        assert_eq!(at(DVec3::new(0.5, 0.5, 0.0)) * 2, middle);
    }

    #[test]
    fn a_box_may_be_cut_from_the_bed_or_be_larger_than_it() {
        let packing = Packing {
            centre: vec![DVec3::splat(0.5)],
            radius: vec![0.3],
            period: [Some(1.0), Some(1.0), None],
        };
        let count = |cells: [usize; 3], corner| {
            let lattice = Lattice {
                cells,
                spacing: 0.05,
            };
            let solid = voxels(&packing, &lattice, corner);
            solid.iter().filter(|&&solid| solid).count()
        };
        let whole = count([20; 3], DVec3::ZERO);
        assert_eq!(count([40, 20, 20], DVec3::ZERO), 2 * whole);
        assert_eq!(2 * count([10, 20, 20], DVec3::ZERO), whole);
        assert_eq!(2 * count([10, 20, 20], DVec3::new(0.5, 0.0, 0.0)), whole);
    }
}
