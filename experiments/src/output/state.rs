//! The complete state in one HDF5 file, bit for bit.
//!
//! Layout, SI units, vectors as rows of three: `time`; `grains/`, one row a grain in the
//! order of identities; `contacts/`, one row a contact, sorted by its two bodies, `j` being
//! -1 - w for wall w; `walls/`, one row a wall; `box/`, the sides; `past/`, what came before; and
//! `pore_water/`, where there is water between the grains.
//! Attributes tell the scene, version, commit, seed and machine. Only what is needed to go on
//! is needed to read the file; no compression, since the low bits of a state are noise.

use super::{Header, partial, pore_state, provenance};
use crate::protocol::{Past, Reference, Unfinished};
use anyhow::{Context, Result, bail, ensure};
use dem::{Body, Constraint, Contact, Domain, Grains, History, Horizontal, State, WallState};
use glam::{DQuat, DVec3};
use hdf5::types::VarLenUnicode;
use hdf5::{File, Group, H5Type, Location};
use ndarray::{ArrayView, ArrayView1, ArrayView2, Dimension};
use std::fs;
use std::path::Path;

/// Number of this layout; a change of it is a new number.
const LAYOUT: u32 = 2;

/// A state with what a scene needs besides to go on from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// Grains, contacts, walls.
    pub state: State,
    /// The box that they are in.
    pub domain: Domain,
    /// The protocol so far.
    pub past: Past,
}

/// Write `saved` to `path`; an existing file is replaced only once the new one is whole.
///
/// # Errors
/// A file that cannot be written.
pub fn save(path: &Path, saved: &Saved, header: &Header) -> Result<()> {
    let partial = partial(path);
    finish(path, &partial, write(&partial, saved, header))
}

/// Let the file `partial`, if it was `written`, take the place of `path`.
pub(super) fn finish(path: &Path, partial: &Path, written: Result<()>) -> Result<()> {
    written
        .and_then(|()| {
            fs::File::open(partial)?.sync_all()?;
            Ok(fs::rename(partial, path)?)
        })
        .inspect_err(|_| drop(fs::remove_file(partial)))
        .with_context(|| format!("cannot write the state {}", path.display()))
}

/// Read what [`save`] wrote.
///
/// # Errors
/// A file that cannot be read, is no state, or contradicts itself.
pub fn load(path: &Path) -> Result<Saved> {
    read(path).with_context(|| format!("cannot read the state {}", path.display()))
}

/// A new state with its attributes.
pub(super) fn start(path: &Path, header: &Header) -> Result<File> {
    let file = File::create(path)?;
    let layout = file.new_attr::<u32>().create("esker_state_layout")?;
    layout.write_scalar(&LAYOUT)?;
    for (name, text) in provenance::texts(header) {
        put_text(&file, name, &text)?;
    }
    if let Some(seed) = header.seed {
        let attribute = file.new_attr::<u64>().create("seed")?;
        attribute.write_scalar(&seed)?;
    }
    Ok(file)
}

/// See that `file` is a state as this version writes it.
pub(super) fn check_layout(file: &File) -> Result<()> {
    let layout = file
        .attr("esker_state_layout")
        .and_then(|a| a.read_scalar::<u32>());
    let layout = layout.context("not a state: it has no esker_state_layout")?;
    ensure!(
        layout == LAYOUT,
        "the state has layout {layout}, this version of esker reads {LAYOUT}"
    );
    Ok(())
}

