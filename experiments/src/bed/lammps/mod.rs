//! Beds from LAMMPS, in units `si`: data files of `atom_style sphere`, and text dumps
//! with `id`, `x`, `y`, `z` (or `xu`, `yu`, `zu`), `radius` (or `diameter`) and, if
//! present, `vx`, `vy`, `vz` and `omegax`, `omegay`, `omegaz`; the last frame counts.
//!
//! Grains are taken in the order of their id, and the lower corner of the box becomes the
//! origin. Boxes must not be tilted.

mod data;
mod dump;

pub use data::{counts_atoms, read_data};
pub use dump::read_dump;

use super::Bed;
use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::str::FromStr;

/// A grain as a line tells it.
struct Row {
    id: u64,
    position: DVec3,
    radius: f64,
    velocity: Option<DVec3>,
    angular_velocity: Option<DVec3>,
}

/// The box: lower and upper corner, and along which axes it is known to be periodic.
#[derive(Clone, Copy, Debug)]
struct Corners {
    low: DVec3,
    high: DVec3,
    periodic: [bool; 3],
}

impl Corners {
    fn unknown() -> Self {
        Self {
            low: DVec3::NAN,
            high: DVec3::NAN,
            periodic: [false; 3],
        }
    }

    /// The place relative to the lower corner, wrapped into the box along periodic sides.
    fn inside(&self, place: DVec3) -> DVec3 {
        let size = self.high - self.low;
        let wrapped = |axis: usize| {
            let x = (place - self.low)[axis];
            let around = x.rem_euclid(size[axis]);
            match self.periodic[axis] {
                false => x,
                // Rounding may lift a small negative number to the far side.
                true if around == size[axis] => 0.0,
                true => around,
            }
        };
        DVec3::new(wrapped(0), wrapped(1), wrapped(2))
    }
}

/// The bed of `rows` in `corners`.
fn bed(mut rows: Vec<Row>, corners: Corners) -> Result<Bed> {
    ensure!(
        corners.low.is_finite() && corners.high.is_finite(),
        "it has no box"
    );
    rows.sort_by_key(|row| row.id);
    if let Some(pair) = rows.windows(2).find(|pair| pair[0].id == pair[1].id) {
        bail!("two grains have the id {}", pair[0].id);
    }
    Ok(Bed {
        position: rows
            .iter()
            .map(|row| corners.inside(row.position))
            .collect(),
        radius: rows.iter().map(|row| row.radius).collect(),
        velocity: rows.iter().map(|row| row.velocity).collect(),
        angular_velocity: rows.iter().map(|row| row.angular_velocity).collect(),
        size: Some((corners.high - corners.low).to_array()),
    })
}

fn check_units(units: &str) -> Result<()> {
    ensure!(
        units == "si",
        "it is in LAMMPS units {units}; convert it to units si"
    );
    Ok(())
}

fn check_tilt(tilt: &[&str]) -> Result<()> {
    for word in tilt {
        ensure!(
            number::<f64>(word)? == 0.0,
            "the box is tilted by {word}; only upright boxes can be read"
        );
    }
    Ok(())
}

fn vector(words: [&&str; 3]) -> Result<DVec3> {
    let [x, y, z] = words.map(|word| number(word));
    Ok(DVec3::new(x?, y?, z?))
}

fn number<T: FromStr>(word: &str) -> Result<T> {
    let parsed = word.parse().ok();
    parsed.with_context(|| format!("\"{word}\" is not a number of the kind that belongs here"))
}

