//! What is read from the water. Reading never changes the run.

use super::coupled::Coupled;
use crate::{Error, Ledger, Report, Snapshot, State};
use lbm::Side;

/// All that readings are made from.
struct Look {
    contents: Vec<[f32; 4]>,
    /// What has been collected until now [m³], and pressure [Pa].
    looks: Vec<[f32; 2]>,
    bed: Vec<[f32; 4]>,
    vapour: Vec<f32>,
    loads: Vec<f32>,
}

impl<const N: usize> Coupled<N> {
    fn look(&self) -> Result<Look, Error> {
        let arrays = &self.arrays;
        let cells = 0..self.lattice.count();
        let mut recording = self.device.record();
        self.record_look(&mut recording);
        recording.submit()?;
        let mut reading = self.device.reading();
        let contents = reading.add(&arrays.contents, cells.clone());
        let looks = reading.add(&arrays.looks, cells.clone());
        let bed = reading.add(&arrays.bed, cells.clone());
        let vapour = arrays
            .vapour
            .as_ref()
            .map(|vapour| reading.add(vapour, cells.clone()));
        let loads = reading.add(&arrays.mean_loads, 0..arrays.mean_loads.len());
        let arrived = reading.wait()?;
        Ok(Look {
            contents: arrived.take(contents),
            looks: arrived.take(looks),
            bed: arrived.take(bed),
            vapour: vapour.map_or_else(|| vec![0.0; cells.len()], |part| arrived.take(part)),
            loads: arrived.take(loads),
        })
    }

    /// The water now.
    ///
    /// # Errors
    /// A device that fails.
    pub fn snapshot(&self) -> Result<Snapshot, Error> {
        Ok(self.look()?.snapshot(self))
    }

    /// What must be known to go on, here or on the CPU.
    ///
    /// # Errors
    /// A device that fails.
    pub fn state(&self) -> Result<State, Error> {
        let look = self.look()?;
        let now = look.snapshot(self);
        Ok(State {
            pressure: match self.model.predicts {
                true => look.pressures(self),
                false => now.pressure,
            },
            flux: now.flux,
            vapour: now.vapour,
            loads: look.loads.iter().map(|&load| load.into()).collect(),
        })
    }

    /// The water, what the numbers of the coupling are and what was seen of it, and where the
    /// water's energy and volume are: in one reading.
    ///
    /// # Errors
    /// A device that fails.
    pub fn read(&self) -> Result<(Snapshot, Report, Ledger), Error> {
        let look = self.look()?;
        let now = look.snapshot(self);
        let report = look.report(self);
        let ledger = self.ledger(&look, &now);
        Ok((now, report, ledger))
    }

    /// Height of the bed now [m].
    pub(super) fn bed_height(&self) -> Result<f64, Error> {
        let at = self.grains.wall_coordinates()?;
        Ok(at[self.walls[1]] - at[self.walls[0]])
    }

    /// Volume of water that left through the bottom and the top wall since this was made [m³], with
    /// `now` in the pores: what the walls have squeezed out and the pores do not hold. Where a pressure is
    /// prescribed at both, the shares follow from the flux in the cells beside them at the end of
    /// each fluid step.
    ///
    /// # Errors
    /// A device that fails.
    pub fn left(&self, now: &Snapshot) -> Result<[f64; 2], Error> {
        let [content, height] = self.began_with;
        let grown = (self.bed_height()? - height) * self.lattice.area();
        let all = content - now.content - grown;
        let known = [0, 1].map(|side| match self.model.sides[side] {
            Side::Pressure(_) => None,
            _ => Some(self.let_out[side]),
        });
        Ok(match known {
            [Some(bottom), Some(top)] => [bottom, top],
            [Some(bottom), None] => [bottom, all - bottom],
            [None, Some(top)] => [all - top, top],
            [None, None] => {
                let more = self.through(now)? * self.lattice.area();
                [0.5 * (all - more), 0.5 * (all + more)]
            }
        })
    }

    /// What has flowed upward in the cells beside the bottom and beside the top, added [m].
    fn through(&self, now: &Snapshot) -> Result<f64, Error> {
        let Some(through) = &self.arrays.through else {
            return Ok(f64::NAN);
        };
        let cells = self.device.read(through)?;
        let before = self.beside_walls(cells.iter().map(|&[sum, _]| sum.into()));
        Ok(before - self.let_through + self.last_through(now))
    }

    /// What the last fluid step adds to that [m].
    pub(super) fn last_through(&self, now: &Snapshot) -> f64 {
        self.between() * self.beside_walls(now.flux.iter().map(|flux| flux[2]))
    }

