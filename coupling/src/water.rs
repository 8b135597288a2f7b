//! The water of a bed: what it must know of the grains, and its own steps.

use crate::choice::{Situation, Steps, fluid_model};
use crate::exchange::{Exchange, Loose, Touch, middle};
use crate::faces::{DRAG_EVERY, Fields, Frozen, Pass, drags};
use crate::kernel::{folded_cell, folded_face, half_width, shares};
use crate::lattice::Lattice;
use crate::load::Loads;
use crate::report::Events;
use crate::{Error, Model, NormalStress};
use dem::{Companion, Moved, Row, Threads};
use glam::DVec3;
use lbm::Side;
use std::ops::Range;

/// Pore water that goes along with the grains of a `dem` solver, through a kernel that reaches
/// `N` cells along each axis: 3, a hat of half width one cell, or 5, one of two.
pub struct Water<const N: usize> {
    pub(crate) model: Model,
    pub(crate) lattice: Lattice,
    /// Grain step [s].
    step: f64,
    /// Steps made when the fluid stepped last, and when weights were renewed last.
    fluid_at: u64,
    renewed_at: u64,
    pub(crate) steps: Steps,
    /// Indices of the bottom and the top wall in the grains' model.
    walls: [usize; 2],
    pub(crate) loads: Loads,
    exchange: Exchange<N>,
    frozen: Frozen,
    fields: Fields,
    pub(crate) fluid: lbm::Solver<f64>,
    /// Content of the lattice [m³], in the order here.
    content: Vec<f64>,
    /// Volume of vapour [m³]: it stands in the content of the lattice, but is no water.
    vapour: Vec<f64>,
    /// Least pressure [Pa]; minus infinity without cavitation.
    least: Vec<f64>,
    /// Volume of solid [m³], and β V_p [m³/Pa].
    pub(crate) solid: Vec<f64>,
    storage: Vec<f64>,
    /// Weight of the displaced water along -z of each grain, in the solver's order [N].
    lift: Vec<f64>,
    /// Mean density of the grains [kg/m³].
    pub(crate) density: f64,
    pub(crate) events: Events,
    scratch: Scratch,
}

/// Arrays that would else be allocated again and again.
#[derive(Default)]
struct Scratch {
    loads: Vec<f64>,
    rates: Vec<f64>,
    of_lbm: Vec<f64>,
}

/// Water at one instant, one entry a cell: x fastest, then y, then z.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Height of the bottom and of a cell [m].
    pub bottom: f64,
    /// Height of a cell [m].
    pub height: f64,
    /// Pressure beyond hydrostatic that the grains feel [Pa].
    pub pressure: Vec<f64>,
    /// Darcy flux at the last fluid step [m/s].
    pub flux: Vec<[f64; 3]>,
    /// Porosity at the last renewal.
    pub porosity: Vec<f64>,
    /// Volume of vapour [m³].
    pub vapour: Vec<f64>,
    /// Water beyond that at rest in all cells, what is still collected included [m³].
    pub content: f64,
}

/// What must be known of the water to go on, beside the grains.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Pressure [Pa], one entry a cell: x fastest, then y, then z.
    pub pressure: Vec<f64>,
    /// Darcy flux [m/s].
    pub flux: Vec<[f64; 3]>,
    /// Volume of vapour [m³].
    pub vapour: Vec<f64>,
    /// Mean load of each grain [N], by identity.
    pub loads: Vec<f64>,
}

