//! Water in beds whose pores are open: coarse grains, suspensions, clear water.
//!
//! There pressure spreads over thousands of cells in a grain step, far beyond what sub-steps of
//! a lattice can follow, and what holds the water back is its own mass rather than drag. So its
//! momentum is solved, with a pressure that is implicit in time. At each face, per volume of
//! water with velocity u among grains of mean velocity v,
//!
//! > ρ (u' - u)/dt = -∇p' - φ R (u' - v) + μ ∇²u/φ,   q' = φ (u' - v),
//! > N' = N - dt ∮(v + q') dA,   N' = β V_p p',
//!
//! and the grains get -∇p' - φ ρ (u' - u)/dt + μ ∇²u per volume of bed: what the gradient of
//! pressure gives to both, less what the water keeps. In slow flow that is -∇p = R q, of which
//! (1 - φ) is pressure and φ drag. Where there is no grain it is nothing, whatever the pressure.
//!
//! Solid fraction and drag are those of the faces, 1 - φ = Σ V K, with the weights by which
//! forces reach the grains: so the drag on all of them is that of all of their volume, down to a
//! single grain (means of cells would lose a part of it, an eighth to a half by estimate). Every grain counts alike, and each is
//! dragged to the mean of its face as it is by the water.
//!
//! At a tight wall no water passes, so that the flux against the grains in the half cell before it is
//! their velocity v against the wall, and they get -R v per volume of bed; the wall gets the reaction.
//!
//! Not solved: convection of momentum (wakes longer than a cell; `convection.rs` measures what is
//! left out, 2.5 % of the drag in suspensions at a Reynolds number of 11 000), turbulence, lubrication.
//!
//! Proof: coupling/tests/verification/{settling,fluidisation,open_books}.rs

mod books;
mod convection;
mod faces;
mod grid;
mod share;
mod solve;

pub(crate) use books::Books;
pub(crate) use share::share;

use crate::lattice::Lattice;
use crate::{Error, Resistance};
use convection::Convection;
use dem::Row;
use grid::{areas, neighbour, neighbours, nodes};
use lbm::{Fluid, Side};
use share::{Part, Share, Shares};
use solve::{Rows, solve};

/// Least porosity: that of spheres that are pressed into each other.
const POROSITY_LEAST: f64 = 0.05;

/// The water's motion. Nodes are the lower corners of cells and stand for their three lower faces,
/// in columns with one more for the top.
pub(crate) struct Open {
    pub fluid: Fluid,
    pub resistance: Resistance,
    pub sides: [Side; 2],
    /// Grain step [s].
    step: f64,
    /// Time [s].
    pub time: f64,
    /// Solid at the faces, and who is in the half cells at the walls.
    shares: Vec<[Share; 3]>,
    beside_walls: Vec<Part>,
    /// Velocity of the water [m/s], and flux against the grains [m/s].
    velocity: Vec<[f64; 3]>,
    flux: Vec<[f64; 3]>,
    /// Is the velocity known? Else it follows from the flux.
    moving: bool,
    /// What the water keeps of the push at each face of a cell [N].
    pub kept: Vec<Row>,
    /// What happens in the half cells at the bottom and the top of each column.
    pub ends: Vec<[End; 2]>,
    /// Pressure [Pa], and what solves for it.
    pub pressure: Vec<f64>,
    rows: Rows,
    /// Of the step: flux without the gradient of pressure, and flux per gradient; ∇²u μ.
    free: Vec<[f64; 3]>,
    yielding: Vec<[f64; 3]>,
    shear: Vec<[f64; 3]>,
    /// Mean squares of the fluxes through the faces of each cell along each axis, and what would be
    /// left in it without any gradient of pressure [m³].
    squares: Vec<[f64; 3]>,
    right: Vec<f64>,
    /// Where its energy went.
    pub books: Books,
    convection: Convection,
}

/// How the solid moves.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    /// Velocity of each grain [m/s].
    pub each: &'a [Row],
    /// Mean velocities of the grains at the lower faces of each cell [m/s].
    pub faces: &'a [Row],
    /// Velocities of the bottom and the top along z [m/s].
    pub walls: [f64; 2],
}