    /// Mean over the cells beside the bottom and that over those beside the top, added.
    fn beside_walls(&self, cells: impl Iterator<Item = f64>) -> f64 {
        let [nx, ny, nz] = self.lattice.cells;
        let layer = nx * ny;
        let beside = cells.enumerate().filter(|(cell, _)| {
            let z = cell / layer;
            z == 0 || z + 1 == nz
        });
        beside.map(|(_, x)| x).sum::<f64>() / layer as f64
    }

    /// Force of the water on the bottom and the top wall, away from the grains [N], buoyancy left
    /// out.
    ///
    /// # Errors
    /// A device that fails.
    pub fn on_walls(&self) -> Result<[f64; 2], Error> {
        let [bottom, top] = self.walls;
        let forces = self.grains.forces_of_companion()?;
        Ok([forces[bottom], forces[top]])
    }
}

impl<const N: usize> Coupled<N> {
    /// Works and losses are not summed here.
    fn ledger(&self, look: &Look, now: &Snapshot) -> Ledger {
        let pressures = look.pressures(self);
        let each = pressures.iter().zip(&look.bed);
        let elastic = each.enumerate().map(|(cell, (&p, bed))| {
            let storage = 1.0 / f64::from(bed[2]);
            let whole = 0.5 * storage * p * p;
            if self.model.cavitation.is_none() {
                return whole;
            }
            // Beyond what the least pressure stretches vapour has opened.
            whole - p.min(0.0) * (storage * p - look.water(self, cell)).max(0.0)
        });
        let none = f64::NAN;
        Ledger {
            elastic: elastic.sum(),
            kinetic: 0.0,
            content: now.content,
            vapour: now.vapour.iter().sum(),
            pores: now.porosity.iter().sum::<f64>() * self.lattice.volume(),
            work_grains: none,
            work_walls: none,
            work_sides: none,
            dissipated_darcy: none,
            dissipated_method: none,
            dissipated_loose: none,
            residual: none,
        }
    }
}

impl Look {
    /// What the water of each cell makes of it now [Pa], whatever grains feel.
    fn pressures<const N: usize>(&self, coupled: &Coupled<N>) -> Vec<f64> {
        let lattice = &coupled.lattice;
        let [nx, ny, nz] = lattice.cells;
        let weight = coupled.model.fluid.density * coupled.grains.model().gravity.z.abs();
        let pressure = |cell: usize| {
            let now = self.water(coupled, cell) * f64::from(self.bed[cell][2]);
            let depth = ((nz - cell / (nx * ny)) as f64 - 0.5) * lattice.height;
            let least = coupled
                .model
                .cavitation
                .map(|c| c.pressure - weight * depth);
            least.map_or(now, |least| now.max(least))
        };
        (0..lattice.count()).map(pressure).collect()
    }

    /// Water of a cell beyond that at rest [m³].
    fn water<const N: usize>(&self, coupled: &Coupled<N>, cell: usize) -> f64 {
        let cube = coupled.lattice.spacing.powi(3);
        let water = f64::from(self.contents[cell][3]) * cube;
        water - f64::from(self.vapour[cell]) - f64::from(self.looks[cell][0])
    }

    fn snapshot<const N: usize>(&self, coupled: &Coupled<N>) -> Snapshot {
        let lattice = &coupled.lattice;
        let scaling = coupled.fluid.scaling();
        let speed = scaling.spacing / scaling.step;
        let stretch = lattice.height / lattice.spacing;
        let each = |numbers: &[f32]| -> Vec<f64> { numbers.iter().map(|&x| x.into()).collect() };
        Snapshot {
            bottom: lattice.bottom,
            height: lattice.height,
            pressure: self.looks.iter().map(|&[_, p]| p.into()).collect(),
            flux: self
                .contents
                .iter()
                .map(|row| {
                    let [x, y, z] = [0, 1, 2].map(|axis| f64::from(row[axis]) * speed);
                    [x / stretch, y / stretch, z]
                })
                .collect(),
            porosity: self.bed.iter().map(|cell| cell[3].into()).collect(),
            vapour: each(&self.vapour),
            content: (0..lattice.count())
                .map(|cell| self.water(coupled, cell))
                .sum(),
        }
    }

    fn report<const N: usize>(&self, coupled: &Coupled<N>) -> Report {
        let mean = self.loads.iter().map(|&load| f64::from(load)).sum::<f64>();
        let least = 0.01 * mean / self.loads.len().max(1) as f64;
        let loose = self.loads.iter().filter(|&&load| f64::from(load) <= least);
        let rattlers = loose.count() as f64 / self.loads.len().max(1) as f64;
        Report::of_numbers(crate::report::Numbers {
            model: &coupled.model,
            lattice: &coupled.lattice,
            porosity: coupled.porosity,
            steps: coupled.choice,
            rattlers,
            drift: None,
            events: &coupled.events,
            scaling: Some(coupled.fluid.scaling()),
        })
    }
}