impl<const N: usize> Water<N> {
    /// Water in the bed of `grains` as it is now, with `state`, or at rest.
    ///
    /// # Errors
    /// [`Error`] for a description that cannot be right, or stable, or accurate.
    pub fn new(model: Model, grains: &dem::Solver, state: Option<&State>) -> Result<Self, Error> {
        let bed = grains.bed();
        let (walls, mut lattice) = crate::check::check::<N>(&model, bed.model)?;
        span(&mut lattice, walls, &bed);
        let count = lattice.count();
        let volume: f64 = (0..bed.id.len()).map(|k| volume(bed.position[k])).sum();
        let porosity = (1.0 - volume / (count as f64 * lattice.volume())).clamp(0.05, 0.95);
        // A first lattice of any permeability: the renewal below lays the right one.
        let uniform = lbm::Bed {
            porosity: lbm::Field::Uniform(porosity),
            permeability: lbm::Field::Uniform(1e-12),
            forchheimer: None,
        };
        let first = fluid_model(&model, lattice.spacing, uniform);
        let at_rest = lbm::State {
            thickness: lattice.height,
            ..lbm::State::at_rest(&first)
        };
        let mut water = Self {
            step: bed.model.step,
            fluid_at: 0,
            renewed_at: 0,
            steps: Steps {
                interval: 1,
                sub_steps: 1,
            },
            walls,
            loads: Loads::default(),
            exchange: Exchange::new(&lattice, Vec::new(), Vec::new()),
            frozen: Frozen::default(),
            fields: Fields::new(&lattice),
            fluid: lbm::Solver::new(first, at_rest, 1)?,
            content: vec![0.0; count],
            vapour: vec![0.0; count],
            least: vec![f64::NEG_INFINITY; count],
            solid: vec![0.0; count],
            storage: vec![0.0; count],
            lift: Vec::new(),
            density: bed.mass.iter().sum::<f64>() / volume,
            events: Events::default(),
            scratch: Scratch::default(),
            model,
            lattice,
        };
        if let Some(state) = state {
            water.loads.mean.clone_from(&state.loads);
            water.loads.read_at = bed.time;
        }
        water.fluid_at = bed.step;
        water.renewed_at = bed.step;
        water.weigh(&bed)?;
        water.begin(&bed, state)?;
        Ok(water)
    }

    /// Lay the lattice for the bed that has been weighed.
    fn begin(&mut self, bed: &dem::Bed, state: Option<&State>) -> Result<(), Error> {
        let none = vec![[0.0; 3]; self.lattice.count()];
        let flux = state.map_or(&none, |state| &state.flux);
        for cell in 0..self.lattice.count() {
            let of_lbm = self.lattice.cell_of_lbm(cell);
            let pressure = state.map_or(0.0, |state| state.pressure[of_lbm]);
            self.vapour[cell] = state.map_or(0.0, |state| state.vapour[of_lbm]);
            self.content[cell] = self.storage[cell] * pressure + self.vapour[cell];
        }
        self.lay(bed.time, flux)?;
        for cell in 0..self.lattice.count() {
            let pressure = self.pressure_of(cell, 0.0);
            self.fields.pressure.get_mut()[cell] = pressure;
        }
        Ok(())
    }

    /// A new lattice with steps chosen anew, the content of each cell kept.
    fn lay(&mut self, time: f64, flux: &[[f64; 3]]) -> Result<(), Error> {
        let bed = self.bed_of_lbm(flux);
        let mut fluid = fluid_model(&self.model, self.lattice.spacing, bed);
        let (diffusivity, storage) = self.extremes(&fluid);
        let courant =
            self.sound(storage) * self.step / self.lattice.height.min(self.lattice.spacing);
        let situation = Situation {
            model: &self.model,
            diffusivity,
            courant,
            storage: self.model.stiffness.map_or(0.0, |m| storage * m),
            step: self.step,
        };
        self.steps = situation.choose(&mut fluid, self.lattice.height)?;
        self.events.diffusivity = diffusivity * self.steps.interval as f64;
        self.events.courant = courant * self.steps.interval as f64;
        let mut state = lbm::State {
            time,
            thickness: self.lattice.height,
            ..lbm::State::at_rest(&fluid)
        };
        state.flux.copy_from_slice(flux);
        for cell in 0..self.lattice.count() {
            let pressure = self.content[cell] / self.storage[cell];
            state.pressure[self.lattice.cell_of_lbm(cell)] = pressure;
        }
        self.fluid = lbm::Solver::new(fluid, state, 0)?;
        self.read_content();
        Ok(())
    }

    /// Greatest diffusivity in one grain step, and least storage φβ.
    fn extremes(&self, fluid: &lbm::Model) -> (f64, f64) {
        let Some(bed) = &fluid.bed else {
            return (0.0, 0.0);
        };
        let size = self.lattice.height.min(self.lattice.spacing);
        let unit = self.step / (fluid.fluid.viscosity * size * size);
        let (mut most, mut least) = (0.0f64, f64::INFINITY);
        for cell in 0..self.lattice.count() {
            let storage = bed.porosity.at(cell) * fluid.fluid.compressibility;
            most = most.max(unit * bed.permeability.at(cell) / storage);
            least = least.min(storage);
        }
        (most, least)
    }

