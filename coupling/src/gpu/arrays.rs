//! The arrays of the coupling itself, under the names that the kernels know.

use super::numbers::{Course, EXTREMES, Numbers, Span, both_open};
use crate::Model;
use dem::gpu::Solver;
use dem::gpu::search::plan::Grid;
use shaders::{Array, Bindable, Device, Error};

/// Items of a workgroup of the scan (shaders/dem/search/scan.wgsl).
pub(super) const BLOCK: usize = 2048;

pub(super) struct Arrays {
    pub numbers: Array<Numbers>,
    pub course: Array<Course>,
    pub span: Array<Span>,
    pub extremes: Array<u32>,
    /// Numbers 0 to the steps of a group.
    pub ticks: Array<u32>,
    /// What the walls do not feel in each step of a group [N].
    pub taken_off: Array<[f32; 2]>,
    /// 0: the lattice makes no step.
    pub guard: Array<u32>,
    pub factors: Array<[f32; 4]>,
    /// One entry a cell, or its lower faces.
    pub contents: Array<[f32; 4]>,
    pub collected: Array<f32>,
    pub bed: Array<[f32; 4]>,
    pub pressures: Array<f32>,
    pub trends: Array<[f32; 4]>,
    /// For readings: what has been collected until now [m³], and pressure [Pa].
    pub looks: Array<[f32; 2]>,
    pub vapour: Option<Array<f32>>,
    /// What has flowed upward through each cell [m], where both walls are open.
    pub through: Option<Array<[f32; 2]>>,
    pub inverse: Array<[f32; 4]>,
    pub ease: Array<[f32; 4]>,
    pub held: Array<[f32; 4]>,
    pub velocities: Array<[f32; 4]>,
    /// Where the bottom and the top were at the last exchange.
    pub walls_left: Array<dem::gpu::wide::Wide>,
    pub reactions: Array<[f32; 4]>,
    pub pushes: Array<[f32; 4]>,
    pub easing: Array<[f32; 4]>,
    pub shares: Array<f32>,
    pub drag_shares: Array<f32>,
    pub wide: Option<Wide>,
    /// Lists of the grains of each cell.
    pub scan_grid: Array<Grid>,
    pub starts: Array<u32>,
    pub blocks: Array<[u32; 2]>,
    pub filled: Array<u32>,
    pub members: Array<u32>,
    pub slots: Array<[f32; 4]>,
    pub slot_rows: Array<u32>,
    pub slot_ids: Array<u32>,
    pub slot_drags: Array<[f32; 2]>,
    pub row_of: Array<u32>,
    /// Mean load of each grain by identity [N], and sums over workgroups.
    pub mean_loads: Array<f32>,
    pub partial_loads: Array<f32>,
}

/// What the wide kernel has more.
pub(super) struct Wide {
    pub sums: Array<[f32; 4]>,
    pub drag_sums: Array<[f32; 4]>,
    pub wall_shares: Array<[f32; 2]>,
    /// Pushes and easing before the filter.
    pub rough_pushes: Array<[f32; 4]>,
    pub rough_easing: Array<[f32; 4]>,
}

