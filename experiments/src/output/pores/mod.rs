//! What water between grains leaves behind: its numbers in `series.nc`, its layers in
//! `profiles.nc`, and `fluid.nc`, every cell at some instants.

mod cells;
mod fields;
mod profiles;
mod scalars;

pub(super) use cells::CellsFile;
pub use fields::{FIELDS, Field};
pub use profiles::{PROFILES, Profile};
pub use scalars::{ON_CPU_ALONE, SCALARS, Scalar};

use coupling::{Ledger, Report, Snapshot};
use serde_json::{Value, json};

/// Water between grains at one instant.
#[derive(Clone, Debug)]
pub struct PoreReading {
    /// Pressure, flux, porosity and vapour of the cells.
    pub now: Snapshot,
    /// The numbers of the coupling.
    pub report: Report,
    /// Where the water's energy and volume are.
    pub ledger: Ledger,
    /// Its force on the bottom and the top wall, away from the grains [N].
    pub on_walls: [f64; 2],
    /// Pressure that is prescribed at the bottom and the top now [Pa]; none: no such wall.
    pub prescribed: [Option<f64>; 2],
    /// Volume that left through the bottom and the top since the phase began [m³].
    pub left: [f64; 2],
}

/// The cells of the water between grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cells {
    /// Their number along x, y, z.
    pub count: [usize; 3],
    /// Their length along x and y [m].
    pub spacing: f64,
}

impl PoreReading {
    /// Number of layers of cells.
    fn layers(&self) -> usize {
        (self.report.height / self.now.height).round() as usize
    }

    /// The report as an attribute, in SI units, null where a number is not known or has no meaning; `rate` is that of shear strain [1/s], zero without.
    pub fn attribute(&self, rate: f64) -> Value {
        let report = &self.report;
        // Open pores have no lattice, and nothing diffuses there between two steps.
        let of_lattice = |number: f64| report.lattice.map(|_| number);
        json!({
            "regime": report.lattice.map_or("open".into(), |lattice| format!("{:?}", lattice.regime).to_lowercase()),
            "exchange": report.exchange,
            "interval": report.interval,
            "sub_steps": report.sub_steps,
            "D_n": of_lattice(report.diffusivity),
            "sigma": of_lattice(report.drag),
            "courant": of_lattice(report.courant),
            "porosity": report.porosity,
            "permeability": report.permeability,
            "storage": report.storage,
            "stiffness": report.stiffness,
            "S_M": report.stiffness.map(|m| m * report.storage),
            "B": report.skempton,
            "height": report.height,
            "drainage_time": report.drainage_time,
            "deborah": report.deborah(rate),
            "rattlers": report.rattlers,
        })
    }
}