    /// Speed of undrained sound [m/s], with a soft skeleton where its stiffness is not known.
    fn sound(&self, storage: f64) -> f64 {
        let stiffness = self.model.stiffness.unwrap_or(0.0) + 1.0 / storage;
        let solid: f64 = self.solid.iter().sum();
        let share = solid / (self.lattice.count() as f64 * self.lattice.volume());
        (stiffness / (share * self.density)).sqrt()
    }

    /// Porosity and permeability of the cells, in `lbm`'s order.
    fn bed_of_lbm(&self, flux: &[[f64; 3]]) -> lbm::Bed {
        let count = self.lattice.count();
        let (mut porosity, mut permeability) = (vec![0.0; count], vec![0.0; count]);
        for cell in 0..count {
            let at = self.lattice.cell_of_lbm(cell);
            porosity[at] = 1.0 - self.solid[cell] / self.lattice.volume();
            let resistance = self.resistance(porosity[at], flux[at]);
            permeability[at] = self.model.fluid.viscosity / resistance;
        }
        lbm::Bed {
            porosity: lbm::Field::Cells(porosity),
            permeability: lbm::Field::Cells(permeability),
            forchheimer: None,
        }
    }

    fn resistance(&self, porosity: f64, flux: [f64; 3]) -> f64 {
        let flux = flux.iter().map(|q| q * q).sum::<f64>().sqrt();
        self.model.resistance.at(&self.model.fluid, porosity, flux)
    }

    /// The pressure of a cell from which this volume [m³] has gone.
    #[inline]
    fn pressure_of(&self, cell: usize, gone: f64) -> f64 {
        let water = self.content[cell] - self.vapour[cell] - gone;
        (water / self.storage[cell]).max(self.least[cell])
    }

    /// Weigh the grains and lay them on the lattice: weights, solid volume, storage.
    fn weigh(&mut self, bed: &dem::Bed) -> Result<(), Error> {
        span(&mut self.lattice, self.walls, bed);
        let lattice = &self.lattice;
        bed.contact_loads(&mut self.scratch.loads);
        let memory = self.model.load_memory;
        self.loads
            .read(bed.id, &self.scratch.loads, bed.time, memory);
        let half = self.model.loose * self.loads.over_all();

        let gravity = bed.model.gravity.z;
        let density = self.model.fluid.density;
        self.solid.fill(0.0);
        let mut touches = Vec::with_capacity(bed.id.len());
        let mut looseness = Vec::with_capacity(bed.id.len());
        self.lift.clear();
        let mut images = Vec::new();
        if N > 3 {
            images.resize(lattice.count(), [0.0; 2]);
        }
        for k in 0..bed.id.len() {
            let row = bed.position[k];
            let volume = volume(row);
            self.lift.push(-density * gravity * volume);
            let weight = (bed.mass[k] - density * volume).abs() * gravity.abs();
            let counts = self.loads.weight(bed.id[k], weight, half);
            let at = place(lattice, row.xyz());
            deposit::<N>(lattice, at, volume, &mut self.solid);
            if N > 3 {
                add_images::<N>(lattice, at, counts * volume, &mut images);
            }
            touches.push(Touch::new(lattice, at, counts * volume));
            looseness.push(1.0 - counts);
        }
        for cell in 0..lattice.count() {
            let pores = lattice.volume() - self.solid[cell];
            if pores < 0.02 * lattice.volume() {
                let what = format!("a cell of the water holds {pores:.2e} m³ of it: too little");
                return Err(Error::Invalid(what));
            }
            self.storage[cell] = self.model.fluid.compressibility * pores;
        }
        if let Some(cavitation) = self.model.cavitation {
            let weight = density * gravity.abs();
            for cell in 0..lattice.count() {
                let depth = (lattice.cells[2] - cell % lattice.cells[2]) as f64 - 0.5;
                self.least[cell] = cavitation.pressure - weight * depth * lattice.height;
            }
        }
        self.freeze(bed, touches, &looseness, images);
        Ok(())
    }