/// The half cell at a wall.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct End {
    /// Pressure on the wall beyond that in the middle of its cell [Pa].
    pub excess: f64,
    /// Push on the grains there along z, per V K [N/m³].
    pub push: f64,
    /// Their mean velocity along z against a tight wall [m/s].
    slip: f64,
}

impl Open {
    /// Water with a flux [m/s] and a pressure [Pa] in each cell; without the flux it stands still.
    /// `kept`: are there books of its energy?
    pub fn new(
        model: &crate::Model,
        lattice: &Lattice,
        step: f64,
        time: f64,
        flux: Option<&[[f64; 3]]>,
        pressure: Vec<f64>,
        kept: bool,
    ) -> Self {
        let count = lattice.count();
        let nodes = nodes(lattice);
        let mut open = Self {
            fluid: model.fluid,
            resistance: model.resistance,
            sides: model.sides.clone(),
            step,
            time,
            shares: vec![[Share::default(); 3]; nodes],
            beside_walls: Vec::new(),
            velocity: vec![[0.0; 3]; nodes],
            flux: vec![[0.0; 3]; nodes],
            moving: flux.is_none(),
            kept: vec![Row::ZERO; count],
            ends: vec![[End::default(); 2]; count / lattice.cells[2]],
            pressure,
            rows: Rows::new(lattice.cells),
            free: vec![[0.0; 3]; nodes],
            yielding: vec![[0.0; 3]; nodes],
            shear: vec![[0.0; 3]; nodes],
            squares: vec![[0.0; 3]; count],
            right: vec![0.0; count],
            books: Books {
                kept,
                ..Books::default()
            },
            convection: Convection::default(),
        };
        let nz = lattice.cells[2];
        let Some(flux) = flux else {
            return open;
        };
        for cell in 0..count {
            let own = flux[lattice.cell_of_lbm(cell)];
            for (axis, (left, right)) in neighbours(lattice, cell).into_iter().enumerate() {
                for (node, there) in [(left, own), (right, own)] {
                    // A face between two cells gets half from each, one at a wall all.
                    let k = node % (nz + 1);
                    let share = if axis == 2 && (k == 0 || k == nz) {
                        1.0
                    } else {
                        0.5
                    };
                    open.flux[node][axis] += share * there[axis];
                }
            }
        }
        open
    }

    /// Take in how the solid, of this density [kg/m³], is shared out among the faces.
    ///
    /// # Errors
    /// Drag that would stop grains within a step: it acts on them a step late.
    pub fn weigh(&mut self, lattice: &Lattice, shares: Shares, density: f64) -> Result<(), Error> {
        if self.moving {
            self.see_convection(lattice);
        }
        let books = self.books.kept && self.moving;
        let before = if books { self.kinetic(lattice) } else { 0.0 };
        self.shares = shares.faces;
        self.beside_walls = shares.ends;
        if books {
            self.books.method += before - self.kinetic(lattice);
        }
        let all = self.shares.as_flattened().iter();
        let paces = all.zip(self.flux.as_flattened()).map(|(share, flux)| {
            let drag = share.resistance(&self.resistance, &self.fluid, flux.abs());
            self.step * drag / (density * share.solid.max(f64::MIN_POSITIVE))
        });
        let most = paces.fold(0.0, f64::max);
        if most <= 1.0 {
            return Ok(());
        }
        Err(Error::Invalid(format!(
            "drag stops grains within {:.1e} s, less than the grain step: give a step of at most \
             {:.1e} s",
            self.step / most,
            0.5 * self.step / most
        )))
    }