fn write(path: &Path, saved: &Saved, header: &Header) -> Result<()> {
    let file = start(path, header)?;
    let state = &saved.state;
    put(&file, "time", "s", &[state.time])?;
    let group = file.create_group("box")?;
    put(&group, "size", "m", &saved.domain.size)?;
    put(
        &group,
        "periodic",
        "1",
        &saved.domain.periodic.map(u8::from),
    )?;
    write_past(&file.create_group("past")?, &saved.past)?;
    if let Some(water) = &saved.past.water {
        pore_state::write(&file, water)?;
    }

    let grains = &state.grains;
    let group = file.create_group("grains")?;
    put(&group, "id", "1", &grains.id)?;
    put(&group, "radius", "m", &grains.radius)?;
    put(&group, "mass", "kg", &grains.mass)?;
    put(
        &group,
        "moment_of_inertia",
        "kg m2",
        &grains.moment_of_inertia,
    )?;
    put_rows(&group, "position", "m", &grains.position, DVec3::to_array)?;
    put_rows(
        &group,
        "displacement",
        "m",
        &grains.displacement,
        DVec3::to_array,
    )?;
    put_rows(
        &group,
        "velocity",
        "m s-1",
        &grains.velocity,
        DVec3::to_array,
    )?;
    let spin = &grains.angular_velocity;
    put_rows(&group, "angular_velocity", "rad s-1", spin, DVec3::to_array)?;
    put_rows(
        &group,
        "orientation",
        "1",
        &grains.orientation,
        DQuat::to_array,
    )?;
    let constraint = grains.constraint.iter();
    let horizontal: Vec<_> = constraint
        .clone()
        .map(|c| horizontal_code(c.horizontal))
        .collect();
    put(&group, "horizontal", "1", &horizontal)?;
    let held: Vec<_> = constraint.map(|c| u8::from(c.rotation_held)).collect();
    put(&group, "rotation_held", "1", &held)?;

    let contacts = &state.contacts;
    let group = file.create_group("contacts")?;
    let each = contacts.iter();
    put(
        &group,
        "i",
        "1",
        &each.clone().map(|c| c.i).collect::<Vec<_>>(),
    )?;
    put(
        &group,
        "j",
        "1",
        &each.clone().map(|c| body_code(c.j)).collect::<Vec<_>>(),
    )?;
    put_rows(&group, "spring", "m", contacts, |c| {
        c.history.spring.to_array()
    })?;
    put_rows(&group, "rolling_spring", "m", contacts, |c| {
        c.history.rolling_spring.to_array()
    })?;
    let twist: Vec<_> = each.clone().map(|c| c.history.twisting_spring).collect();
    put(&group, "twisting_spring", "m", &twist)?;
    let sliding: Vec<_> = each.clone().map(|c| u8::from(c.history.sliding)).collect();
    put(&group, "sliding", "1", &sliding)?;
    put_rows(&group, "force", "N", contacts, |c| c.force.to_array())?;
    put(
        &group,
        "overlap",
        "m",
        &each.map(|c| c.overlap).collect::<Vec<_>>(),
    )?;
    put_rows(&group, "branch", "m", contacts, |c| c.branch.to_array())?;

    let walls = state.walls.iter();
    let group = file.create_group("walls")?;
    put(
        &group,
        "offset",
        "m",
        &walls.clone().map(|w| w.offset).collect::<Vec<_>>(),
    )?;
    put(
        &group,
        "velocity",
        "m s-1",
        &walls.map(|w| w.velocity).collect::<Vec<_>>(),
    )?;
    file.close()?;
    Ok(())
}

/// What an unfinished phase measures from is there only if there is such a phase.
fn write_past(group: &Group, past: &Past) -> Result<()> {
    put(group, "strain", "1", &[past.strain])?;
    if let Some(Unfinished { phase, reference }) = &past.unfinished {
        put_text(group, "unfinished", phase)?;
        put(group, "reference_time", "s", &[reference.time])?;
        put(group, "reference_height", "m", &[reference.height])?;
        put(group, "reference_way", "m", &[reference.way])?;
        put(group, "reference_strain", "1", &[reference.strain])?;
    }
    Ok(())
}

fn read_past(group: &Group) -> Result<Past> {
    let number = |name| get::<f64>(group, name, 1).map(|values| values[0]);
    let unfinished = if group.attr_names()?.iter().any(|name| name == "unfinished") {
        let phase = group.attr("unfinished")?.read_scalar::<VarLenUnicode>()?;
        let reference = Reference {
            time: number("reference_time")?,
            height: number("reference_height")?,
            way: number("reference_way")?,
            strain: number("reference_strain")?,
        };
        let phase = phase.to_string();
        Some(Unfinished { phase, reference })
    } else {
        None
    };
    let strain = number("strain")?;
    Ok(Past {
        strain,
        unfinished,
        water: None, // until it is read
    })
}