    /// What faces weigh with these grains; `looseness` is the part of each that does not count.
    fn freeze(
        &mut self,
        bed: &dem::Bed,
        touches: Vec<Touch<N>>,
        looseness: &[f64],
        images: Vec<[f64; 2]>,
    ) {
        let lattice = &self.lattice;
        // ν T of each grain, were it quite loose.
        let mut paces = Vec::with_capacity(touches.len());
        let loose = looseness.iter().enumerate().map(|(k, looseness)| {
            let at = place(lattice, bed.position[k].xyz());
            let (cell, _) = middle(lattice, at);
            let [i, j] = [0, 1].map(|axis| cell[axis].rem_euclid(lattice.cells[axis] as i64));
            let at = lattice.cell([i as usize, j as usize, cell[2] as usize]);
            let solid = self.solid[at] / lattice.volume();
            let porosity = 1.0 - solid;
            let resistance = self.resistance(porosity, [0.0; 3]);
            let drag = porosity * porosity * resistance * volume(bed.position[k]) / solid;
            let drag = DRAG_EVERY as f64 * drag;
            paces.push(drag * self.step / bed.mass[k]);
            Loose {
                drag: looseness * drag,
                grip: [0.0; 4],
            }
        });
        let loose = loose.collect();
        let mut exchange = Exchange::new(lattice, touches, loose);
        self.fields.fit(&exchange, lattice);
        let pass = Pass {
            lattice,
            exchange: &exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
        };
        // Sums with the very weights of the steps to come.
        let [mut inverse, mut loose, fast] = pass.sums_of([
            &|grain| exchange.touches[grain].volume,
            &|grain| exchange.loose[grain].drag,
            &|grain| exchange.loose[grain].drag * paces[grain],
        ]);
        let mut ease = vec![Row::ZERO; lattice.count()];
        for cell in 0..lattice.count() {
            for lane in 0..3 {
                let images = match (lane, images.get(cell)) {
                    (2, Some(share)) => share[0] + share[1],
                    _ => 0.0,
                };
                let weight = inverse[cell].0[lane] + images;
                let drag = loose[cell].0[lane];
                let carry = self.density * weight;
                // Of the velocity between loose grains and the others r = (ν + Σ γ K/m_f) T
                // would go at the pace that it has now.
                let eased = if carry > 0.0 && drag > 0.0 {
                    let r = fast[cell].0[lane] / drag + drag * self.step / carry;
                    1.0 / (1.0 + 0.5 * r).max(r)
                } else {
                    0.0
                };
                ease[cell].0[lane] = eased;
                loose[cell].0[lane] = eased * drag;
                inverse[cell].0[lane] = if weight > 0.0 { 1.0 / weight } else { 0.0 };
            }
        }
        let mut walls = images;
        for (share, inverse) in walls.iter_mut().zip(&inverse) {
            *share = share.map(|s| s * inverse.0[2]);
        }
        self.frozen = Frozen {
            inverse,
            ease,
            loose,
            walls,
        };
        let grips = Pass {
            lattice,
            exchange: &exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
        }
        .gathered(&self.frozen.ease);
        for (loose, grip) in exchange.loose.iter_mut().zip(grips) {
            loose.grip = grip;
        }
        self.exchange = exchange;
    }

    /// Weights, porosity and permeability anew; contents stay.
    fn renew(&mut self, bed: &dem::Bed) -> Result<(), Error> {
        self.weigh(bed)?;
        let flux = match self.model.resistance.nonlinear() {
            true => self.fluid.snapshot().flux,
            false => vec![[0.0; 3]; self.lattice.count()],
        };
        let height = self.lattice.height;
        let kept = self
            .fluid
            .set_thickness(height)
            .and_then(|()| self.fluid.set_bed(self.bed_of_lbm(&flux)));
        if kept.is_err() {
            // The bed has changed so much that this lattice does not fit it any more.
            let flux = self.fluid.snapshot().flux;
            let between = self.fluid.time();
            self.lay(between, &flux)?;
            self.events.relaid += 1;
        }
        Ok(())
    }

    /// The water's own step: what has been collected is drained.
    fn drain(&mut self, step: u64) -> Result<(), Error> {
        let lattice = &self.lattice;
        let passed = (step - self.fluid_at) as f64 * self.step;
        let collected = self.fields.collected.get_mut();
        self.scratch.rates.resize(lattice.count(), 0.0);
        let mut open = 0.0;
        for (cell, collected) in collected.iter_mut().enumerate() {
            // Vapour opens where the pressure would fall below the least, and closes again.
            let held = self.storage[cell] * self.least[cell];
            let opens = match held.is_finite() {
                true => (held - (self.content[cell] - *collected)).max(-self.vapour[cell]),
                false => 0.0,
            };
            self.vapour[cell] += opens;
            open += self.vapour[cell];
            let rate = (opens - *collected) / (lattice.volume() * passed);
            self.scratch.rates[lattice.cell_of_lbm(cell)] = rate;
            *collected = 0.0;
        }
        self.events.see_vapour(open, passed);
        self.fluid
            .advance_with(self.steps.sub_steps, &self.scratch.rates)?;
        self.read_content();
        self.fluid_at = step;
        Ok(())
    }