/// The line without its comment.
fn uncommented(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

/// The lines of a file, counted.
struct Lines {
    input: std::io::Lines<BufReader<File>>,
    /// Number of the last line, from 1.
    number: usize,
}

impl Lines {
    fn open(path: &Path) -> Result<Self> {
        let input = BufReader::new(File::open(path)?).lines();
        Ok(Self { input, number: 0 })
    }

    fn next(&mut self) -> Result<Option<String>> {
        self.number += 1;
        Ok(self.input.next().transpose()?)
    }

    /// The next line, which must be there.
    fn need(&mut self) -> Result<String> {
        let ended = "the file ends within a frame; delete the unfinished one";
        self.next()?.context(ended)
    }

    fn place(&self) -> String {
        format!("line {}", self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{read_text, refusal};
    use super::*;

    const DATA: &str = "\
LAMMPS data file via write_data, version 22 Jul 2025, timestep = 100, units = si

2 atoms
1 atom types

1 5 xlo xhi
0 3 ylo yhi
-1 9 zlo zhi

Atoms # sphere

2 1 0.2 2500 4.5 2 3 0 1 0
1 1 0.1 2500 1.5 1 0 0 0 0

Velocities

1 1 2 3 4 5 6
2 7 8 9 10 11 12
";

    const DUMP: &str = "\
ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS pp pp ff
0 1
0 1
0 1
ITEM: ATOMS id x y z radius
7 0.5 0.5 0.5 0.25
ITEM: TIMESTEP
100
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS pp pp ff
1 5
0 3
-1 9
ITEM: ATOMS id type xu yu zu diameter vx vy vz omegax omegay omegaz
2 1 12.5 -1 3 0.2 7 8 9 10 11 12
1 1 1.5 1 -2 0.1 1 2 3 4 5 6
";

    fn v(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// The bed of both files: in the order of the ids, corner at the origin.
    fn expected(z: f64) -> Bed {
        Bed {
            position: vec![v(0.5, 1.0, z), v(3.5, 2.0, 4.0)],
            radius: vec![0.05, 0.1],
            velocity: Some(vec![v(1.0, 2.0, 3.0), v(7.0, 8.0, 9.0)]),
            angular_velocity: Some(vec![v(4.0, 5.0, 6.0), v(10.0, 11.0, 12.0)]),
            size: Some([4.0, 3.0, 10.0]),
        }
    }

    #[test]
    fn a_data_file_gives_its_grains_in_order_and_the_box_at_the_origin() {
        assert_eq!(read_text(DATA).unwrap(), expected(1.0));
        let (still, _) = DATA.split_once("Velocities").unwrap();
        let bed = read_text(still).unwrap();
        assert_eq!((bed.velocity, bed.angular_velocity), (None, None));
    }

    #[test]
    fn a_dump_gives_its_last_frame_wrapped_along_periodic_sides() {
        // Along z, which is not periodic, a grain may be outside.
        assert_eq!(read_text(DUMP).unwrap(), expected(-1.0));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let data = [
            ("units = si", "units = cgs", "units cgs; convert"),
            ("# sphere", "# atomic", "line 10: atoms of the style atomic"),
            ("0.2 2500", "wide 2500", "line 12: \"wide\" is not a number"),
            (
                " 4.5 2 3 0 1 0",
                " 4.5",
                "line 12: an atom of the style sphere has id",
            ),
            (
                "Atoms",
                "0.1 0 0 xy xz yz\n\nAtoms",
                "line 10: the box is tilted by 0.1",
            ),
            ("0 3 ylo yhi", "", "no box"),
            (
                "1 1 0.1 2500 1.5 1 0 0 0 0\n",
                "",
                "1 of 2 atoms found, the last on line 12, where line 3 promises 2",
            ),
            ("2 7 8 9 10 11 12\n", "", "grain 2 has no velocity"),
            ("\n2 1 0.2", "\n1 1 0.2", "two grains have the id 1"),
        ];
        let dump = [
            ("12.5", "east", "line 20: \"east\" is not a number"),
            (" 12\n", "\n", "line 20: 11 numbers, 12 are named"),
            ("diameter", "mass", "line 19: the dump lacks radius"),
            ("1 1 1.5 1 -2 0.1 1 2 3 4 5 6\n", "", "ends within a frame"),
            (
                "ITEM: TIMESTEP\n0",
                "ITEM: UNITS\nreal",
                "units real; convert",
            ),
            ("0 3\n", "0 3 0.1\n", "line 17: the box is tilted by 0.1"),
        ];
        for (file, slips) in [(DATA, &data[..]), (DUMP, &dump[..])] {
            for (right, wrong, expected) in slips {
                assert!(file.contains(right), "{right}");
                let error = refusal(&file.replace(right, wrong));
                assert!(error.contains(expected), "{expected}: {error}");
            }
        }
    }
}
