//! Text dumps of the style `custom`.

use super::{Corners, Lines, Row, bed, check_tilt, check_units, number, vector};
use crate::bed::Bed;
use anyhow::{Context, Result, bail, ensure};
use std::path::Path;

/// Read the last frame of the dump at `path`.
pub fn read_dump(path: &Path) -> Result<Bed> {
    let mut lines = Lines::open(path)?;
    let mut count = 0;
    let mut corners = Corners::unknown();
    let mut rows = Vec::new();
    while let Some(line) = lines.next()? {
        let words: Vec<_> = line.split_whitespace().collect();
        match words[..] {
            ["ITEM:", "UNITS"] => check_units(lines.need()?.trim())?,
            ["ITEM:", "NUMBER", "OF", "ATOMS"] => {
                count = number(lines.need()?.trim()).with_context(|| lines.place())?;
            }
            ["ITEM:", "BOX", "BOUNDS", ref sides @ ..] => corners = read_bounds(&mut lines, sides)?,
            ["ITEM:", "ATOMS", ref names @ ..] => {
                let columns = Columns::of(names).with_context(|| lines.place())?;
                rows.clear();
                for _ in 0..count {
                    let line = lines.need()?;
                    let words: Vec<_> = line.split_whitespace().collect();
                    rows.push(columns.row(&words).with_context(|| lines.place())?);
                }
            }
            // Time step, time: not part of a bed.
            _ => {}
        }
    }
    bed(rows, corners)
}

/// The three lines below `ITEM: BOX BOUNDS`; `sides` such as `pp pp ff`, after the names
/// of the tilts if there are any.
fn read_bounds(lines: &mut Lines, sides: &[&str]) -> Result<Corners> {
    let mut corners = Corners::unknown();
    for axis in 0..3 {
        let line = lines.need()?;
        let place = || lines.place();
        let words: Vec<_> = line.split_whitespace().collect();
        let [low, high, ref tilt @ ..] = words[..] else {
            bail!(
                "{}: a side of the box has a lower and an upper end",
                place()
            );
        };
        check_tilt(tilt).with_context(place)?;
        corners.low[axis] = number(low).with_context(place)?;
        corners.high[axis] = number(high).with_context(place)?;
        let side = sides.len().checked_sub(3 - axis).map(|k| sides[k]);
        corners.periodic[axis] = side == Some("pp");
    }
    Ok(corners)
}

/// Where each quantity stands in a line of a dump.
struct Columns {
    id: usize,
    position: [usize; 3],
    radius: usize,
    /// Radius over what the file gives: 1/2 if that is the diameter.
    factor: f64,
    velocity: Option<[usize; 3]>,
    angular_velocity: Option<[usize; 3]>,
    width: usize,
}

impl Columns {
    fn of(names: &[&str]) -> Result<Self> {
        let find = |name: &str| names.iter().position(|n| *n == name);
        let vector = |names: [&str; 3]| {
            let [x, y, z] = names.map(find);
            Some([x?, y?, z?])
        };
        let position = vector(["x", "y", "z"]).or_else(|| vector(["xu", "yu", "zu"]));
        let radius = find("radius").map(|place| (place, 1.0));
        let radius = radius.or_else(|| find("diameter").map(|place| (place, 0.5)));
        let lacks = |what: &str| format!("the dump lacks {what}; it has {}", names.join(" "));
        let (radius, factor) = radius.with_context(|| lacks("radius (or diameter)"))?;
        Ok(Self {
            id: find("id").with_context(|| lacks("id"))?,
            position: position.with_context(|| lacks("x y z (or xu yu zu)"))?,
            radius,
            factor,
            velocity: vector(["vx", "vy", "vz"]),
            angular_velocity: vector(["omegax", "omegay", "omegaz"]),
            width: names.len(),
        })
    }

    fn row(&self, words: &[&str]) -> Result<Row> {
        let n = words.len();
        ensure!(n == self.width, "{n} numbers, {} are named", self.width);
        let at = |places: [usize; 3]| vector(places.map(|place| &words[place]));
        Ok(Row {
            id: number(words[self.id])?,
            position: at(self.position)?,
            radius: self.factor * number::<f64>(words[self.radius])?,
            velocity: self.velocity.map(at).transpose()?,
            angular_velocity: self.angular_velocity.map(at).transpose()?,
        })
    }
}
