//! Beds from files: where grains are and how large, whoever settled them.
//!
//! | format                | told by                        | file         |
//! |-----------------------|--------------------------------|--------------|
//! | NetCDF, our own       | its first bytes                | [`netcdf`]   |
//! | `sphere` binary 2.11  | the version in its first bytes | [`sphere`]   |
//! | LAMMPS dump           | `ITEM:` at its start           | [`lammps`]   |
//! | LAMMPS data           | a line that counts atoms       | [`lammps`]   |
//! | CSV                   | any other text                 | [`csv`]      |

pub mod csv;
pub mod lammps;
pub mod netcdf;
mod overlap;
pub mod sphere;

pub use overlap::Overlap;

use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The grains of a file, SI units. Arrays have one entry a grain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bed {
    /// Centres [m]; the box, if there is one, begins at the origin.
    pub position: Vec<DVec3>,
    /// Radii [m].
    pub radius: Vec<f64>,
    /// Velocities [m/s], if the file has them.
    pub velocity: Option<Vec<DVec3>>,
    /// Angular velocities [rad/s], if the file has them.
    pub angular_velocity: Option<Vec<DVec3>>,
    /// Lengths of the box along x, y and z [m], if the file has them.
    pub size: Option<[f64; 3]>,
}

/// Read a bed in any known format, told by its content.
pub fn read(path: &Path) -> Result<Bed> {
    let bed = Format::of(path).and_then(|format| {
        let bed = match format {
            Format::NetCdf => netcdf::read(path),
            Format::Sphere => sphere::read(path),
            Format::LammpsDump => lammps::read_dump(path),
            Format::LammpsData => lammps::read_data(path),
            Format::Csv => csv::read(path),
        }?;
        bed.check()?;
        Ok(bed)
    });
    bed.with_context(|| format!("cannot read a bed from {}", path.display()))
}

/// Read `input` in any known format and write it as NetCDF to `output`.
///
/// Returns a summary for the user.
///
/// # Errors
/// Files that cannot be read or written, an output that is the input, and what
/// [`Bed::check_packing`] refuses in the box of the file.
pub fn import(input: &Path, output: &Path) -> Result<String> {
    let bed = read(input)?;
    // By whatever name: through links, or by way of another folder.
    let same = output.canonicalize().ok() == Some(input.canonicalize()?);
    ensure!(
        !same,
        "{} is the file to be imported; give the output another name",
        output.display()
    );
    // Which sides are periodic is not part of a bed: nothing meets its images here.
    let size = bed.size.map_or([f64::INFINITY; 2], |[x, y, _]| [x, y]);
    let domain = dem::Domain {
        size,
        periodic: [false; 2],
    };
    let overlap = bed
        .check_packing(&domain)
        .with_context(|| format!("{} is no bed", input.display()))?;
    netcdf::write(output, &bed, input)?;
    Ok(bed.summary(overlap))
}

/// Largest overlap of a bed, over the smaller radius \[-\]. Settled grains overlap by
/// hundredths at most; equal centres give 2.
const MOST_OVERLAP: f64 = 0.5;

/// Lower and upper corner of the smallest box around `places`.
fn corners(places: &[DVec3]) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let widen = |(low, high): (DVec3, DVec3), &p: &DVec3| (low.min(p), high.max(p));
    places.iter().fold(start, widen)
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    NetCdf,
    Sphere,
    LammpsDump,
    LammpsData,
    Csv,
}

impl Format {
    /// The format of the file at `path`, by its first bytes.
    fn of(path: &Path) -> Result<Self> {
        let mut start = Vec::new();
        File::open(path)?.take(4096).read_to_end(&mut start)?;
        if start.starts_with(b"\x89HDF") || start.starts_with(b"CDF") {
            return Ok(Self::NetCdf);
        }
        if sphere::version(&start).is_some() {
            return Ok(Self::Sphere);
        }
        // The cut may fall into a letter of several bytes; only the lines before matter.
        let Ok(text) = str::from_utf8(&start[..start.len().saturating_sub(3)]) else {
            bail!(
                "neither text, NetCDF, nor a binary of sphere; \
                 convert it to CSV with the columns x, y, z, radius in metres"
            );
        };
        Ok(if text.starts_with("ITEM:") {
            Self::LammpsDump
        } else if text.lines().skip(1).any(lammps::counts_atoms) {
            Self::LammpsData
        } else {
            Self::Csv
        })
    }
}