fn read_domain(group: &Group) -> Result<Domain> {
    let size: Vec<f64> = get(group, "size", 2)?;
    let periodic: Vec<u8> = get(group, "periodic", 2)?;
    Ok(Domain {
        size: [size[0], size[1]],
        periodic: [periodic[0] != 0, periodic[1] != 0],
    })
}

fn read(path: &Path) -> Result<Saved> {
    let file = File::open(path)?;
    check_layout(&file)?;
    let group = file.group("grains").context("it has no grains")?;
    let n = group.dataset("id")?.size();
    let grains = Grains {
        id: get(&group, "id", n)?,
        radius: get(&group, "radius", n)?,
        mass: get(&group, "mass", n)?,
        moment_of_inertia: get(&group, "moment_of_inertia", n)?,
        position: get_rows(&group, "position", n, DVec3::from_array)?,
        displacement: get_rows(&group, "displacement", n, DVec3::from_array)?,
        velocity: get_rows(&group, "velocity", n, DVec3::from_array)?,
        angular_velocity: get_rows(&group, "angular_velocity", n, DVec3::from_array)?,
        orientation: get_rows(&group, "orientation", n, DQuat::from_array)?,
        constraint: read_constraints(&group, n)?,
    };

    let group = file.group("walls")?;
    let n_walls = group.dataset("offset")?.size();
    let offset: Vec<f64> = get(&group, "offset", n_walls)?;
    let velocity: Vec<f64> = get(&group, "velocity", n_walls)?;
    let walls = offset.iter().zip(velocity);
    let walls = walls.map(|(&offset, velocity)| WallState { offset, velocity });

    let state = State {
        time: get::<f64>(&file, "time", 1)?[0],
        contacts: read_contacts(&file.group("contacts")?, n, n_walls)?,
        grains,
        walls: walls.collect(),
    };
    Ok(Saved {
        state,
        domain: read_domain(&file.group("box")?)?,
        past: Past {
            water: pore_state::read(&file, n)?,
            ..read_past(&file.group("past")?)?
        },
    })
}

fn read_constraints(group: &Group, n: usize) -> Result<Vec<Constraint>> {
    let horizontal: Vec<u8> = get(group, "horizontal", n)?;
    let held: Vec<u8> = get(group, "rotation_held", n)?;
    let constraint = |(code, held): (u8, u8)| {
        Ok(Constraint {
            horizontal: horizontal_from(code)?,
            rotation_held: held != 0,
        })
    };
    horizontal.into_iter().zip(held).map(constraint).collect()
}

fn read_contacts(group: &Group, grains: usize, walls: usize) -> Result<Vec<Contact>> {
    let n = group.dataset("i")?.size();
    let i: Vec<u32> = get(group, "i", n)?;
    let j: Vec<i64> = get(group, "j", n)?;
    let spring = get_rows(group, "spring", n, DVec3::from_array)?;
    let rolling_spring = get_rows(group, "rolling_spring", n, DVec3::from_array)?;
    let twisting_spring: Vec<f64> = get(group, "twisting_spring", n)?;
    let sliding: Vec<u8> = get(group, "sliding", n)?;
    let force = get_rows(group, "force", n, DVec3::from_array)?;
    let overlap: Vec<f64> = get(group, "overlap", n)?;
    let branch = get_rows(group, "branch", n, DVec3::from_array)?;
    let contact = |c: usize| {
        let known = (i[c] as usize) < grains && j[c] < grains as i64 && j[c] >= -(walls as i64);
        ensure!(
            known,
            "contact {c} joins {} and {}, which are not there",
            i[c],
            j[c]
        );
        Ok(Contact {
            i: i[c],
            j: body_from(j[c]),
            history: History {
                spring: spring[c],
                rolling_spring: rolling_spring[c],
                twisting_spring: twisting_spring[c],
                sliding: sliding[c] != 0,
            },
            force: force[c],
            overlap: overlap[c],
            branch: branch[c],
        })
    };
    (0..n).map(contact).collect()
}

fn body_code(body: Body) -> i64 {
    match body {
        Body::Grain(grain) => i64::from(grain),
        Body::Wall(wall) => -1 - i64::from(wall),
    }
}

