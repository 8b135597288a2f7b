//! All arrays of a solver on the device, under the names that the kernels know.

use super::companion::Companion;
use super::control::Control;
use super::fixed::Place;
use super::numbers::Numbers;
use super::scene::{Body, Motion, Own, Scene};
use super::steps::GROUP;
use super::{loading, rows};
use crate::{Error, Model, State};
use shaders::{Array, Bindable, Device, Flags};

/// What a scene has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Parts {
    pub grains: usize,
    pub walls: usize,
    pub slides: bool,
    pub turns: bool,
    pub ledger: bool,
    /// Is there a wall with the whole law?
    pub full_walls: bool,
    /// Is the driven layer driven by a shear stress?
    pub shear_stress: bool,
    /// Does something go along, with so many vectors a grain?
    pub companion: Option<usize>,
}

pub(super) struct Arrays {
    pub parts: Parts,
    pub scene: Array<Scene>,
    pub ticks: Array<u32>,
    pub control: Array<Control>,
    pub sums: Array<[u32; 2]>,
    pub bodies: Array<Body>,
    pub places: Array<Place>,
    pub motions: Array<Motion>,
    pub owns: Array<Own>,
    pub turned: Option<Array<[i32; 4]>>,
    pub orientations: Option<Array<[f32; 4]>>,
    pub lists: Array<[u32; 2]>,
    pub entries: Entries,
    pub wall_forces: Option<Array<[f32; 4]>>,
    pub wall_springs: Option<Array<[f32; 4]>>,
    pub wall_rollings: Option<Array<[f32; 4]>>,
    pub wall_couples: Option<Array<[f32; 4]>>,
    pub pushes: Option<Array<[f32; 4]>>,
    /// Forces from outside, once there have been any, and the step at which they changed.
    pub outside: Option<(Array<[f32; 4]>, Array<u32>)>,
    /// What velocities in f32 do not hold.
    pub remains: Array<[i32; 4]>,
    pub companion: Option<Companion>,
}

/// Arrays with one element for each entry of the neighbour lists.
#[derive(Clone)]
pub(super) struct Entries {
    pub neighbours: Array<u32>,
    pub springs: Option<Array<[f32; 4]>>,
    pub forces: Option<Array<[f32; 4]>>,
    pub rollings: Option<Array<[f32; 4]>>,
    pub couples: Option<Array<[f32; 4]>>,
}

impl Entries {
    pub fn new(device: &Device, parts: &Parts, room: usize) -> Result<Self, Error> {
        let four = |name: &str, is: bool| match is {
            true => device.array_in_parts(name, room).map(Some),
            false => Ok(None),
        };
        Ok(Self {
            neighbours: device.array_in_parts("neighbours", room)?,
            springs: four("springs", parts.slides)?,
            forces: four("forces", parts.ledger)?,
            rollings: four("rollings", parts.turns)?,
            couples: four("couples", parts.turns && parts.ledger)?,
        })
    }

    /// Everything in an array with more room.
    pub fn grown(&self, device: &Device, parts: &Parts, room: usize) -> Result<Self, Error> {
        let grown = Self::new(device, parts, room)?;
        let mut recording = device.record();
        let count = self.neighbours.len();
        recording.copy(&self.neighbours, 0, &grown.neighbours, 0, count);
        for (old, new) in self.histories().zip(grown.histories()) {
            recording.copy(old, 0, new, 0, count);
        }
        recording.submit()?;
        Ok(grown)
    }

    /// `flags` for kernels that see these arrays, and those of a reading, in as many parts as they
    /// lie in.
    pub fn flags(&self, device: &Device, flags: &Flags) -> Flags {
        let room = self.neighbours.len();
        let mut flags = flags.clone();
        for name in ["neighbours", "words_read"] {
            flags = flags.parts(name, device.parts::<u32>(room));
        }
        for name in ["springs", "forces", "rollings", "couples"] {
            let parts = device.parts::<[f32; 4]>(room);
            flags = flags
                .parts(name, parts)
                .parts(&format!("{name}_read"), parts);
        }
        flags
    }

    pub fn histories(&self) -> impl Iterator<Item = &Array<[f32; 4]>> {
        let each = [&self.springs, &self.forces, &self.rollings, &self.couples];
        each.into_iter().flatten()
    }
}

