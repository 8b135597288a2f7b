//! Models of few parts.

use lbm::{Bed, Ends, Field, Fluid, Model, Regime, Side, Signal, State};

/// Free water of viscosity 0.05 cells² a step or so, periodic along each axis.
pub fn free(cells: [usize; 3]) -> Model {
    Model {
        cells,
        spacing: 1.0,
        fluid: Fluid {
            density: 1.0,
            viscosity: 0.05,
            compressibility: 1.0,
        },
        bed: None,
        ends: [Ends::Periodic, Ends::Periodic, Ends::Periodic],
        solid: Vec::new(),
        acceleration: [0.0; 3],
        inertia: false,
        regime: None,
        step: None,
        speed: 1e-2,
    }
}

/// Cold water in a bed whose porosity and permeability vary from cell to cell.
pub fn porous(cells: [usize; 3]) -> Model {
    let n = cells.iter().product();
    let random = scatter(2 * n);
    let (first, second) = random.split_at(n);
    Model {
        spacing: 0.1,
        fluid: Fluid::COLD_WATER,
        bed: Some(Bed {
            porosity: Field::Cells(first.iter().map(|x| 0.3 + 0.2 * x).collect()),
            permeability: Field::Cells(second.iter().map(|x| 1e-13 * (1.0 + x)).collect()),
            forchheimer: None,
        }),
        regime: Some(Regime::Diffusive),
        speed: 0.0,
        ..free(cells)
    }
}

/// Water in a bed so open that its pressure travels as waves.
pub fn open(cells: [usize; 3]) -> Model {
    let mut model = porous(cells);
    model.regime = Some(Regime::Acoustic);
    let bed = model.bed.as_mut().expect("there is a bed");
    let n = cells.iter().product();
    bed.permeability = Field::Cells(scatter(n).iter().map(|x| 1e-9 * (1.0 + x)).collect());
    model
}

/// A rough start: pressures up to `pressure` and fluxes up to `flux` of either sign.
pub fn rough(model: &Model, pressure: f64, flux: f64) -> State {
    let mut state = State::at_rest(model);
    let n = state.pressure.len();
    let random = scatter(4 * n);
    for cell in 0..n {
        if model.solid.get(cell) == Some(&true) {
            continue;
        }
        let [p, x, y, z] = [0, 1, 2, 3].map(|k| 2.0 * random[4 * cell + k] - 1.0);
        state.pressure[cell] = p * pressure;
        state.flux[cell] = [x, y, z].map(|q| q * flux);
    }
    state
}

/// Steady pressures at the ends of an axis.
pub fn pressures(lower: f64, upper: f64) -> Ends {
    Ends::Walls(
        Side::Pressure(Signal::Steady(lower)),
        Side::Pressure(Signal::Steady(upper)),
    )
}

/// Walls at rest, to which water sticks.
pub fn no_slip() -> Ends {
    Ends::Walls(Side::NoSlip([0.0; 3]), Side::NoSlip([0.0; 3]))
}

/// Numbers between 0 and 1 without structure, the same each time.
pub fn scatter(n: usize) -> Vec<f64> {
    let mut x = 0x2545_f491_4f6c_dd1d_u64;
    let next = |_| {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(next).collect()
}
