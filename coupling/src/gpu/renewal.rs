//! Renewals: weights, porosity, permeability and loads anew, on the device. The host hears the
//! extremes of the bed and answers with the numbers of the lattice.

use super::arrays::Arrays;
use super::coupled::{Coupled, refuse_open};
use super::kernels::{Over, Renewal};
use super::numbers::{Course, EXTREMES, Span, extremes};
use crate::choice::{self, Situation};
use crate::lattice::Lattice;
use crate::{Error, Model};
use dem::gpu::Solver;
use dem::gpu::fixed::Grid;
use dem::gpu::wide::Wide;
use lbm::{Extremes, Scaling};
use shaders::{Arrived, Device, Part, Reading, Recording};

/// What is read at a renewal.
pub(super) struct Asked {
    span: Part<Span>,
    extremes: Part<u32>,
}

/// The bed as its renewal has found it.
pub(super) struct Found {
    span: Span,
    words: Vec<u32>,
    grid: Grid,
    /// Porosity and permeability of the cells, where they are read.
    cells: Vec<[f32; 4]>,
}

/// The bed that a lattice is laid for at the start.
pub(super) struct Bed {
    pub fields: lbm::Bed,
    pub porosity: Vec<f64>,
    pub extremes: Extremes,
}

impl Renewal {
    /// Weigh the grains where they begin, and read what the lattice must know.
    pub fn begin(&self, device: &Device, arrays: &Arrays, grains: &Solver) -> Result<Found, Error> {
        let (count, cells) = (grains.grains(), arrays.bed.len());
        let mut recording = device.record();
        recording.dispatch(&self.number, Over::Grains.groups(count, cells));
        self.record(&mut recording, |over| over.groups(count, cells));
        recording.submit()?;
        let mut reading = device.reading();
        let asked = self.ask(&mut reading, arrays);
        let bed = reading.add(&arrays.bed, 0..cells);
        let arrived = reading.wait()?;
        let mut found = Found::new(&arrived, asked, grains.grid());
        found.cells = arrived.take(bed);
        Ok(found)
    }

    /// Record all of it but what the lattice needs.
    pub fn record(&self, recording: &mut Recording, over: impl Fn(Over) -> [u32; 3]) {
        recording.section("renewal");
        for (stage, of) in &self.stages {
            recording.dispatch(stage, over(*of));
        }
    }

    /// Ask what was found.
    pub fn ask(&self, reading: &mut Reading, arrays: &Arrays) -> Asked {
        Asked {
            span: reading.add(&arrays.span, 0..1),
            extremes: reading.add(&arrays.extremes, 0..EXTREMES),
        }
    }
}

impl Found {
    fn new(arrived: &Arrived, asked: Asked, grid: &Grid) -> Self {
        Self {
            span: arrived.take(asked.span)[0],
            words: arrived.take(asked.extremes),
            grid: *grid,
            cells: Vec::new(),
        }
    }

    /// Stretch the lattice from wall to wall; the extremes of the bed, with grains of this `volume`
    /// in all [m³].
    fn stretch(&self, lattice: &mut Lattice, volume: f64) -> Result<Extremes, Error> {
        lattice.bottom = self.grid.metres(self.span.bottom);
        lattice.height = f64::from(self.span.bed) * self.grid.unit / lattice.cells[2] as f64;
        if self.words[6] != 0 {
            let what = "a cell of the water holds less than 2 % of it: too little";
            return Err(Error::Invalid(what.into()));
        }
        let porosity = 1.0 - volume / (lattice.count() as f64 * lattice.volume());
        Ok(extremes(&self.words, porosity))
    }

    /// The same, with the fields.
    pub fn see(&self, lattice: &mut Lattice, volume: f64) -> Result<Bed, Error> {
        let extremes = self.stretch(lattice, volume)?;
        let number = |k: usize| -> Vec<f64> {
            let cells = self.cells.iter();
            cells.map(|cell| f64::from(cell[k])).collect()
        };
        let porosity = number(3);
        Ok(Bed {
            fields: lbm::Bed {
                porosity: lbm::Field::Cells(porosity.clone()),
                permeability: lbm::Field::Cells(number(1)),
                forchheimer: None,
            },
            porosity,
            extremes,
        })
    }
}

