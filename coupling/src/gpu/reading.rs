//! What is read from the water. Reading never changes the run.

use super::coupled::Coupled;
use crate::{Error, Ledger, Report, Snapshot, State};
use lbm::Side;

/// All that readings are made from.
struct Look {
    contents: Vec<[f32; 4]>,
    collected: Vec<f32>,
    bed: Vec<[f32; 4]>,
    pressures: Vec<f32>,
    vapour: Vec<f32>,
    loads: Vec<f32>,
}

impl<const N: usize> Coupled<N> {
    fn look(&self) -> Result<Look, Error> {
        let arrays = &self.arrays;
        let cells = 0..self.lattice.count();
        let mut reading = self.device.reading();
        let contents = reading.add(&arrays.contents, cells.clone());
        let collected = reading.add(&arrays.collected, cells.clone());
        let bed = reading.add(&arrays.bed, cells.clone());
        let pressures = reading.add(&arrays.pressures, cells.clone());
        let vapour = arrays
            .vapour
            .as_ref()
            .map(|vapour| reading.add(vapour, cells.clone()));
        let loads = reading.add(&arrays.mean_loads, 0..arrays.mean_loads.len());
        let arrived = reading.wait()?;
        Ok(Look {
            contents: arrived.take(contents),
            collected: arrived.take(collected),
            bed: arrived.take(bed),
            pressures: arrived.take(pressures),
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
            pressure: now.pressure,
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
    /// `now` in the pores: what the walls have squeezed out and the pores do not hold. No number
    /// where a pressure is prescribed at both.
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
            [None, None] => [f64::NAN; 2],
        })
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
        let each = now.pressure.iter().zip(&look.bed).zip(&look.contents);
        let cube = self.lattice.spacing.powi(3);
        let elastic = each.enumerate().map(|(cell, ((&p, bed), contents))| {
            let storage = 1.0 / f64::from(bed[2]);
            let whole = 0.5 * storage * p * p;
            if self.model.cavitation.is_none() {
                return whole;
            }
            // Beyond what the least pressure stretches vapour has opened.
            let gone = f64::from(look.vapour[cell]) + f64::from(look.collected[cell]);
            let water = f64::from(contents[3]) * cube - gone;
            whole - p.min(0.0) * (storage * p - water).max(0.0)
        });
        let none = f64::NAN;
        Ledger {
            elastic: elastic.sum(),
            content: now.content,
            vapour: now.vapour.iter().sum(),
            pores: now.porosity.iter().sum::<f64>() * self.lattice.volume(),
            work_grains: none,
            work_walls: none,
            work_sides: none,
            dissipated_darcy: none,
            dissipated_loose: none,
            residual: none,
        }
    }
}

impl Look {
    fn snapshot<const N: usize>(&self, coupled: &Coupled<N>) -> Snapshot {
        let lattice = &coupled.lattice;
        let scaling = coupled.fluid.scaling();
        let cube = lattice.spacing.powi(3);
        let speed = scaling.spacing / scaling.step;
        let stretch = lattice.height / lattice.spacing;
        let each = |numbers: &[f32]| -> Vec<f64> { numbers.iter().map(|&x| x.into()).collect() };
        let content = |cell: usize| {
            let water = f64::from(self.contents[cell][3]) * cube;
            water - f64::from(self.vapour[cell]) - f64::from(self.collected[cell])
        };
        Snapshot {
            bottom: lattice.bottom,
            height: lattice.height,
            pressure: each(&self.pressures),
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
            content: (0..lattice.count()).map(content).sum(),
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
