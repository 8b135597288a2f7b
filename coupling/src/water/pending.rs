//! What has happened since the last exchange, for those who read in between.

use super::Water;
use dem::Row;

/// Ways and volumes since the last exchange.
pub(crate) struct Pending {
    /// Steps since then, and over those from it to the middle of the kicks that it has made.
    pub steps: u64,
    pub part: Option<f64>,
    /// Ways of the grains, in the solver's order, and of the walls along their normals [m].
    pub ways: Vec<Row>,
    pub wall_ways: Vec<f64>,
    /// Mean velocities of the faces [m/s].
    pub velocity: Vec<Row>,
    /// Volume that they have brought to each cell [m³].
    pub volume: Vec<f64>,
}

impl Pending {
    pub fn nothing<const N: usize>(water: &Water<N>) -> Self {
        let count = water.lattice.count();
        Self {
            steps: 0,
            part: None,
            ways: vec![Row::ZERO; water.exchange.count],
            wall_ways: Vec::new(),
            velocity: vec![Row::ZERO; count],
            volume: vec![0.0; count],
        }
    }

    pub fn of<const N: usize>(water: &Water<N>, grains: &dem::Solver) -> Self {
        let (steps, ways, wall_ways) = grains.since_exchange();
        let mut pending = Self {
            steps,
            ways,
            wall_ways,
            ..Self::nothing(water)
        };
        let ahead = water.steps_ahead(grains.bed().step - steps);
        if ahead > 0.0 {
            pending.part = Some(steps as f64 / ahead);
        }
        if steps == 0 {
            return pending;
        }
        let pass = water.pass();
        let passed = steps as f64 * water.step;
        let [bottom, top] = water.walls.map(|k| pending.wall_ways[k] / passed);
        let walls = [bottom, -top];
        pending.velocity = pass.flow_of(&water.exchange.counts, &pending.ways);
        for plane in 0..water.lattice.cells[0] {
            let velocity = &mut pending.velocity[water.lattice.cells_of(plane)];
            pass.mean_velocities(plane, 1.0 / passed, walls, velocity);
        }
        for plane in 0..water.lattice.cells[0] {
            let volume = &mut pending.volume[water.lattice.cells_of(plane)];
            pass.brought(plane, &pending.velocity, walls[1], |own, flux| {
                volume[own] = passed * flux;
            });
        }
        pending
    }
}