impl Arrays {
    pub fn new(
        device: &Device,
        numbers: &Numbers,
        model: &Model,
        reach: usize,
    ) -> Result<Self, Error> {
        let (cells, grains) = (numbers.count as usize, numbers.grains as usize);
        let four = |name: &str| device.array::<[f32; 4]>(name, cells);
        let group = Solver::GROUP + 1;
        Ok(Self {
            numbers: device.array_of("numbers", &[*numbers])?,
            course: device.array_of("course", &[Course::before(1.0)])?,
            span: device.array("span", 1)?,
            extremes: device.array("extremes", EXTREMES)?,
            ticks: device.ticks(group)?,
            taken_off: device.array("taken_off", group)?,
            guard: device.array_of("guard", &[1])?,
            factors: device.array_of("factors", &[[1.0; 4]])?,
            contents: four("contents")?,
            collected: device.array("collected", cells)?,
            bed: four("bed")?,
            pressures: device.array("pressures", cells)?,
            trends: four("trends")?,
            looks: device.array("looks", cells)?,
            vapour: match model.cavitation {
                Some(_) => Some(device.array("vapour", cells)?),
                None => None,
            },
            through: match both_open(model) {
                true => Some(device.array("through", cells)?),
                false => None,
            },
            inverse: four("inverse")?,
            ease: four("ease")?,
            held: four("held")?,
            velocities: four("velocities")?,
            walls_left: device.array("walls_left", 2)?,
            reactions: four("reactions")?,
            pushes: four("pushes")?,
            easing: four("easing")?,
            shares: device.array("shares", 54 * cells)?,
            drag_shares: device.array("shares", 54 * cells)?,
            wide: match reach > 3 {
                true => Some(Wide {
                    sums: four("sums")?,
                    drag_sums: four("sums")?,
                    wall_shares: device.array("wall_shares", cells)?,
                    rough_pushes: four("pushes")?,
                    rough_easing: four("easing")?,
                }),
                false => None,
            },
            scan_grid: device.array("grid", 1)?,
            starts: device.array("starts", cells + 1)?,
            blocks: device.array("blocks", (cells + 1).div_ceil(BLOCK))?,
            filled: device.array("filled", cells + 1)?,
            members: device.array("members", grains)?,
            slots: device.array("slots", grains)?,
            slot_rows: device.array("slot_rows", grains)?,
            slot_ids: device.array("slot_ids", grains)?,
            slot_drags: device.array("slot_drags", grains)?,
            row_of: device.array("row_of", grains)?,
            mean_loads: device.array("mean_loads", grains)?,
            partial_loads: device.array("partial_loads", grains.div_ceil(64))?,
        })
    }

    /// All but those that go by several names.
    pub fn named(&self) -> Vec<(&'static str, &dyn Bindable)> {
        let mut named: Vec<(&'static str, &dyn Bindable)> = vec![
            ("numbers", &self.numbers),
            ("course", &self.course),
            ("span", &self.span),
            ("extremes", &self.extremes),
            ("tick", &self.ticks),
            ("taken_off", &self.taken_off),
            ("guard", &self.guard),
            ("contents", &self.contents),
            ("collected", &self.collected),
            ("bed", &self.bed),
            ("pressures", &self.pressures),
            ("trends", &self.trends),
            ("looks", &self.looks),
            ("inverse", &self.inverse),
            ("ease", &self.ease),
            ("held", &self.held),
            ("velocities", &self.velocities),
            ("walls_left", &self.walls_left),
            ("reactions", &self.reactions),
            ("starts", &self.starts),
            ("filled", &self.filled),
            ("members", &self.members),
            ("slots", &self.slots),
            ("slot_rows", &self.slot_rows),
            ("slot_ids", &self.slot_ids),
            ("slot_drags", &self.slot_drags),
            ("row_of", &self.row_of),
            ("mean_loads", &self.mean_loads),
            ("partial_loads", &self.partial_loads),
        ];
        if let Some(vapour) = &self.vapour {
            named.push(("vapour", vapour));
        }
        if let Some(through) = &self.through {
            named.push(("through", through));
        }
        if let Some(wide) = &self.wide {
            named.push(("wall_shares", &wide.wall_shares));
        }
        named
    }

    /// Memory on the device [bytes].
    pub fn bytes(&self) -> u64 {
        let named: u64 = self.named().iter().map(|(_, array)| array.bytes()).sum();
        let rest = [&self.pushes, &self.easing];
        let shares = [&self.shares, &self.drag_shares];
        let wide = self.wide.as_ref().map_or(0, |wide| {
            let rows = [
                &wide.sums,
                &wide.drag_sums,
                &wide.rough_pushes,
                &wide.rough_easing,
            ];
            rows.into_iter().map(Bindable::bytes).sum()
        });
        named
            + wide
            + rest.into_iter().map(Bindable::bytes).sum::<u64>()
            + shares.into_iter().map(Bindable::bytes).sum::<u64>()
            + self.blocks.bytes()
            + self.scan_grid.bytes()
    }
}
