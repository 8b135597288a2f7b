//! What water between grains adds to `series.nc`.

use super::PoreReading;
use crate::output::Frame;
use crate::protocol::TOP;
use dem::output::{Storage, Variable};
use dem::{Sums, measure};

/// A number of the whole bed.
#[derive(Debug)]
pub struct Scalar {
    /// How the file describes it.
    pub variable: Variable,
    /// Its value; NaN where it has no meaning.
    pub read: fn(&Frame, &PoreReading) -> f64,
}

const fn scalar(
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    read: fn(&Frame, &PoreReading) -> f64,
) -> Scalar {
    let variable = Variable {
        name,
        dims: &[],
        units,
        long_name,
        storage: Storage::Double,
    };
    Scalar { variable, read }
}

/// Index of the bottom wall in [`dem::Model::walls`].
const BOTTOM: usize = 0;

/// All of them.
pub static SCALARS: &[Scalar] = &[
    scalar(
        "pore_pressure_mean",
        "Pa",
        "mean pressure of the water beyond that at rest",
        |_, water| mean(&water.now.pressure),
    ),
    scalar(
        "pore_pressure_base",
        "Pa",
        "mean pressure of the water beyond that at rest, lowest layer of cells",
        |_, water| mean(layer(water, &water.now.pressure, Layer::Lowest)),
    ),
    scalar(
        "pore_pressure_top",
        "Pa",
        "mean pressure of the water beyond that at rest, uppermost layer of cells",
        |_, water| mean(layer(water, &water.now.pressure, Layer::Uppermost)),
    ),
    scalar(
        "effective_stress_top",
        "Pa",
        "normal stress of the grains on the top wall",
        |frame, _| of_grains(frame, TOP),
    ),
    scalar(
        "effective_stress_bottom",
        "Pa",
        "normal stress of the grains on the bottom wall",
        |frame, _| of_grains(frame, BOTTOM),
    ),
    scalar(
        "total_stress_top",
        "Pa",
        "normal stress of grains and water on the top wall",
        |frame, water| of_grains(frame, TOP) + water.on_walls[1] / area(frame),
    ),
    scalar(
        "total_stress_bottom",
        "Pa",
        "normal stress of grains and water on the bottom wall",
        |frame, water| of_grains(frame, BOTTOM) + water.on_walls[0] / area(frame),
    ),
    scalar(
        "friction_total",
        "1",
        "shear stress over total normal stress at the top, means since the last row with the \
         water's part at this instant; none without load",
        friction,
    ),
    scalar(
        "darcy_flux_base",
        "m s-1",
        "mean upward flux of water through the lowest layer of cells",
        |_, water| upward(water, Layer::Lowest),
    ),
    scalar(
        "darcy_flux_top",
        "m s-1",
        "mean upward flux of water through the uppermost layer of cells",
        |_, water| upward(water, Layer::Uppermost),
    ),
    scalar(
        "water_volume",
        "m3",
        "volume of the water between the walls, at zero pressure; what it loses has left through \
         the drained sides",
        water_volume,
    ),
    scalar(
        "water_left_bottom",
        "m3",
        "volume of water that left through the bottom wall since the phase began",
        |_, water| water.left[0],
    ),
    scalar(
        "water_left_top",
        "m3",
        "volume of water that left through the top wall since the phase began",
        |_, water| water.left[1],
    ),
    scalar(
        "vapour_volume",
        "m3",
        "volume of vapour where the water broke",
        |_, water| water.ledger.vapour,
    ),
    scalar(
        "elastic_energy_water",
        "J",
        "energy of the compressed water",
        |_, water| water.ledger.elastic,
    ),
    scalar(
        "kinetic_energy_water",
        "J",
        "kinetic energy of the water; zero where drag holds it, which leaves it without inertia",
        |_, water| water.ledger.kinetic,
    ),
    scalar(
        "work_water",
        "J",
        "work of the water on the grains since the phase began",
        |frame, _| match frame.model.ledger {
            true => frame.snapshot.ledger.work_companion,
            false => f64::NAN,
        },
    ),
    scalar(
        "work_walls_water",
        "J",
        "work of the walls on the water since the phase began",
        |_, water| water.ledger.work_walls,
    ),
    scalar(
        "work_sides_water",
        "J",
        "work of the pressure at drained sides on the water since the phase began",
        |_, water| water.ledger.work_sides,
    ),
    scalar(
        "dissipated_darcy",
        "J",
        "energy lost in the flow of water through the bed since the phase began",
        |_, water| water.ledger.dissipated_darcy,
    ),
    scalar(
        "dissipated_method_water",
        "J",
        "energy that the water lost to the method since the phase began: in open pores, whose \
         pressure is implicit in time",
        |_, water| water.ledger.dissipated_method,
    ),
    scalar(
        "dissipated_loose",
        "J",
        "energy that loose grains lost to the water since the phase began",
        |_, water| water.ledger.dissipated_loose,
    ),
    scalar(
        "energy_residual_water",
        "J",
        "work that arrived at the water and is not found: work - change of energy - dissipation",
        |_, water| water.ledger.residual,
    ),
    scalar(
        "rattlers",
        "1",
        "part of the grains that carry less than a hundredth of the mean load",
        |_, water| water.report.rattlers,
    ),
    scalar(
        "solid_fraction_drift",
        "1",
        "root of the mean square over the cells of the solid found there less what flowed there with \
         the mean velocity of the grains that carry load, since the phase began",
        |_, water| water.report.drift.unwrap_or(f64::NAN),
    ),
];