    fn read_content(&mut self) {
        self.scratch.of_lbm.resize(self.lattice.count(), 0.0);
        self.fluid.contents(&mut self.scratch.of_lbm);
        for cell in 0..self.lattice.count() {
            self.content[cell] = self.scratch.of_lbm[self.lattice.cell_of_lbm(cell)];
        }
    }

    fn drains(&self, step: u64) -> bool {
        step - self.fluid_at >= self.steps.interval
    }

    /// Not where loose grains are dragged: what faces have taken with the old weights would be
    /// given with the new ones.
    fn renews(&self, step: u64) -> bool {
        step >= self.renewed_at + self.model.renewal && !drags(step)
    }

    fn pass(&self) -> Pass<'_, N> {
        Pass {
            lattice: &self.lattice,
            exchange: &self.exchange,
            frozen: &self.frozen,
            fields: &self.fields,
            walls: self.walls,
        }
    }

    /// The description.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Pressure that the grains feel [Pa], x slowest and z fastest.
    pub fn pressure(&self) -> &[f64] {
        // SAFETY: a shared borrow between steps: nobody writes.
        unsafe { self.fields.pressure.read() }
    }

    /// Force of the water on the bottom and the top wall, away from the grains [N], buoyancy left
    /// out.
    pub fn on_walls(&self) -> [f64; 2] {
        [0, 1].map(|side| self.pass().on_wall(side))
    }

    /// The water now.
    pub fn snapshot(&self) -> Snapshot {
        let lattice = &self.lattice;
        let count = lattice.count();
        let mut now = Snapshot {
            bottom: lattice.bottom,
            height: lattice.height,
            pressure: vec![0.0; count],
            flux: self.fluid.snapshot().flux,
            porosity: vec![0.0; count],
            vapour: vec![0.0; count],
            content: 0.0,
        };
        // SAFETY: a shared borrow between steps: nobody writes.
        let collected = unsafe { self.fields.collected.read() };
        for cell in 0..count {
            let at = lattice.cell_of_lbm(cell);
            now.pressure[at] = self.pressure()[cell];
            now.porosity[at] = 1.0 - self.solid[cell] / lattice.volume();
            now.vapour[at] = self.vapour[cell];
            now.content += self.content[cell] - self.vapour[cell] - collected[cell];
        }
        now
    }

    /// What must be known to go on.
    pub fn state(&self) -> State {
        let now = self.snapshot();
        State {
            pressure: now.pressure,
            flux: now.flux,
            vapour: now.vapour,
            loads: self.loads.mean.clone(),
        }
    }
}

#[cfg(test)]
impl<const N: usize> Water<N> {
    /// Volume that faces have brought to the cells since the last fluid step [m³].
    pub(crate) fn collected(&self) -> &[f64] {
        // SAFETY: tests that read have one thread.
        unsafe { self.fields.collected.read() }
    }

    /// Mean velocities of the faces.
    pub(crate) fn velocities(&self) -> &[Row] {
        // SAFETY: as above.
        unsafe { self.fields.velocity.read() }
    }

    /// The pressure, to be told what it is.
    ///
    /// # Safety
    /// There is one thread.
    #[allow(
        clippy::mut_from_ref,
        reason = "a companion follows through a shared borrow"
    )]
    pub(crate) unsafe fn pressure_to_tell(&self) -> &mut [f64] {
        // SAFETY: the caller's promise.
        unsafe { self.fields.pressure.write(0..self.lattice.count()) }
    }
}

impl<const N: usize> Companion for Water<N> {
    fn arrange(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.renew(bed).map_err(|error| error.to_string())
    }

    fn follow(&self, moved: &Moved, threads: &Threads) {
        let pass = self.pass();
        pass.follow(moved, threads);
        let predicts = self.model.predicts;
        pass.collect(moved, threads, self.step, |cell, collected| {
            let gone = if predicts { collected } else { 0.0 };
            self.pressure_of(cell, gone)
        });
    }