fn body_from(code: i64) -> Body {
    match code {
        0.. => Body::Grain(code as u32),
        _ => Body::Wall((-1 - code) as u32),
    }
}

fn horizontal_code(horizontal: Horizontal) -> u8 {
    match horizontal {
        Horizontal::Free => 0,
        Horizontal::Held => 1,
        Horizontal::Driven => 2,
    }
}

fn horizontal_from(code: u8) -> Result<Horizontal> {
    Ok(match code {
        0 => Horizontal::Free,
        1 => Horizontal::Held,
        2 => Horizontal::Driven,
        _ => bail!("grains/horizontal holds {code}; 0 is free, 1 held, 2 driven"),
    })
}

pub(super) fn put<T: H5Type>(group: &Group, name: &str, units: &str, values: &[T]) -> Result<()> {
    put_array(group, name, units, ArrayView1::from(values))
}

/// Write one row of N numbers for each item.
pub(super) fn put_rows<T, const N: usize>(
    group: &Group,
    name: &str,
    units: &str,
    items: &[T],
    row: impl Fn(&T) -> [f64; N],
) -> Result<()> {
    let rows: Vec<_> = items.iter().map(row).collect();
    put_array(group, name, units, ArrayView2::from(&rows[..]))
}

fn put_array<T: H5Type, D: Dimension>(
    group: &Group,
    name: &str,
    units: &str,
    values: ArrayView<T, D>,
) -> Result<()> {
    let dataset = group.new_dataset_builder().with_data(values).create(name)?;
    put_text(&dataset, "units", units)
}

/// Attach a text to a file, a group or a dataset.
fn put_text(to: &Location, name: &str, text: &str) -> Result<()> {
    let attribute = to.new_attr::<VarLenUnicode>().create(name)?;
    attribute.write_scalar(&text.parse::<VarLenUnicode>()?)?;
    Ok(())
}

/// Read `n` numbers.
pub(super) fn get<T: H5Type>(group: &Group, name: &str, n: usize) -> Result<Vec<T>> {
    let place = || format!("{}/{name}", group.name());
    let values = group.dataset(name).and_then(|d| d.read_raw());
    let values: Vec<T> = values.with_context(place)?;
    ensure!(
        values.len() == n,
        "{} has {} numbers, not {n}",
        place(),
        values.len()
    );
    Ok(values)
}

