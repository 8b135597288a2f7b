//! A bed with its water on a device.

use super::arrays::Arrays;
use super::kernels::{Binder, OfLattice, Renewal, Steps};
use super::numbers::{Course, Numbers, flags, solid};
use super::renewal::situation;
use crate::choice::{self, Situation, fluid_model};
use crate::lattice::Lattice;
use crate::report::Events;
use crate::softness::Softness;
use crate::{Error, Model, State};
use dem::Body;
use glam::DVec3;
use shaders::Device;

/// Grains and water that go along together on a device; the kernel reaches `N` cells, 3 or 5.
pub struct Coupled<const N: usize> {
    pub(super) device: Device,
    pub(super) model: Model,
    pub(super) grains: dem::gpu::Solver,
    pub(super) fluid: lbm::gpu::Solver,
    pub(super) lattice: Lattice,
    /// Indices of the bottom and the top wall.
    pub(super) walls: [usize; 2],
    /// Grain step [s].
    pub(super) step: f64,
    /// Time at which the grains began [s].
    pub(super) start: f64,
    pub(super) choice: choice::Steps,
    /// Steps made when the fluid stepped last, and when weights were renewed last.
    pub(super) fluid_at: u64,
    pub(super) renewed_at: u64,
    /// Time of the last reading of loads [s].
    pub(super) loads_at: f64,
    /// Mean porosity at the last renewal.
    pub(super) porosity: f64,
    /// Part of their drag that loose grains get.
    pub(super) towed: f64,
    /// Volume of all grains [m³], and their mean density [kg/m³].
    pub(super) volume: f64,
    pub(super) density: f64,
    pub(super) events: Events,
    /// Water beyond that at rest [m³], and height of the bed [m], at the start.
    pub(super) began_with: [f64; 2],
    /// Volume that left through sides of prescribed flux [m³], bottom and top.
    pub(super) let_out: [f64; 2],
    /// What the first fluid step counts as flowing upward beside bottom and top, and which has
    /// flowed before [m].
    pub(super) let_through: f64,
    pub(super) arrays: Arrays,
    pub(super) steps: Steps,
    pub(super) renewal: Renewal,
    pub(super) of_lattice: OfLattice,
    pub(super) of_fluid: lbm::gpu::bed::Coupled,
}

/// Vectors that are kept for each grain: see shaders/coupling/numbers.wgsl.
const KEPT: usize = 6;