impl Arrays {
    /// Arrays with the first rows and lists of `state`; the driven layer moves at `drive` [m/s].
    ///
    /// # Errors
    /// [`Error::Invalid`] for what their numbers cannot hold, [`Error::Device`] for too little
    /// memory.
    pub fn new(
        device: &Device,
        numbers: &Numbers,
        model: &Model,
        state: &State,
        drive: f64,
    ) -> Result<Self, Error> {
        let parts = numbers.parts;
        let scene = loading::scene(model, state, numbers)?;
        let bodies = loading::bodies(model, state, &numbers.grid, drive)?;
        let control = Control::new(GROUP as u32, numbers.limit as f32, numbers.skin as f32);
        let mut rows = rows::rows(model, state, &numbers.grid)?;
        let lists = rows::lists(model, state, &mut rows)?;
        let n = parts.grains;
        let halves = |name: &str| device.array(name, 2 * n);
        let places: Array<Place> = device.array("places", 2 * n)?;
        device.write(&places, 0, &rows.places);
        let motions: Array<Motion> = device.array("motions", 2 * n)?;
        device.write(&motions, 0, &rows.motions);
        let entries = Entries::new(device, &parts, numbers.entries)?;
        device.write(&entries.neighbours, 0, &lists.words);
        if let Some(springs) = &entries.springs {
            device.write(springs, 0, &lists.springs);
        }
        if let Some(rollings) = &entries.rollings {
            device.write(rollings, 0, &lists.rollings);
        }
        let walls = |name: &str, is: bool, values: Option<&[[f32; 4]]>| -> Result<_, Error> {
            if !is {
                return Ok(None);
            }
            let array = device.array(name, n * parts.walls)?;
            device.write(&array, 0, values.unwrap_or_default());
            Ok(Some(array))
        };
        let bodies_array = device.array("bodies", 2 * bodies.len())?;
        device.write(&bodies_array, 0, &bodies);
        let full = parts.full_walls;
        let turning = full && parts.turns;
        let upright = vec![[0.0, 0.0, 0.0, 1.0]; n];
        Ok(Self {
            parts,
            scene: device.array_of("scene", &[scene])?,
            ticks: device.ticks(GROUP)?,
            control: device.array_of("control", &[control])?,
            sums: device.array("sums", numbers.slots.len())?,
            bodies: bodies_array,
            places,
            motions,
            owns: device.array_of("owns", &rows.owns)?,
            turned: if parts.slides {
                Some(device.array("turned", n)?)
            } else {
                None
            },
            orientations: match parts.slides {
                true => Some(device.array_of("orientations", &upright)?),
                false => None,
            },
            lists: device.array_of("lists", &lists.lists)?,
            entries,
            wall_forces: walls("wall_forces", parts.ledger, None)?,
            wall_springs: walls("wall_springs", full, Some(&lists.wall_springs))?,
            wall_rollings: walls("wall_rollings", turning, Some(&lists.wall_rollings))?,
            wall_couples: walls("wall_couples", turning && parts.ledger, None)?,
            pushes: if parts.shear_stress {
                Some(halves("pushes")?)
            } else {
                None
            },
            outside: None,
            remains: device.array("remains", n)?,
            companion: match parts.companion {
                Some(width) => Some(Companion::new(device, n, parts.walls, width)?),
                None => None,
            },
        })
    }

    /// Every array that is there, by name.
    pub fn named(&self) -> Vec<(&'static str, &dyn Bindable)> {
        let mut named: Vec<(&'static str, &dyn Bindable)> = vec![
            ("scene", &self.scene),
            ("tick", &self.ticks),
            ("control", &self.control),
            ("sums", &self.sums),
            ("bodies", &self.bodies),
            ("places", &self.places),
            ("motions", &self.motions),
            ("owns", &self.owns),
            ("remains", &self.remains),
            ("lists", &self.lists),
            ("neighbours", &self.entries.neighbours),
        ];
        let four = [
            ("springs", &self.entries.springs),
            ("forces", &self.entries.forces),
            ("rollings", &self.entries.rollings),
            ("couples", &self.entries.couples),
            ("orientations", &self.orientations),
            ("wall_forces", &self.wall_forces),
            ("wall_springs", &self.wall_springs),
            ("wall_rollings", &self.wall_rollings),
            ("wall_couples", &self.wall_couples),
            ("pushes", &self.pushes),
        ];
        for (name, array) in four {
            if let Some(array) = array {
                named.push((name, array));
            }
        }
        if let Some(turned) = &self.turned {
            named.push(("turned", turned));
        }
        if let Some((outside, changed)) = &self.outside {
            named.push(("outside", outside));
            named.push(("changed", changed));
        }
        if let Some(companion) = &self.companion {
            named.extend(companion.named());
        }
        named
    }

    /// Rows of grains that a search must carry along, with their width in vectors.
    pub fn rows(&self) -> Vec<(&dyn Bindable, u32)> {
        let walls = self.parts.walls as u32;
        let mut rows: Vec<(&dyn Bindable, u32)> = vec![(&self.owns, 1), (&self.remains, 1)];
        if let Some(turned) = &self.turned {
            rows.push((turned, 1));
        }
        if let Some(orientations) = &self.orientations {
            rows.push((orientations, 1));
        }
        let each = [
            &self.wall_forces,
            &self.wall_springs,
            &self.wall_rollings,
            &self.wall_couples,
        ];
        for array in each.into_iter().flatten().filter(|_| walls > 0) {
            rows.push((array, walls));
        }
        rows.extend(self.companion_rows());
        rows
    }

    /// Memory on the device [bytes].
    pub fn bytes(&self) -> u64 {
        self.named().iter().map(|(_, array)| array.bytes()).sum()
    }
}