/// Those that only the CPU computes: the books of the water's energy need sums over each of its steps in
/// double precision. On a graphics device they are no numbers, and the file says so.
pub static ON_CPU_ALONE: [&str; 6] = [
    "work_walls_water",
    "work_sides_water",
    "dissipated_darcy",
    "dissipated_loose",
    "energy_residual_water",
    "solid_fraction_drift",
];

/// Which of the layers of cells.
#[derive(Clone, Copy)]
enum Layer {
    Lowest,
    Uppermost,
}

/// The cells of a layer; z varies slowest.
fn layer<'a, T>(water: &PoreReading, cells: &'a [T], layer: Layer) -> &'a [T] {
    let plane = cells.len() / water.layers();
    match layer {
        Layer::Lowest => &cells[..plane],
        Layer::Uppermost => &cells[cells.len() - plane..],
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn upward(water: &PoreReading, which: Layer) -> f64 {
    let cells = layer(water, &water.now.flux, which);
    cells.iter().map(|flux| flux[2]).sum::<f64>() / cells.len() as f64
}

fn area(frame: &Frame) -> f64 {
    frame.model.domain.area()
}

fn of_grains(frame: &Frame, wall: usize) -> f64 {
    frame.snapshot.wall_force[wall] / area(frame)
}

/// Room between the walls less the grains, and what the water is compressed.
fn water_volume(frame: &Frame, water: &PoreReading) -> f64 {
    let grains = &frame.snapshot.state.grains;
    let solid: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    let height = measure::wall_height(&frame.model, &frame.snapshot.state, TOP);
    area(frame) * height - solid + water.ledger.content
}

/// Mean of a force since the last row [N].
fn since(frame: &Frame, now: f64, sum: impl Fn(&Sums) -> f64) -> f64 {
    let sums = &frame.snapshot.sums;
    match sums.steps - frame.before.steps {
        0 => now,
        steps => (sum(sums) - sum(&frame.before)) / steps as f64,
    }
}

/// NaN where nothing presses.
fn friction(frame: &Frame, water: &PoreReading) -> f64 {
    let now = &frame.snapshot;
    let shear = -since(frame, now.driven_force, |sums| sums.driven_force);
    // The sums before the first step have no walls yet.
    let on_top = |sums: &Sums| sums.wall_force.get(TOP).copied().unwrap_or(0.0);
    let normal = since(frame, now.wall_force[TOP], on_top) + water.on_walls[1];
    if normal <= 0.0 {
        return f64::NAN;
    }
    shear / normal
}
