//! Where the energy of the water in open pores goes.
//!
//! Its momentum times φ u', summed over faces with their volumes V, and what cells store times p':
//!
//! > Δ(½ Σ ρ φ V u²) + Δ(½ Σ β V_p p²) = W_grains + W_walls + W_sides
//! >   - dt Σ V (R q'² - μ u'·∇²u) - ½ Σ ρ φ V (u' - u)² - ½ Σ β V_p (p' - p)².
//!
//! The last two are lost to no law, but to steps that are implicit in time. So is what goes with
//! pores that grains leave and enter from one renewal to the next, whose water keeps its velocity
//! where it is: momentum is not carried along.

use super::{Open, areas, porosity};
use crate::lattice::Lattice;
use lbm::Side;

/// Sums since the pores opened [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Books {
    /// Does anyone ask for them?
    pub kept: bool,
    /// Work of what presses water in through open sides.
    pub sides: f64,
    /// Lost by drag, and by the shear of the water itself.
    pub drag: f64,
    pub shear: f64,
    /// Lost to the method.
    pub method: f64,
    /// Kinetic energy that the water came with.
    pub brought: f64,
}

impl Open {
    /// Kinetic energy of the water [J].
    pub fn kinetic(&self, lattice: &Lattice) -> f64 {
        let each = self.shares.iter().zip(&self.velocity).enumerate();
        let each = each.flat_map(|(node, (shares, velocity))| {
            (0..3).map(move |axis| {
                let mass = self.fluid.density * porosity(&shares[axis]);
                0.5 * mass * self.volume(lattice, node, axis) * velocity[axis].powi(2)
            })
        });
        each.sum()
    }

    /// Volume that a face stands for [m³]: half a cell at a wall through which water flows, none at
    /// a tight one.
    fn volume(&self, lattice: &Lattice, node: usize, axis: usize) -> f64 {
        let nz = lattice.cells[2];
        let k = node % (nz + 1);
        let share = match (axis, k) {
            (2, 0) => self.half(0),
            (2, k) if k == nz => self.half(1),
            (_, k) if k == nz => 0.0,
            _ => 1.0,
        };
        share * lattice.volume()
    }

    fn half(&self, side: usize) -> f64 {
        match self.sides[side] {
            Side::Pressure(_) | Side::Flux(_) => 0.5,
            _ => 0.0,
        }
    }

    /// A face has been moved from velocity `before` to that which it has now by the pressure that
    /// drops over it by `gradient` [Pa/m].
    pub(super) fn book_face(
        &mut self,
        lattice: &Lattice,
        [node, axis]: [usize; 2],
        before: f64,
        gradient: f64,
    ) {
        let volume = self.volume(lattice, node, axis);
        let (flux, velocity) = (self.flux[node][axis], self.velocity[node][axis]);
        let phi = porosity(&self.shares[node][axis]);
        let change = velocity - before;
        let shear = self.shear[node][axis];
        let inertia = self.fluid.density * change;
        // What is left of the push per volume of water is drag, φ R (u' - v).
        let drag = gradient + shear / phi - inertia / self.step;
        self.books.drag += self.step * volume * drag * flux;
        self.books.shear -= self.step * volume * shear * velocity;
        self.books.method += 0.5 * phi * volume * inertia * change;
    }

    /// Pressure has been found, with the `content` [m³] of before.
    pub(super) fn book_pressure(&mut self, storage: &[f64], content: &[f64]) {
        let cells = self.pressure.iter().zip(storage).zip(content);
        let each = cells.map(|((p, storage), content)| storage * (p - content / storage).powi(2));
        self.books.method += 0.5 * each.sum::<f64>();
    }

    /// The step is made, with these pressures outside [Pa] where they are prescribed.
    pub(super) fn book_sides(&mut self, lattice: &Lattice, outside: [f64; 2]) {
        let nz = lattice.cells[2];
        let unit = self.step * areas(lattice)[2];
        for (column, ends) in self.ends.iter().enumerate() {
            for (side, (cell, node)) in [(0, 0), (nz - 1, nz)].into_iter().enumerate() {
                let pressure = match self.sides[side] {
                    Side::Pressure(_) => outside[side],
                    Side::Flux(_) => self.pressure[column * nz + cell] + ends[side].excess,
                    _ => continue,
                };
                let upward = self.flux[column * (nz + 1) + node][2];
                let into = if side == 0 { upward } else { -upward };
                self.books.sides += unit * into * pressure;
            }
        }
    }
}
