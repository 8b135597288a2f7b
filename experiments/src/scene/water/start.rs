//! `[water.start]`: pressure and flow at the start, or a state to go on from.

use super::{Lattice, sides::vector};
use crate::output::water_state;
use crate::scene::reader::{Range, Table};
use crate::scene::units::{STRESS, VELOCITY};
use lbm::{Fluid, State};
use std::f64::consts::TAU;

/// What flows at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flow {
    /// The same everywhere: velocity, or Darcy's flux in a bed [m/s].
    Uniform([f64; 3]),
    /// One period of the vortices of Taylor and Green along x and along z, with this greatest
    /// velocity along x [m/s].
    Vortices(f64),
}

/// Where the water starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Pressure and flow.
    pub state: State,
    /// The fastest flow [m/s].
    pub fastest: f64,
    /// Step [s] and density [kg/m³] of the lattice that a state comes from.
    pub lattice: Option<[f64; 2]>,
}

/// Read the start.
pub fn read(water: &Table, lattice: &Lattice, fluid: Fluid, inertia: bool) -> Option<Start> {
    let example = "[water.start] with pressure = \"10 kPa\"";
    let start = water.table_or_empty("start", example)?;
    if start.has("state") {
        let why = "stands in the state that is read";
        start.refuse(&["pressure", "flow", "vortices"], why);
        return state(&start, lattice);
    }
    let pressure = start.quantity_or("pressure", &STRESS, Range::Any, 0.0);
    let flow = match start.present(&["flow", "vortices"])[..] {
        [] => {
            start.choose("flow", toml_edit::Array::from_iter(["0 m/s"; 3]));
            Flow::Uniform([0.0; 3])
        }
        ["flow"] => Flow::Uniform(vector(&start, "flow")?),
        ["vortices"] => Flow::Vortices(start.quantity("vortices", &VELOCITY, Range::Positive)?),
        _ => {
            start.wrong("vortices", "contradicts flow; remove one of them".into());
            return None;
        }
    };
    let mut state = State {
        time: 0.0,
        thickness: lattice.spacing,
        pressure: vec![pressure; lattice.count()],
        flux: vec![[0.0; 3]; lattice.count()],
        populations: Vec::new(),
    };
    let fastest = match flow {
        Flow::Uniform(velocity) => {
            state.flux.fill(velocity);
            velocity.iter().map(|u| u * u).sum::<f64>().sqrt()
        }
        Flow::Vortices(speed) => {
            let density = if inertia { fluid.density } else { 0.0 };
            vortices(&mut state, lattice, speed, density)
        }
    };
    Some(Start {
        state,
        fastest,
        lattice: None,
    })
}

fn state(start: &Table, lattice: &Lattice) -> Option<Start> {
    let path = start.path("state")?;
    let saved = water_state::load(&path)
        .map_err(|error| start.wrong("state", format!("cannot be read: {error:#}")))
        .ok()?;
    if saved.cells != lattice.cells {
        let (own, cells) = (saved.cells, lattice.cells);
        let what = format!("has {own:?} cells along x, y, z, and the scene has {cells:?}");
        start.wrong("state", format!("{what}; change box.size or water.spacing"));
        return None;
    }
    let fastest = saved
        .state
        .flux
        .iter()
        .map(|u| u.iter().map(|u| u * u).sum::<f64>());
    let fastest = fastest.fold(0.0, f64::max).sqrt();
    Some(Start {
        lattice: Some([saved.step, saved.density]),
        state: saved.state,
        fastest,
    })
}

/// u = U cos kx sin mz, w = -U k/m sin kx cos mz, and the pressure that inertia asks for,
/// p = -ρ U²/4 (cos 2kx + k²/m² cos 2mz), with one wave in the box along x and along z. Returns
/// the greatest component.
/// Source: Taylor and Green (1937), Proc. R. Soc. A 158, 499.
fn vortices(state: &mut State, lattice: &Lattice, speed: f64, density: f64) -> f64 {
    let [k, _, m] = lattice.size().map(|length| TAU / length);
    let ratio = k / m;
    for (cell, (p, u)) in state.pressure.iter_mut().zip(&mut state.flux).enumerate() {
        let [x, _, z] = lattice.middle(cell);
        *u = [
            speed * (k * x).cos() * (m * z).sin(),
            0.0,
            -speed * ratio * (k * x).sin() * (m * z).cos(),
        ];
        let waves = (2.0 * k * x).cos() + ratio * ratio * (2.0 * m * z).cos();
        *p -= 0.25 * density * speed * speed * waves;
    }
    speed * ratio.max(1.0)
}