/// Read `n` rows of N numbers.
pub(super) fn get_rows<T, const N: usize>(
    group: &Group,
    name: &str,
    n: usize,
    item: impl Fn([f64; N]) -> T,
) -> Result<Vec<T>> {
    let values: Vec<f64> = get(group, name, N * n)?;
    let (rows, _) = values.as_chunks();
    Ok(rows.iter().map(|&row| item(row)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::PastWater;

    /// Two grains and a wall with every field different, and numbers that a detour through
    /// text or single precision would change.
    fn saved() -> Saved {
        let mut state = State {
            time: 0.1 + 0.2,
            walls: vec![WallState {
                offset: -0.35,
                velocity: -0.0,
            }],
            ..State::default()
        };
        let grains = &mut state.grains;
        for k in 0..2 {
            let x = f64::from(k) + 1.0 / 3.0;
            grains.add_sphere(DVec3::new(x, f64::MIN_POSITIVE / 4.0, -x), 0.1 * x, 2600.0);
            let k = k as usize;
            grains.displacement[k] = DVec3::new(7.0, 8.0, 9.0) / x;
            grains.velocity[k] = DVec3::new(1e-300, 2.0, -3.0) / x;
            grains.angular_velocity[k] = DVec3::new(4.0, 5.0, 6.0) / x;
            grains.orientation[k] = DQuat::from_rotation_x(x);
        }
        grains.id.swap(0, 1);
        grains.constraint[1] = Constraint {
            horizontal: Horizontal::Driven,
            rotation_held: true,
        };
        let contact = |j, x: f64| Contact {
            i: 0,
            j,
            history: History {
                spring: DVec3::new(1.0, 2.0, 3.0) / x,
                rolling_spring: DVec3::new(4.0, 5.0, 6.0) / x,
                twisting_spring: 7.0 / x,
                sliding: x > 4.0,
            },
            force: DVec3::new(8.0, 9.0, 10.0) / x,
            overlap: 11.0 / x,
            branch: DVec3::new(12.0, 13.0, 14.0) / x,
        };
        state.contacts = vec![contact(Body::Grain(1), 3.0), contact(Body::Wall(0), 7.0)];
        let reference = Reference {
            time: 1.0 / 7.0,
            height: 2.0 / 7.0,
            way: -3.0 / 7.0,
            strain: 4.0 / 7.0,
        };
        let unfinished = Some(Unfinished {
            phase: "scherung-süd".into(),
            reference,
        });
        let past = Past {
            strain: 5.0 / 7.0,
            unfinished,
            water: Some(PastWater {
                cells: [2, 1, 1],
                state: coupling::State {
                    pressure: vec![-0.1, 1e-310],
                    flux: vec![[1.0 / 3.0, -2.0, 0.5], [1e300, 0.1, -0.0]],
                    vapour: vec![0.0, 1.0 / 9.0],
                    loads: vec![0.1, 1.0 / 11.0],
                },
                stiffness: Some(1e8 / 3.0),
            }),
        };
        let domain = Domain {
            size: [1.0 / 3.0, 2.0 / 3.0],
            periodic: [true, false],
        };
        Saved {
            state,
            domain,
            past,
        }
    }

    fn empty() -> Saved {
        Saved {
            state: State::default(),
            past: Past::default(),
            ..saved()
        }
    }

    fn header() -> Header {
        Header {
            title: "a pair".into(),
            scene: "seed = 7\n".into(),
            seed: Some(7),
            backend: "cpu",
            device: "a processor".into(),
        }
    }

    #[test]
    fn every_bit_of_a_state_comes_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("state.h5");
        let saved = saved();
        save(&path, &saved, &header()).unwrap();
        let back = load(&path).unwrap();
        assert_eq!(back, saved);
        // == does not see the sign of a zero.
        assert_eq!(back.state.walls[0].velocity.to_bits(), (-0.0_f64).to_bits());
        let names: Vec<_> = fs::read_dir(&dir).unwrap().collect();
        assert_eq!(names.len(), 1, "nothing is left beside the state");
    }

    #[test]
    fn a_state_without_grains_and_contacts_comes_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("state.h5");
        save(&path, &empty(), &header()).unwrap();
        assert_eq!(load(&path).unwrap(), empty());
    }

    #[test]
    fn saving_replaces_an_older_state() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("state.h5");
        save(&path, &empty(), &header()).unwrap();
        save(&path, &saved(), &header()).unwrap();
        assert_eq!(load(&path).unwrap(), saved());
    }

    #[test]
    fn a_state_tells_where_it_comes_from() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("state.h5");
        save(&path, &saved(), &header()).unwrap();
        let file = File::open(&path).unwrap();
        let text = |name: &str| {
            let attribute = file.attr(name).unwrap();
            let text = attribute.read_scalar::<VarLenUnicode>().unwrap();
            text.to_string()
        };
        assert_eq!(text("scene"), "seed = 7\n");
        assert_eq!(text("title"), "a pair");
        assert_eq!(text("version"), provenance::VERSION);
        assert_eq!(text("commit"), provenance::COMMIT);
        assert_eq!(text("machine"), provenance::machine());
        let seed = file.attr("seed").unwrap();
        assert_eq!(seed.read_scalar::<u64>().unwrap(), 7);
    }

    #[test]
    fn a_file_that_is_no_state_is_refused_with_its_name() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("other.h5");
        File::create(&path).unwrap().close().unwrap();
        let error = format!("{:#}", load(&path).unwrap_err());
        assert!(
            error.contains("other.h5") && error.contains("not a state"),
            "{error}"
        );
    }

    #[test]
    fn a_contact_with_a_grain_that_is_not_there_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("state.h5");
        let mut saved = saved();
        saved.state.contacts[0].j = Body::Grain(2);
        save(&path, &saved, &header()).unwrap();
        let error = format!("{:#}", load(&path).unwrap_err());
        assert!(error.contains("joins 0 and 2"), "{error}");
    }
}
