//! Beds as comma-separated values, SI units. A header names the columns: `x`, `y`, `z`,
//! `radius`, and if present `vx`, `vy`, `vz` (velocity) and `wx`, `wy`, `wz` (angular
//! velocity), in any order. Lines that begin with `#` are comments.

use super::Bed;
use anyhow::{Context, Result, bail, ensure};
use csv::{ReaderBuilder, StringRecord, Trim};
use glam::DVec3;
use std::path::Path;

const POSITION: [&str; 3] = ["x", "y", "z"];
const RADIUS: &str = "radius";
const VELOCITY: [&str; 3] = ["vx", "vy", "vz"];
const ANGULAR_VELOCITY: [&str; 3] = ["wx", "wy", "wz"];

/// Read the bed at `path`.
pub fn read(path: &Path) -> Result<Bed> {
    let mut reader = ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_path(path)?;
    let columns = Columns::of(reader.headers()?)?;
    let mut bed = Bed {
        velocity: columns.velocity.map(|_| Vec::new()),
        angular_velocity: columns.angular_velocity.map(|_| Vec::new()),
        ..Bed::default()
    };
    for record in reader.records() {
        let record = record?;
        bed.position.push(vector(&record, columns.position)?);
        bed.radius.push(number(&record, columns.radius)?);
        if let (Some(values), Some(places)) = (&mut bed.velocity, columns.velocity) {
            values.push(vector(&record, places)?);
        }
        if let (Some(values), Some(places)) = (&mut bed.angular_velocity, columns.angular_velocity)
        {
            values.push(vector(&record, places)?);
        }
    }
    Ok(bed)
}

/// Where each quantity stands in a record.
struct Columns {
    position: [usize; 3],
    radius: usize,
    velocity: Option<[usize; 3]>,
    angular_velocity: Option<[usize; 3]>,
}

impl Columns {
    fn of(header: &StringRecord) -> Result<Self> {
        let known = [&POSITION[..], &[RADIUS], &VELOCITY, &ANGULAR_VELOCITY].concat();
        for (k, name) in header.iter().enumerate() {
            ensure!(
                known.contains(&name),
                "line {}: no column is called \"{name}\"; the header names {}",
                line(header),
                known.join(", ")
            );
            let twice = header.iter().take(k).any(|earlier| earlier == name);
            ensure!(
                !twice,
                "line {}: two columns are called {name}",
                line(header)
            );
        }
        let find = |name: &str| header.iter().position(|column| column == name);
        let need = |name: &str| {
            let missing = || format!("line {}: the header lacks {name}", line(header));
            find(name).with_context(missing)
        };
        let vector = |names: [&str; 3]| {
            let [x, y, z] = names.map(need);
            anyhow::Ok([x?, y?, z?])
        };
        let optional = |names: [&str; 3]| match names.iter().any(|name| find(name).is_some()) {
            true => vector(names).map(Some),
            false => Ok(None),
        };
        Ok(Self {
            position: vector(POSITION)?,
            radius: need(RADIUS)?,
            velocity: optional(VELOCITY)?,
            angular_velocity: optional(ANGULAR_VELOCITY)?,
        })
    }
}

fn vector(record: &StringRecord, places: [usize; 3]) -> Result<DVec3> {
    let [x, y, z] = places.map(|place| number(record, place));
    Ok(DVec3::new(x?, y?, z?))
}

fn number(record: &StringRecord, place: usize) -> Result<f64> {
    let text = &record[place];
    let Ok(value) = text.parse() else {
        bail!("line {}: \"{text}\" is not a number", line(record));
    };
    Ok(value)
}

fn line(record: &StringRecord) -> u64 {
    record.position().map_or(1, |position| position.line())
}

#[cfg(test)]
mod tests {
    use super::super::tests::{read_text, refusal};
    use super::*;

    #[test]
    fn columns_may_stand_in_any_order() {
        let bed = read_text(
            "# settled by hand\n\
             radius, x, y, z, wx, wy, wz\n\
             0.01, 1, 2, 3, 4, 5, 6\n\
             2e-2, 7, 8, 9, 10, 11, 12\n",
        );
        let expected = Bed {
            position: vec![DVec3::new(1.0, 2.0, 3.0), DVec3::new(7.0, 8.0, 9.0)],
            radius: vec![0.01, 0.02],
            velocity: None,
            angular_velocity: Some(vec![
                DVec3::new(4.0, 5.0, 6.0),
                DVec3::new(10.0, 11.0, 12.0),
            ]),
            size: None,
        };
        assert_eq!(bed.unwrap(), expected);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let cases = [
            (
                "x,y,z,radius\n1,2,3,0.1\n1,2,3,wide\n",
                "line 3: \"wide\" is not a number",
            ),
            ("x,y,z,radius\n1,2,3\n", "line: 2"),
            ("x,y,radius\n", "line 1: the header lacks z"),
            ("x,y,z,radius,vx\n", "line 1: the header lacks vy"),
            (
                "x,y,z,diameter\n",
                "line 1: no column is called \"diameter\"",
            ),
            ("x,y,z,radius,x\n", "line 1: two columns are called x"),
        ];
        for (text, expected) in cases {
            let error = refusal(text);
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