/// What the steps of the fluid depend on, in a bed of these extremes and of grains of this mean
/// density [kg/m³].
pub(super) fn situation<'a>(
    extremes: &Extremes,
    model: &'a Model,
    lattice: &Lattice,
    step: f64,
    density: f64,
) -> Situation<'a> {
    let fluid = &model.fluid;
    let size = lattice.height.min(lattice.spacing);
    let storage = extremes.porosity[0] * fluid.compressibility;
    let stiffness = model.stiffness.unwrap_or(0.0) + 1.0 / storage;
    let sound = (stiffness / ((1.0 - extremes.mean_porosity) * density)).sqrt();
    let unit = step / (fluid.viscosity * fluid.compressibility * size * size);
    Situation {
        model,
        diffusivity: unit * extremes.mobility[1],
        courant: sound * step / size,
        storage: model.stiffness.map_or(0.0, |m| storage * m),
        step,
    }
}

impl<const N: usize> Coupled<N> {
    pub(super) fn course(&self) -> Course {
        let stretch = self.lattice.height / self.lattice.spacing;
        Course::new(
            self.fluid.scaling(),
            &self.choice,
            self.step,
            stretch,
            self.towed,
        )
    }

    /// Time from one step of the fluid to the next [s].
    pub(super) fn between(&self) -> f64 {
        self.choice.interval as f64 * self.step
    }

    /// Tell the device when weights are to be renewed.
    pub(super) fn prepare_renewal(&self, step: u64) {
        let passed = self.time_after(step) - self.loads_at;
        let course = Course {
            renew_at: step as u32,
            memory: (passed / (passed + self.model.load_memory)) as f32,
            ..self.course()
        };
        self.device.write(&self.arrays.course, 0, &[course]);
    }

    /// Simulated time after `step` steps of the grains [s].
    pub(super) fn time_after(&self, step: u64) -> f64 {
        self.start + step as f64 * self.step
    }

    /// Weights are new: so is the lattice, with the content of each cell kept.
    pub(super) fn renew(
        &mut self,
        step: u64,
        arrived: &Arrived,
        asked: Asked,
    ) -> Result<(), Error> {
        let found = Found::new(arrived, asked, self.grains.grid());
        let extremes = found.stretch(&mut self.lattice, self.volume)?;
        self.porosity = extremes.mean_porosity;
        let passed = (step - self.renewed_at) as f64 * self.step;
        let [hi, lo] = [found.words[7], found.words[8]];
        let vapour = Wide { hi: hi as i32, lo }.units() * self.lattice.volume();
        self.events.see_vapour(vapour, passed);
        self.renewed_at = step;
        self.loads_at = self.time_after(step);
        let height = self.lattice.height;
        let kept = self.fluid.set_extremes(height, &extremes).is_ok();
        if !kept {
            // The bed has changed so much that this lattice does not fit it any more.
            self.relay(&extremes)?;
        }
        let course = Course {
            renew_at: step as u32,
            ..self.course()
        };
        self.device.write(&self.arrays.course, 0, &[course]);
        self.write_taken_off(&[self.taken_off()]);
        let stretch = self.fluid.stretch();
        let mut recording = self.device.record();
        recording.section("renewal");
        recording.dispatch(&self.of_lattice.lay_bed, self.over(Over::Cells));
        if !kept {
            self.fluid.write_sides(&stretch);
            self.device.write(&self.arrays.guard, 0, &[1]);
            self.fluid.record_lay(&mut recording, &self.of_fluid);
            self.fluid
                .record_contents(&mut recording, &stretch, &self.of_fluid);
        }
        recording.section("prediction");
        self.record_push_anew(&mut recording);
        Ok(recording.submit()?)
    }

    /// Other steps, for a bed that has become another one.
    fn relay(&mut self, extremes: &Extremes) -> Result<(), Error> {
        let mut fluid = self.fluid.model().clone();
        let height = self.lattice.height;
        let situation = situation(
            extremes,
            &self.model,
            &self.lattice,
            self.step,
            self.density,
        );
        refuse_open(&situation)?;
        self.choice = situation.choose(&mut fluid, |fluid| {
            Scaling::choose_for::<f32>(fluid, extremes, height)
        })?;
        self.events.choose(&situation, &self.choice);
        let scaling = Scaling::choose_for::<f32>(&fluid, extremes, height)?;
        let time = self.fluid.time();
        let factors = self.fluid.change_scaling(fluid, scaling, height, time);
        let [x, y, z] = factors.map(|f| f as f32);
        self.device
            .write(&self.arrays.factors, 0, &[[x, y, z, 1.0]]);
        self.events.relaid += 1;
        Ok(())
    }
}

impl crate::report::Events {
    /// What the steps that were chosen mean.
    pub(super) fn choose(&mut self, situation: &Situation, steps: &choice::Steps) {
        self.diffusivity = situation.diffusivity * steps.interval as f64;
        self.courant = situation.courant * steps.interval as f64;
    }
}
