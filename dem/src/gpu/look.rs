//! A look at the device: forces and histories of this instant are measured, changing nothing,
//! and everything is read.

use super::control::Control;
use super::fixed::Place;
use super::scene::{Body, Motion, Own, Relief};
use super::solver::Solver;
use super::steps::THREADS;
use crate::Error;
use shaders::{Array, Bindable, Device};

/// What the device holds at one instant.
#[derive(Default)]
pub(super) struct Look {
    pub control: Control,
    pub sums: Vec<[u32; 2]>,
    pub reliefs: Vec<Relief>,
    pub bodies: Vec<Body>,
    pub places: Vec<Place>,
    pub motions: Vec<Motion>,
    pub owns: Vec<Own>,
    pub turned: Vec<[i32; 4]>,
    pub orientations: Vec<[f32; 4]>,
    pub lists: Vec<[u32; 2]>,
    pub words: Vec<u32>,
    pub forces: Vec<[f32; 4]>,
    pub springs: Vec<[f32; 4]>,
    pub rollings: Vec<[f32; 4]>,
    pub wall_forces: Vec<[f32; 4]>,
    pub wall_springs: Vec<[f32; 4]>,
    pub wall_rollings: Vec<[f32; 4]>,
    pub pushes: Vec<[f32; 4]>,
}

/// Where the kernel `read` leaves what it finds.
struct Found {
    words: Array<u32>,
    forces: Array<[f32; 4]>,
    springs: Array<[f32; 4]>,
    rollings: Array<[f32; 4]>,
    wall_forces: Array<[f32; 4]>,
    wall_springs: Array<[f32; 4]>,
    wall_rollings: Array<[f32; 4]>,
    pushes: Array<[f32; 4]>,
}

impl Found {
    fn new(device: &Device, solver: &Solver) -> Result<Self, shaders::Error> {
        let parts = &solver.arrays.parts;
        let entries = solver.arrays.entries.neighbours.len();
        let at_walls = parts.grains * parts.walls;
        let four = |name: &str, len: usize, is: bool| device.array(name, if is { len } else { 0 });
        let each = |name: &str, is: bool| device.array_in_parts(name, if is { entries } else { 0 });
        Ok(Self {
            words: device.array_in_parts("words_read", entries)?,
            forces: each("forces_read", true)?,
            springs: each("springs_read", parts.slides)?,
            rollings: each("rollings_read", parts.turns)?,
            wall_forces: four("wall_forces_read", at_walls, true)?,
            wall_springs: four("wall_springs_read", at_walls, parts.full_walls)?,
            wall_rollings: four(
                "wall_rollings_read",
                at_walls,
                parts.full_walls && parts.turns,
            )?,
            pushes: four("pushes", 2 * parts.grains, true)?,
        })
    }

    fn named(&self) -> [(&'static str, &dyn Bindable); 8] {
        [
            ("words_read", &self.words),
            ("forces_read", &self.forces),
            ("springs_read", &self.springs),
            ("rollings_read", &self.rollings),
            ("wall_forces_read", &self.wall_forces),
            ("wall_springs_read", &self.wall_springs),
            ("wall_rollings_read", &self.wall_rollings),
            ("pushes", &self.pushes),
        ]
    }
}

impl Solver {
    /// Measure forces and histories of this instant, and read everything.
    pub(super) fn look(&self) -> Result<Look, Error> {
        let found = Found::new(&self.device, self)?;
        let mut named = found.named().to_vec();
        named.extend(
            self.arrays
                .named()
                .iter()
                .filter(|(name, _)| *name != "pushes"),
        );
        let bound = self.measure.bind(&self.device, &named)?;
        let slots = self.numbers.slots;
        let nothing = vec![[0u32; 2]; slots.forces().max(4)];
        self.device.write(
            &self.arrays.sums,
            slots.reading(),
            &nothing[..slots.forces()],
        );
        self.device
            .write(&self.arrays.sums, slots.losses_read(), &nothing[..4]);
        let n = self.arrays.parts.grains;
        let mut recording = self.device.record();
        recording.dispatch(
            &bound,
            shaders::groups(n * self.numbers.lanes as usize, THREADS),
        );
        recording.submit()?;

        let entries = self.control.entries as usize;
        let half = (self.control.base & 1) as usize * n;
        let mut reading = self.device.reading();
        let control = reading.add(&self.arrays.control, 0..1);
        let sums = reading.add(&self.arrays.sums, 0..slots.len());
        let reliefs = self.arrays.companion.as_ref().map(|companion| {
            let all = 0..companion.reliefs.len();
            reading.add(&companion.reliefs, all)
        });
        let bodies = reading.add(&self.arrays.bodies, 0..self.arrays.bodies.len());
        let places = reading.add(&self.arrays.places, half..half + n);
        let motions = reading.add(&self.arrays.motions, half..half + n);
        let owns = reading.add(&self.arrays.owns, 0..n);
        let turned = self
            .arrays
            .turned
            .as_ref()
            .map(|array| reading.add(array, 0..n));
        let orientations = &self.arrays.orientations;
        let orientations = orientations.as_ref().map(|array| reading.add(array, 0..n));
        let lists = reading.add(&self.arrays.lists, 0..n);
        let words = reading.add(&found.words, 0..entries);
        // Of the room for entries, what is in use.
        let mut four =
            |array: &Array<[f32; 4]>, most: usize| reading.add(array, 0..array.len().min(most));
        let forces = four(&found.forces, entries);
        let springs = four(&found.springs, entries);
        let rollings = four(&found.rollings, entries);
        let wall_forces = four(&found.wall_forces, usize::MAX);
        let wall_springs = four(&found.wall_springs, usize::MAX);
        let wall_rollings = four(&found.wall_rollings, usize::MAX);
        let pushes = four(&found.pushes, usize::MAX);
        let arrived = reading.wait()?;
        let control: Control = arrived.take(control)[0];
        if control.flags != 0 {
            return Err(Error::Unstable {
                step: u64::from(control.base),
                what: "forces are no numbers; the time step is too long".into(),
            });
        }
        Ok(Look {
            control,
            sums: arrived.take(sums),
            reliefs: reliefs.map_or_else(Vec::new, |part| arrived.take(part)),
            bodies: arrived.take(bodies),
            places: arrived.take(places),
            motions: arrived.take(motions),
            owns: arrived.take(owns),
            turned: turned.map_or_else(Vec::new, |part| arrived.take(part)),
            orientations: orientations.map_or_else(Vec::new, |part| arrived.take(part)),
            lists: arrived.take(lists),
            words: arrived.take(words),
            forces: arrived.take(forces),
            springs: arrived.take(springs),
            rollings: arrived.take(rollings),
            wall_forces: arrived.take(wall_forces),
            wall_springs: arrived.take(wall_springs),
            wall_rollings: arrived.take(wall_rollings),
            pushes: arrived.take(pushes),
        })
    }
}
