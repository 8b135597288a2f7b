//! How the bed is cut into cells: square along x and y, stretched from wall to wall along z.

use super::{Around, Reach};
use crate::scene::reader::{Range, Table};
use crate::scene::units::LENGTH;

/// Length of a cell in mean diameters where the scene says nothing, and that below which the
/// weights of a grain reach five cells instead of three, and the least and the most.
const DEFAULT: f64 = 2.0;
const WIDE: f64 = 1.5;
const LEAST: f64 = 0.7;
const MOST: f64 = 8.0;
/// The least height of a cell in mean diameters, as far as it can be guessed: below that a grain fills
/// cells.
const THIN: f64 = 0.4;
/// How far the box may be from whole square cells: it is made of whole units of the GPU's
/// positions.
const WHOLE: f64 = 1e-6;

/// Number of cells, their length along x and y [m], and how many of them the weights reach.
pub fn read(water: &Table, around: Option<&Around>) -> Option<([usize; 3], f64, Reach)> {
    let stated = water.quantity("spacing", &LENGTH, Range::Positive);
    let layers = water.integer("layers", 1, "8");
    let around = around?;
    if around.periodic != [true; 2] {
        let what = "stands only in a box that is periodic along x and y";
        water.wrong_here(format!("{what}; leave box.sides out, or remove [water]"));
        return None;
    }
    if water.has("spacing") && stated.is_none() || water.has("layers") && layers.is_none() {
        return None;
    }
    let [nx, ny] = match stated {
        Some(spacing) => along(water, around, spacing)?,
        None => chosen(water, around)?,
    };
    let spacing = around.size[0] / nx as f64;
    if stated.is_none() {
        water.choose("spacing", LENGTH.write(spacing));
    }
    let diameters = spacing / around.diameter;
    if !(LEAST..=MOST).contains(&diameters) {
        let what = format!("is {diameters:.2} mean diameters; the weights of grains need");
        let right = short(DEFAULT * around.diameter);
        let message = format!("{what} {LEAST} to {MOST}, and two are right, {right:?}");
        water.wrong("spacing", message);
        return None;
    }
    let reach = if diameters < WIDE {
        Reach::Five
    } else {
        Reach::Three
    };
    let layers = match (layers, around.cells) {
        (Some(layers), _) => layers as usize,
        (None, Some([.., nz])) => nz,
        (None, None) => (around.height / spacing).round().max(reach.count() as f64) as usize,
    };
    if !water.has("layers") {
        water.choose("layers", layers as i64);
    }
    if layers < reach.count() {
        let n = reach.count();
        let what = format!("is {layers}, and the weights of a grain reach {n} cells");
        water.wrong("layers", format!("{what}; write {n} or more"));
        return None;
    }
    let most = (around.height / (THIN * around.diameter)) as usize;
    if layers > most.max(reach.count()) {
        let what = format!(
            "is {layers}: layers of {:.2e} m, where grains of {:.2e} m would fill cells",
            around.height / layers as f64,
            around.diameter
        );
        let right = around.height / (DEFAULT * around.diameter);
        let right = (right.round() as usize).max(reach.count());
        water.wrong(
            "layers",
            format!("{what}; write {most} at most, and {right} is right"),
        );
        return None;
    }
    let cells = [nx, ny, layers];
    if let Some(own) = around.cells.filter(|own| *own != cells) {
        let what = format!(
            "gives {cells:?} cells along x, y, z, and the water of the state stands in {own:?}; \
             leave spacing and layers out"
        );
        let key = if water.has("spacing") {
            "spacing"
        } else {
            "layers"
        };
        water.wrong(key, what);
        return None;
    }
    Some((cells, spacing, reach))
}

/// Whole numbers of cells of a length that was stated.
fn along(water: &Table, around: &Around, spacing: f64) -> Option<[usize; 2]> {
    let counts = around
        .size
        .map(|length| (length / spacing).round().max(1.0));
    for axis in 0..2 {
        let (length, whole) = (around.size[axis], counts[axis] * spacing);
        if (whole / length - 1.0).abs() > WHOLE {
            let fitting = pairs(around).map(|[nx, _]| around.size[0] / nx as f64);
            let near = fitting.min_by(|a, b| far(*a, spacing).total_cmp(&far(*b, spacing)));
            let remedy = match near {
                Some(near) => format!("write e.g. {:?}", short(near)),
                None => "change box.size to whole cells".into(),
            };
            let along = ["x", "y"][axis];
            let what = format!("does not cut the {} along {along} into", short(length));
            water.wrong("spacing", format!("{what} whole cells; {remedy}"));
            return None;
        }
    }
    Some(counts.map(|n| n as usize))
}

/// The cells that are nearest to the default.
fn chosen(water: &Table, around: &Around) -> Option<[usize; 2]> {
    if let Some([nx, ny, _]) = around.cells {
        return Some([nx, ny]);
    }
    let wanted = DEFAULT * around.diameter;
    let distance = |pair: &[usize; 2]| far(around.size[0] / pair[0] as f64, wanted);
    let best = pairs(around).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    if best.is_none() {
        let [x, y] = around.size.map(short);
        water.wrong_here(format!(
            "needs square cells, and no number of them fits a box of {x} by {y}; change \
             box.size, e.g. to whole multiples of {wanted:.4e} m"
        ));
    }
    best
}

/// All numbers of square cells that are not too small or too large.
fn pairs(around: &Around) -> impl Iterator<Item = [usize; 2]> {
    let [x, y] = around.size;
    let most = (x / (LEAST * around.diameter)) as usize;
    let least = ((x / (MOST * around.diameter)).ceil() as usize).max(1);
    (least..=most).filter_map(move |nx| {
        let spacing = x / nx as f64;
        let ny = (y / spacing).round();
        let square = ny >= 1.0 && (ny * spacing / y - 1.0).abs() < WHOLE;
        square.then_some([nx, ny as usize])
    })
}

/// How far a length is from another, whichever is longer.
fn far(a: f64, b: f64) -> f64 {
    (a / b).ln().abs()
}

/// As it was stated: whole units of the GPU's positions change digits that nobody wrote.
fn short(length: f64) -> String {
    // Seven digits, and those that are not needed left out.
    let rounded = format!("{length:.6e}").parse().unwrap_or(length);
    format!("{rounded} m")
}