impl Bed {
    /// Number of grains.
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// Is there no grain?
    pub fn is_empty(&self) -> bool {
        self.radius.is_empty()
    }

    /// Refuse a bed that cannot be one.
    fn check(&self) -> Result<()> {
        ensure!(!self.is_empty(), "it has no grains");
        for (k, &radius) in self.radius.iter().enumerate() {
            ensure!(
                radius.is_finite() && radius > 0.0,
                "grain {k} has the radius {radius}; it must be positive"
            );
        }
        let vectors = [
            Some(&self.position),
            self.velocity.as_ref(),
            self.angular_velocity.as_ref(),
        ];
        let names = ["position", "velocity", "angular velocity"];
        for (name, values) in names.iter().zip(vectors) {
            let bad = values.and_then(|v| v.iter().position(|x| !x.is_finite()));
            if let Some(k) = bad {
                bail!("grain {k} has a {name} that is not a number");
            }
        }
        if let Some(size) = self.size {
            let possible = size.iter().all(|&l| l.is_finite() && l > 0.0);
            ensure!(possible, "its box is {size:?} m; lengths must be positive");
        }
        Ok(())
    }

    /// Refuse a bed that cannot have been settled in `domain`; returns its largest overlap.
    ///
    /// # Errors
    /// Centres that spread wider than a side, and grains that overlap by more than half of
    /// the smaller radius: mostly, lengths are not in metres.
    pub fn check_packing(&self, domain: &dem::Domain) -> Result<Option<Overlap>> {
        let (low, high) = corners(&self.position);
        let smallest = self.radius.iter().copied().fold(f64::INFINITY, f64::min);
        for (side, name) in ["x", "y"].into_iter().enumerate() {
            let [extent, length] = [(high - low)[side], domain.size[side]];
            // Programs wrap grains late: some may be a little outside of a periodic side.
            ensure!(
                extent <= length + smallest,
                "its grains spread over {extent:.6} m along {name} and the box is {length:.6} m \
                 wide; are the units metres, and is it the box that the bed was made in?"
            );
        }
        let overlap = self.largest_overlap(domain);
        if let Some(Overlap { grains, ratio }) = overlap.filter(|o| o.ratio > MOST_OVERLAP) {
            let [i, j] = grains;
            bail!(
                "grains {i} and {j} overlap by {ratio:.3} of the smaller radius, and more than \
                 {MOST_OVERLAP} is no packing; are the units metres, and is the box the one that \
                 the bed was made in?"
            );
        }
        Ok(overlap)
    }

