//! All arrays of a solver on the device, under the names that the kernels know.

use super::bindings::Bindings;
use super::rows::Rows;
use super::setting::{Range, Setting};
use super::sides::Given;
use super::slab::SLAB;
use super::steps::TICKS;
use crate::collide::Coefficients;
use crate::grid::Grid;
use crate::{Error, Model};
use shaders::{Array, Bindable, Device};

/// Names of the parts of the populations.
const PARTS: [&str; 19] = [
    "part_a", "part_b", "part_c", "part_d", "part_e", "part_f", "part_g", "part_h", "part_i",
    "part_j", "part_k", "part_l", "part_m", "part_n", "part_o", "part_p", "part_q", "part_r",
    "part_s",
];

pub(super) struct Arrays {
    pub setting: Array<Setting>,
    ticks: Array<u32>,
    parts: Vec<Array<f32>>,
    /// One number for each place, by name.
    fields: Vec<(&'static str, Array<f32>)>,
    words: Array<u32>,
    rows: Array<[u32; 9]>,
    pub given: Array<Given>,
    pub slab: Array<f32>,
    pub range: Array<Range>,
    pub wrong: Array<u32>,
}

impl Arrays {
    /// A lattice at rest.
    pub fn new(
        device: &Device,
        (model, grid): (&Model, &Grid),
        bindings: Bindings,
        rows: &Rows,
        coefficients: &Coefficients<f32>,
    ) -> Result<Self, Error> {
        let part = |part: usize| {
            let count = bindings.populations(part) * grid.places();
            device.array("populations", count)
        };
        let mut arrays = Self {
            setting: device.array_of("setting", &[Setting::new(model, grid, coefficients)])?,
            ticks: device.ticks(TICKS)?,
            parts: (0..bindings.parts).map(part).collect::<Result<_, _>>()?,
            fields: Vec::new(),
            words: device.array_of("words", &rows.words)?,
            rows: device.array_of("rows", &rows.rows)?,
            given: device.array("given", TICKS)?,
            slab: device.array("slab", SLAB.min(model.cells.iter().product()) * 19)?,
            range: device.array("range", 1)?,
            wrong: device.array("wrong", 1)?,
        };
        arrays.write_bed(device, coefficients)?;
        Ok(arrays)
    }

    /// Bring the fields of the bed to the device.
    pub fn write_bed(&mut self, device: &Device, k: &Coefficients<f32>) -> Result<(), Error> {
        let fields: [(&'static str, &[f32]); 4] = [
            ("inverse_storage", &k.inverse_storage),
            ("half_drag", &k.half_drag),
            ("half_forchheimer", &k.half_forchheimer),
            ("inverse_porosity", &k.inverse_porosity),
        ];
        let fields = fields.into_iter().filter(|(_, values)| !values.is_empty());
        fields
            .into_iter()
            .try_for_each(|(name, values)| self.write(device, name, values))
    }

    /// Room for sources that the device makes itself.
    pub fn make_sources(&mut self, device: &Device, places: usize) -> Result<(), Error> {
        self.write(device, "sources", &vec![0.0; places])
    }

    /// Bring the sources to the device.
    pub fn write_source(&mut self, device: &Device, k: &Coefficients<f32>) -> Result<(), Error> {
        self.write(device, "sources", &k.source)
    }

    fn write(&mut self, device: &Device, name: &'static str, values: &[f32]) -> Result<(), Error> {
        match self.fields.iter().find(|(known, _)| *known == name) {
            Some((_, array)) => device.write(array, 0, values),
            None => self.fields.push((name, device.array_of(name, values)?)),
        }
        Ok(())
    }

    /// By name.
    pub fn named(&self) -> Vec<(&str, &dyn Bindable)> {
        let mut named: Vec<(&str, &dyn Bindable)> = vec![
            ("setting", &self.setting),
            ("tick", &self.ticks),
            ("words", &self.words),
            ("rows", &self.rows),
            ("given", &self.given),
            ("slab", &self.slab),
            ("range", &self.range),
            ("wrong", &self.wrong),
        ];
        for (name, part) in PARTS.iter().zip(&self.parts) {
            named.push((name, part));
        }
        for (name, field) in &self.fields {
            named.push((name, field));
        }
        named
    }

    /// Memory on the device [bytes].
    pub fn bytes(&self) -> u64 {
        let parts: u64 = self.parts.iter().map(Array::bytes).sum();
        let fields: u64 = self.fields.iter().map(|(_, field)| field.bytes()).sum();
        let small = [self.setting.bytes(), self.ticks.bytes(), self.given.bytes()];
        let links = self.words.bytes() + self.rows.bytes();
        let slab = self.slab.bytes() + self.range.bytes() + self.wrong.bytes();
        parts + fields + links + slab + small.iter().sum::<u64>()
    }
}
