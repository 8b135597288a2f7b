//! Beds from the binary files of `sphere`, version 2.11.
//!
//! Little-endian, without padding; f64 is a double, u32 an unsigned integer:
//!
//! ```text
//! f64     version 2.11                 u32     dimensions 3
//! u32     number of grains n           f64 x 4 step, time, end, interval
//! u32     number of outputs            f64 x 3 origin of the box
//! f64 x 3 size of the box              u32 x 3 cells of the search
//! u32     periodic sides
//! f64 x n x 4 x, y, z, radius          f64 x n x 3 way travelled
//! f64 x n x 4 velocity, constraint     f64 x n x 3 force
//! f64 x n x 3 angle                    f64 x n x 3 angular velocity
//! ```
//!
//! What follows (torques, energies, laws, walls, bonds, fluid) is not part of a bed.
//!
//! Source: worked out from descriptions and from a file of the program's public repository,
//! `output/init-1e4.output00199.bin` in github.com/klkkong/sphere, a fork of anders-dc/sphere;
//! read in this way it gives 10 000 grains with radii of 9.66 to 10.38 mm, none of which overlap
//! by more than a part in 2000. None of sphere's code, which is GPL-3, is here.

use super::Bed;
use anyhow::{Context, Result, ensure};
use glam::DVec3;
use std::path::Path;

const VERSION: f64 = 2.11;

/// The version in the first bytes of a file, if it may be one of `sphere`: a number with
/// two decimals, and then three dimensions.
pub fn version(start: &[u8]) -> Option<f64> {
    let version = f64::from_le_bytes(*start.first_chunk()?);
    let dimensions = u32::from_le_bytes(*start.get(8..)?.first_chunk()?);
    let hundredths = version * 100.0;
    let plausible =
        (0.5..10.0).contains(&version) && (hundredths - hundredths.round()).abs() < 1e-9;
    (plausible && dimensions == 3).then_some(version)
}

/// Read the bed at `path`.
pub fn read(path: &Path) -> Result<Bed> {
    let bytes = std::fs::read(path)?;
    let mut input = Input { rest: &bytes };
    let [version] = input.doubles()?;
    ensure!(
        version == VERSION,
        "it is of sphere's version {version}, only {VERSION} can be read; \
         write it anew with that version"
    );
    let [_dimensions, n] = input.integers()?;
    let [_step, _time, _end, _interval] = input.doubles()?;
    let [_outputs] = input.integers()?;
    let origin = DVec3::from_array(input.doubles()?);
    let size = input.doubles()?;
    let [_nx, _ny, _nz, _periodic] = input.integers()?;

    let mut bed = Bed {
        size: Some(size),
        ..Bed::default()
    };
    for _ in 0..n {
        let [x, y, z, radius] = input.doubles()?;
        bed.position.push(DVec3::new(x, y, z) - origin);
        bed.radius.push(radius);
    }
    let _travelled = input.vectors(n)?;
    let with_constraint = (0..n).map(|_| input.doubles());
    let velocity = with_constraint.map(|row| row.map(|[x, y, z, _]| DVec3::new(x, y, z)));
    bed.velocity = Some(velocity.collect::<Result<_>>()?);
    let _force = input.vectors(n)?;
    let _angle = input.vectors(n)?;
    bed.angular_velocity = Some(input.vectors(n)?);
    Ok(bed)
}

/// The part of a file that was not read yet.
struct Input<'a> {
    rest: &'a [u8],
}

impl Input<'_> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N]> {
        let ended = "it ends too early: fewer grains than it says";
        let (value, rest) = self.rest.split_first_chunk().context(ended)?;
        self.rest = rest;
        Ok(*value)
    }

    fn doubles<const N: usize>(&mut self) -> Result<[f64; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = f64::from_le_bytes(self.bytes()?);
        }
        Ok(values)
    }

    fn integers<const N: usize>(&mut self) -> Result<[u32; N]> {
        let mut values = [0; N];
        for value in &mut values {
            *value = u32::from_le_bytes(self.bytes()?);
        }
        Ok(values)
    }

    fn vectors(&mut self, n: u32) -> Result<Vec<DVec3>> {
        (0..n)
            .map(|_| self.doubles().map(DVec3::from_array))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::read as read_any;
    use super::*;
    use std::fs;

    /// A file of two grains in the layout of `version`; every number is a different one.
    fn file(version: f64) -> Vec<u8> {
        let mut bytes = Vec::new();
        let doubles = |bytes: &mut Vec<u8>, values: &[f64]| {
            values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        };
        let integers = |bytes: &mut Vec<u8>, values: &[u32]| {
            values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        };
        doubles(&mut bytes, &[version]);
        integers(&mut bytes, &[3, 2]);
        doubles(&mut bytes, &[1e-6, 0.5, 1.0, 0.1]);
        integers(&mut bytes, &[5]);
        doubles(&mut bytes, &[1.0, 0.0, 0.0, 0.4, 0.5, 0.6]);
        integers(&mut bytes, &[4, 5, 6, 1]);
        // From x to the angular velocities: 4 + 3 + 4 + 3 + 3 + 3 numbers a grain.
        let numbers: Vec<_> = (1..=40).map(|k| f64::from(k) / 16.0).collect();
        doubles(&mut bytes, &numbers);
        // Torques and the rest.
        doubles(&mut bytes, &[99.0; 30]);
        bytes
    }

    fn read_bytes(bytes: &[u8]) -> Result<Bed> {
        let dir = tempfile::tempdir()?;
        let path = dir.path().join("sphere.bin");
        fs::write(&path, bytes)?;
        read_any(&path)
    }

    #[test]
    fn grains_stand_where_the_layout_says() {
        let v = |x: i32, y: i32, z: i32| DVec3::new(x.into(), y.into(), z.into()) / 16.0;
        let origin = DVec3::X;
        let expected = Bed {
            position: vec![v(1, 2, 3) - origin, v(5, 6, 7) - origin],
            radius: vec![4.0 / 16.0, 8.0 / 16.0],
            // Behind two times 3 numbers of the way travelled.
            velocity: Some(vec![v(15, 16, 17), v(19, 20, 21)]),
            // Behind forces and angles.
            angular_velocity: Some(vec![v(35, 36, 37), v(38, 39, 40)]),
            size: Some([0.4, 0.5, 0.6]),
        };
        assert_eq!(read_bytes(&file(2.11)).unwrap(), expected);
    }

    #[test]
    fn other_versions_and_short_files_are_refused() {
        let error = format!("{:#}", read_bytes(&file(2.15)).unwrap_err());
        assert!(error.contains("version 2.15, only 2.11"), "{error}");
        let whole = file(2.11);
        let error = format!("{:#}", read_bytes(&whole[..400]).unwrap_err());
        assert!(error.contains("ends too early"), "{error}");
    }
}