    /// What was read, in a few lines.
    fn summary(&self, overlap: Option<Overlap>) -> String {
        let span = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
                [low.min(v), high.max(v)]
            })
        };
        let radius = span(&mut self.radius.iter().copied());
        let mean = self.radius.iter().sum::<f64>() / self.len() as f64;
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let each = || self.position.iter().zip(&self.radius);
            let [low, _] = span(&mut each().map(|(p, r)| p[axis] - r));
            let [_, high] = span(&mut each().map(|(p, r)| p[axis] + r));
            format!("{low:.6} to {high:.6} m")
        });
        let overlap = overlap.map_or("none".into(), |Overlap { grains, ratio }| {
            let [i, j] = grains;
            format!("at most {ratio:.2e} of the smaller radius, grains {i} and {j}")
        });
        let size = self.size.map_or("not in the file".into(), |[x, y, z]| {
            format!("{x:.6} x {y:.6} x {z:.6} m")
        });
        let kept = match (&self.velocity, &self.angular_velocity) {
            (Some(_), Some(_)) => "velocities and angular velocities",
            (Some(_), None) => "velocities",
            (None, Some(_)) => "angular velocities",
            (None, None) => "none, the grains are at rest",
        };
        format!(
            "grains  {}\n\
             radius  {:.4e} to {:.4e} m, mean {mean:.4e} m\n\
             x       {x}\n\
             y       {y}\n\
             z       {z}\n\
             overlap {overlap}\n\
             box     {size}\n\
             motion  {kept}",
            self.len(),
            radius[0],
            radius[1],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// What reading `text` from a file says.
    pub(super) fn read_text(text: &str) -> Result<Bed> {
        let dir = tempfile::tempdir()?;
        let path = dir.path().join("bed");
        fs::write(&path, text)?;
        read(&path)
    }

    /// The error that reading `text` gives, with all its causes.
    pub(super) fn refusal(text: &str) -> String {
        format!("{:#}", read_text(text).unwrap_err())
    }

    #[test]
    fn an_import_can_be_read_again_and_is_summed_up() {
        let dir = tempfile::tempdir().unwrap();
        let csv = dir.path().join("grains.csv");
        fs::write(&csv, "x,y,z,radius\n0.1,0.2,0.01,0.01\n0.1,0.2,0.04,0.02\n").unwrap();
        let nc = dir.path().join("bed.nc");
        let summary = import(&csv, &nc).unwrap();
        assert_eq!(read(&nc).unwrap(), read(&csv).unwrap());
        let expected = "grains  2\n\
                        radius  1.0000e-2 to 2.0000e-2 m, mean 1.5000e-2 m\n\
                        x       0.080000 to 0.120000 m\n\
                        y       0.180000 to 0.220000 m\n\
                        z       0.000000 to 0.060000 m\n\
                        overlap none\n\
                        box     not in the file\n\
                        motion  none, the grains are at rest";
        assert_eq!(summary, expected);
    }

    #[test]
    fn what_is_not_in_metres_or_not_of_its_box_is_refused() {
        let bed = Bed {
            position: vec![DVec3::ZERO, DVec3::new(0.013, 0.0, 0.0)],
            radius: vec![0.01; 2],
            ..Bed::default()
        };
        let domain = |width: f64, periodic| dem::Domain {
            size: [width, 1.0],
            periodic: [periodic, true],
        };
        let error = |domain| bed.check_packing(&domain).unwrap_err().to_string();
        // 7 mm of overlap, radii of 10 mm.
        let deep = error(domain(1.0, true));
        assert!(
            deep.contains("grains 0 and 1 overlap by 0.700") && deep.contains("metres"),
            "{deep}"
        );
        let bed = Bed {
            position: vec![DVec3::ZERO, DVec3::new(0.3, 0.0, 0.0)],
            ..bed.clone()
        };
        let error = |domain| bed.check_packing(&domain).unwrap_err().to_string();
        let wide = error(domain(0.2, true));
        assert!(wide.contains("spread over 0.300000 m along x"), "{wide}");
        // At the two ends of a periodic side they are neighbours.
        let across = error(domain(0.31, true));
        assert!(across.contains("overlap by 1.000"), "{across}");
        assert_eq!(bed.check_packing(&domain(0.31, false)).unwrap(), None);
    }

    #[test]
    fn an_import_never_replaces_what_it_reads() {
        let dir = tempfile::tempdir().unwrap();
        let csv = dir.path().join("grains.csv");
        let text = "x,y,z,radius\n0.1,0.2,0.01,0.01\n";
        fs::write(&csv, text).unwrap();
        fs::create_dir(dir.path().join("sub")).unwrap();
        let detour = dir.path().join("sub/../grains.csv");
        let error = import(&csv, &detour).unwrap_err().to_string();
        assert!(error.contains("is the file to be imported"), "{error}");
        assert_eq!(fs::read_to_string(&csv).unwrap(), text);
    }

    #[test]
    fn impossible_grains_are_refused() {
        let negative = refusal("x,y,z,radius\n1,1,1,0.1\n1,1,1,-0.1\n");
        assert!(
            negative.contains("grain 1 has the radius -0.1"),
            "{negative}"
        );
        let nowhere = refusal("x,y,z,radius\nnan,1,1,0.1\n");
        assert!(
            nowhere.contains("grain 0 has a position that is not a number"),
            "{nowhere}"
        );
        let empty = refusal("x,y,z,radius\n");
        assert!(empty.contains("no grains"), "{empty}");
    }

    #[test]
    fn a_file_of_noise_is_refused_with_the_remedy() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("noise");
        fs::write(&path, [0xff; 64]).unwrap();
        let error = format!("{:#}", read(&path).unwrap_err());
        assert!(
            error.contains("noise") && error.contains("convert it to CSV"),
            "{error}"
        );
        let missing = format!("{:#}", read(&dir.path().join("nothing")).unwrap_err());
        assert!(
            missing.contains("nothing") && missing.contains("No such file"),
            "{missing}"
        );
    }
}
