//! What is read from the water. Reading never changes the run.

use super::Water;
use super::flow::Flow;
use super::pending::Pending;
use crate::Model;
#[cfg(test)]
use dem::Row;

/// Water at one instant, one entry a cell: x fastest, then y, then z.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Height of the bottom and of a cell [m].
    pub bottom: f64,
    /// Height of a cell [m].
    pub height: f64,
    /// Pressure beyond hydrostatic [Pa]; from one exchange to the next grains feel that expected in
    /// the middle between them.
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

    /// Volume of water that left through the bottom and the top wall since this was made [m³], until
    /// the last fluid step. The sum is exact; where a pressure is prescribed at both, the
    /// shares follow from the flux in the cells beside them at the end of each fluid step.
    pub fn left(&self) -> [f64; 2] {
        self.left
    }

    /// Momentum of the water [N s]; none where drag holds it, which leaves it without inertia.
    pub fn momentum(&self) -> [f64; 3] {
        match &self.flow {
            Flow::Lattice(_) => [0.0; 3],
            Flow::Open(open) => open.momentum(&self.lattice),
        }
    }

    /// The water at the last exchange.
    pub fn snapshot(&self) -> Snapshot {
        self.snapshot_after(&Pending::nothing(self))
    }

    /// The water after what is pending.
    pub(crate) fn snapshot_after(&self, pending: &Pending) -> Snapshot {
        let lattice = &self.lattice;
        let count = lattice.count();
        let mut now = Snapshot {
            bottom: lattice.bottom,
            height: lattice.height,
            pressure: vec![0.0; count],
            flux: self.flux(),
            porosity: vec![0.0; count],
            vapour: vec![0.0; count],
            content: 0.0,
        };
        // SAFETY: a shared borrow between steps: nobody writes.
        let (collected, trends) =
            unsafe { (self.fields.collected.read(), self.fields.trends.read()) };
        for cell in 0..count {
            let at = lattice.cell_of_lbm(cell);
            let gone = collected[cell] + pending.volume[cell];
            now.pressure[at] = match pending.part {
                // What grains feel, on its way from the last exchange.
                Some(part) => {
                    (trends[cell].before + part * trends[cell].rise).max(self.least[cell])
                }
                None => self.pressure()[cell],
            };
            now.porosity[at] = 1.0 - self.solid[cell] / lattice.volume();
            now.vapour[at] = self.vapour[cell];
            now.content += self.content[cell] - self.vapour[cell] - gone;
        }
        now
    }

    /// What must be known to go on after what is pending.
    pub(crate) fn state_after(&self, pending: &Pending) -> State {
        let now = self.snapshot_after(pending);
        let mut pressure = now.pressure;
        if let (Flow::Lattice(_), true) = (&self.flow, self.model.predicts) {
            // SAFETY: a shared borrow between steps: nobody writes.
            let collected = unsafe { self.fields.collected.read() };
            for cell in 0..self.lattice.count() {
                let gone = collected[cell] + pending.volume[cell];
                pressure[self.lattice.cell_of_lbm(cell)] = self.pressure_of(cell, gone);
            }
        }
        State {
            pressure,
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