impl<const N: usize> Coupled<N> {
    /// Fill the pores of the bed `state` with water, with the state `water_state` or at rest. The
    /// same states give the same bits on the same device, however many steps are asked for at a
    /// time.
    ///
    /// # Errors
    /// [`Error`] for descriptions or states that cannot be right, or stable, or accurate, and for a
    /// device that fails or has too little memory.
    pub fn new(
        device: &Device,
        grains: dem::Model,
        state: dem::State,
        water: Model,
        water_state: Option<&State>,
    ) -> Result<Self, Error> {
        let (volume, mass) = solid(&state);
        let start = state.time;
        let grains = dem::gpu::Solver::with_companion(device, grains, state.clone(), KEPT)?;
        let (walls, mut lattice) = crate::check::check::<N>(&water, grains.model())?;
        let numbers = Numbers::new(
            &water,
            grains.model(),
            &state,
            grains.grid(),
            (&lattice, walls),
        );
        let arrays = Arrays::new(device, &numbers, &water, N)?;
        let loads = match water_state {
            Some(state) => state.loads.clone(),
            None => loads(&grains)?,
        };
        let loads: Vec<f32> = loads.iter().map(|&load| load as f32).collect();
        device.write(&arrays.mean_loads, 0, &loads);
        if let Some(state) = water_state {
            let flux: Vec<[f32; 4]> = state
                .flux
                .iter()
                .map(|q| [q[0] as f32, q[1] as f32, q[2] as f32, 0.0])
                .collect();
            device.write(&arrays.contents, 0, &flux);
            if let Some(vapour) = &arrays.vapour {
                let volumes: Vec<f32> = state.vapour.iter().map(|&v| v as f32).collect();
                device.write(vapour, 0, &volumes);
            }
        }

        let binder = Binder {
            device,
            flags: grains.flags().clone().and(&flags(&water, N)),
            arrays: &arrays,
            grains: grains.arrays(),
        };
        let area = grains.model().domain.area();
        let height: f64 = -state.walls.iter().map(|wall| wall.offset).sum::<f64>();
        let towed = water.towed(1.0 - volume / (area * height));
        device.write(&arrays.course, 0, &[Course::before(towed)]);
        let (steps, renewal) = (binder.steps()?, binder.renewal()?);
        let found = renewal.begin(device, &arrays, &grains)?;
        let bed = found.see(&mut lattice, volume)?;
        Softness::judge(&water, bed.extremes.mean_porosity)?;
        let mut fluid = fluid_model(&water, lattice.spacing, bed.fields.clone());
        let situation = situation(
            &bed.extremes,
            &water,
            &lattice,
            grains.model().step,
            mass / volume,
        );
        refuse_open(&situation)?;
        let choice = situation.choose(&mut fluid, |fluid| {
            lbm::Scaling::choose::<f32>(fluid, lattice.height)
        })?;
        let mut events = Events::default();
        events.choose(&situation, &choice);
        let mut at = lbm::State {
            time: start,
            thickness: lattice.height,
            ..lbm::State::at_rest(&fluid)
        };
        if let Some(state) = water_state {
            at.flux.clone_from(&state.flux);
            for cell in 0..lattice.count() {
                let storage = fluid.fluid.compressibility * bed.porosity[cell] * lattice.volume();
                at.pressure[cell] = state.pressure[cell] + state.vapour[cell] / storage;
            }
        }
        let mut fluid = lbm::gpu::Solver::new(device, fluid, at)?;
        let of_fluid = fluid.couple(&arrays.guard, &arrays.contents, &arrays.factors)?;
        let of_lattice = binder.of_lattice(&fluid.arrays())?;
        let mut coupled = Self {
            device: device.clone(),
            step: grains.model().step,
            start,
            choice,
            fluid_at: 0,
            renewed_at: 0,
            loads_at: start,
            porosity: bed.extremes.mean_porosity,
            volume,
            towed,
            density: mass / volume,
            events,
            began_with: [0.0; 2],
            let_out: [0.0; 2],
            let_through: 0.0,
            model: water,
            grains,
            fluid,
            lattice,
            walls,
            steps,
            renewal,
            of_lattice,
            of_fluid,
            arrays,
        };
        coupled.begin()?;
        Ok(coupled)
    }

    /// The pressure of the start, and what it pushes.
    fn begin(&mut self) -> Result<(), Error> {
        self.device.write(&self.arrays.course, 0, &[self.course()]);
        let stretch = self.fluid.stretch();
        self.fluid.write_sides(&stretch);
        self.write_taken_off(&[self.taken_off()]);
        let mut recording = self.device.record();
        self.fluid
            .record_contents(&mut recording, &stretch, &self.of_fluid);
        self.record_push_anew(&mut recording);
        recording.submit()?;
        let now = self.snapshot()?;
        self.let_through = self.last_through(&now);
        self.began_with = [now.content, self.bed_height()?];
        Ok(())
    }

    /// The grains.
    pub fn grains(&self) -> &dem::gpu::Solver {
        &self.grains
    }

    /// The description of the water.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.time_after(self.grains.steps_made())
    }

    /// Memory in use on the device for the water and the coupling [bytes].
    pub fn memory(&self) -> u64 {
        self.arrays.bytes() + self.fluid.memory()
    }
}

/// Refuse what no lattice can hold.
pub(super) fn refuse_open(situation: &Situation) -> Result<(), Error> {
    match situation.is_open() {
        false => Ok(()),
        true => Err(Error::Invalid(
            "the pores are so open that water moves by its own mass, which the GPU does not \
             compute; use the CPU (--backend cpu), or bound the permeability from above"
                .into(),
        )),
    }
}

/// Sum of the normal forces of the contacts of each grain [N], by identity.
fn loads(grains: &dem::gpu::Solver) -> Result<Vec<f64>, Error> {
    let now = grains.snapshot()?.state;
    let mut loads = vec![0.0; now.grains.len()];
    for contact in &now.contacts {
        let (normal, other) = match contact.j {
            Body::Grain(j) => (contact.branch.normalize_or_zero(), Some(j)),
            Body::Wall(k) => (grains.model().walls[k as usize].normal, None),
        };
        let load = DVec3::dot(contact.force, normal).max(0.0);
        loads[contact.i as usize] += load;
        if let Some(j) = other {
            loads[j as usize] += load;
        }
    }
    Ok(loads)
}