    fn due(&self, step: u64) -> bool {
        self.drains(step) || self.renews(step)
    }

    fn settle(&mut self, bed: &dem::Bed) -> Result<(), String> {
        let step = bed.step;
        let mut settle = || {
            if self.drains(step) {
                self.drain(step)?;
            }
            if self.renews(step) {
                self.renewed_at = step;
                self.renew(bed)?;
            }
            Ok(())
        };
        settle().map_err(|error: Error| error.to_string())?;
        let predicts = self.model.predicts;
        for cell in 0..self.lattice.count() {
            let collected = self.fields.collected.get_mut()[cell];
            let gone = if predicts { collected } else { 0.0 };
            let pressure = self.pressure_of(cell, gone);
            self.fields.pressure.get_mut()[cell] = pressure;
        }
        Ok(())
    }

    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        let pass = self.pass();
        pass.push(moved, threads);
        pass.gather(moved, own, force, |grain| self.lift[grain]);
    }

    fn wall_force(&self, wall: usize) -> f64 {
        let Some(side) = self.walls.iter().position(|&k| k == wall) else {
            return 0.0;
        };
        let force = self.pass().on_wall(side);
        match (self.model.normal_stress, &self.model.sides[side]) {
            (NormalStress::Total, _) => force,
            (NormalStress::Effective, Side::Pressure(signal)) => {
                let area = self.lattice.spacing.powi(2) * self.lattice.count() as f64
                    / self.lattice.cells[2] as f64;
                force - signal.at(self.fluid.time()) * area
            }
            (NormalStress::Effective, _) => 0.0,
        }
    }
}

/// Stretch the lattice from wall to wall.
fn span(lattice: &mut Lattice, walls: [usize; 2], bed: &dem::Bed) {
    let [bottom, top] = walls.map(|k| bed.walls[k].offset / bed.model.walls[k].normal.z);
    lattice.bottom = bottom;
    lattice.height = (top - bottom) / lattice.cells[2] as f64;
}

/// Volume of a grain from its row [m³].
fn volume(row: Row) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * row.w().powi(3)
}

/// Place of a grain in cells: from the origin along x and y, from the bottom along z.
fn place(lattice: &Lattice, at: DVec3) -> [f64; 3] {
    let z = (at.z - lattice.bottom) / lattice.height;
    [at.x / lattice.spacing, at.y / lattice.spacing, z]
}

/// Call `each` with every cell that a grain reaches, that of its lower face along z with the wall
/// behind which it lies if it does, and its shares of both.
fn visit<const N: usize>(
    lattice: &Lattice,
    at: [f64; 3],
    mut each: impl FnMut(usize, f64, (usize, Option<usize>), f64),
) {
    let (cell, [x, y, z]) = middle(lattice, at);
    let (across, along) = (shares::<N>(x).0, shares::<N>(y).0);
    let (cells, faces) = shares::<N>(z);
    let m = half_width(N) as i64;
    let [nx, ny, nz] = lattice.cells;
    for i in 0..N {
        let plane = (cell[0] + i as i64 - m).rem_euclid(nx as i64) as usize;
        for j in 0..N {
            let column = (cell[1] + j as i64 - m).rem_euclid(ny as i64) as usize;
            let first = lattice.cell([plane, column, 0]);
            let share = across[i] * along[j];
            for k in 0..N {
                let up = cell[2] + k as i64 - m;
                let (face, behind) = folded_face(up, nz);
                let at = first + folded_cell(up, nz);
                each(
                    at,
                    share * cells[k],
                    (first + face, behind),
                    share * faces[k],
                );
            }
        }
    }
}

/// Add a grain's volume to the cells.
fn deposit<const N: usize>(lattice: &Lattice, at: [f64; 3], volume: f64, solid: &mut [f64]) {
    visit::<N>(lattice, at, |cell, share, _, _| {
        solid[cell] += volume * share
    });
}

/// Add twice the weights of a grain's images to the faces of normal z between the walls.
fn add_images<const N: usize>(
    lattice: &Lattice,
    at: [f64; 3],
    volume: f64,
    images: &mut [[f64; 2]],
) {
    visit::<N>(lattice, at, |_, _, (face, behind), share| {
        if let Some(wall) = behind {
            images[face][wall] += 2.0 * volume * share;
        }
    });
}