    /// One grain step. `gone`: volume that the grains have brought to the cells [m³]; `storage`:
    /// β V_p [m³/Pa]; `content` is that of the cells [m³].
    pub fn advance(
        &mut self,
        lattice: &Lattice,
        motion: &Motion,
        gone: &[f64],
        storage: &[f64],
        content: &mut [f64],
    ) -> Result<(), Error> {
        let Motion {
            each,
            faces: solid,
            walls,
        } = *motion;
        self.time += self.step;
        let nz = lattice.cells[2];
        let grains = |node: usize| {
            let (column, k) = (node / (nz + 1), node % (nz + 1));
            match k {
                0 => along_z(solid[column * nz].0, walls[0]),
                k if k == nz => [0.0, 0.0, walls[1]],
                k => along_z(solid[column * nz + k].0, solid[column * nz + k].0[2]),
            }
        };
        if !self.moving {
            self.moving = true;
            for node in 0..self.velocity.len() {
                let v = grains(node);
                for axis in 0..3 {
                    let phi = porosity(&self.shares[node][axis]);
                    self.velocity[node][axis] = v[axis] + self.flux[node][axis] / phi;
                }
            }
            self.books.brought = self.kinetic(lattice);
        }
        self.shear(lattice);
        let outside = self.react(lattice, &grains);
        self.rows.lay(lattice, storage, &self.yielding, self.step);
        let areas = areas(lattice);
        for cell in 0..lattice.count() {
            let mut out = 0.0;
            for (axis, (lower, upper)) in neighbours(lattice, cell).into_iter().enumerate() {
                out += areas[axis] * (self.free[upper][axis] - self.free[lower][axis]);
            }
            self.right[cell] = content[cell] - gone[cell] - self.step * out;
        }
        for column in 0..lattice.count() / nz {
            let ends = [(0, 0), (nz - 1, nz)];
            for (side, (k, node)) in ends.into_iter().enumerate() {
                let yielding = self.yielding[column * (nz + 1) + node][2];
                self.right[column * nz + k] += self.step * areas[2] * yielding * outside[side];
            }
        }
        solve(&mut self.rows, &self.right, &mut self.pressure)?;
        self.flow(lattice, outside, &grains);
        self.stand(lattice, each, walls);
        if self.books.kept {
            self.book_pressure(storage, content);
            self.book_sides(lattice, outside);
        }
        for cell in 0..lattice.count() {
            let mut out = 0.0;
            for (axis, (lower, upper)) in neighbours(lattice, cell).into_iter().enumerate() {
                out += areas[axis] * (self.flux[upper][axis] - self.flux[lower][axis]);
            }
            content[cell] -= gone[cell] + self.step * out;
        }
        Ok(())
    }

    /// Flux against the grains at the centres of the cells [m/s], in the order of `lbm`.
    pub fn flux_of_cells(&self, lattice: &Lattice) -> Vec<[f64; 3]> {
        let mut flux = vec![[0.0; 3]; lattice.count()];
        for cell in 0..lattice.count() {
            for (axis, (lower, upper)) in neighbours(lattice, cell).into_iter().enumerate() {
                let mean = 0.5 * (self.flux[lower][axis] + self.flux[upper][axis]);
                flux[lattice.cell_of_lbm(cell)][axis] = mean;
            }
        }
        flux
    }

    /// Volume that left through the bottom and the top in the last step [m³].
    pub fn left(&self, lattice: &Lattice) -> [f64; 2] {
        let nz = lattice.cells[2];
        let mut upward = [0.0; 2];
        for column in self.flux.chunks_exact(nz + 1) {
            upward[0] += column[0][2];
            upward[1] += column[nz][2];
        }
        let unit = self.step * areas(lattice)[2];
        [-unit * upward[0], unit * upward[1]]
    }

    /// Momentum of the water [N s], the half cells at permeable walls left out.
    pub fn momentum(&self, lattice: &Lattice) -> [f64; 3] {
        let nz = lattice.cells[2];
        let mut sum = [0.0; 3];
        for node in 0..self.shares.len() {
            let k = node % (nz + 1);
            for axis in 0..3 {
                if k < nz && (axis < 2 || k > 0) {
                    let mass =
                        self.fluid.density * lattice.volume() * porosity(&self.shares[node][axis]);
                    sum[axis] += mass * self.velocity[node][axis];
                }
            }
        }
        sum
    }
}

fn porosity(share: &Share) -> f64 {
    (1.0 - share.solid).max(POROSITY_LEAST)
}

fn along_z(row: [f64; 4], z: f64) -> [f64; 3] {
    [row[0], row[1], z]
}
