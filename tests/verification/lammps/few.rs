//! Cases 1 to 3: two grains, or one on a floor.
//!
//! An independent program that copies each rounding of LAMMPS agrees with them to the last places
//! (2.5e-16 m/s). Ours keeps velocities half a step apart from positions and rounds elsewhere: at
//! a stiffness of 1e9 N/m one unit in the last place of a distance is 3.5e-9 N, and [`QUANTA`] of
//! these are allowed.

use super::{LAW, STEP, model};
use dem::{Grains, Solver, State, Surface};
use glam::DVec3;
use tests::table::Table;
use tests::{GRAVITY, RADIUS, floor, solver};

/// Round-off allowed in cases 1 to 3, in changes of velocity by one [`quantum`]: one for each of
/// the 13 steps of a collision.
const QUANTA: f64 = 13.0;

/// Change of velocity [m/s] of a grain of `mass` [kg] in one step by the force of one unit in
/// the last place of a `distance` [m].
fn quantum(mass: f64, distance: f64) -> f64 {
    let last_place = f64::EPSILON * 2.0_f64.powf(distance.log2().floor());
    LAW.normal_stiffness * last_place * STEP / mass
}

/// How far round-off may have taken a grain.
#[derive(Clone, Copy)]
struct RoundOff {
    /// Of the position [m], and of the velocity [m/s].
    position: f64,
    velocity: f64,
}

impl RoundOff {
    /// Of a grain of `radius` [m] in one collision, `time` [s] after the start.
    fn of_collision(radius: f64, distance: f64, time: f64) -> Self {
        let velocity = QUANTA * quantum(tests::mass(radius), distance);
        Self {
            position: velocity * time + f64::EPSILON * distance,
            velocity,
        }
    }

    fn allows(self, found: &Grains, k: usize, table: &Table, row: &[f64], suffix: &str) {
        // Tangential forces round no worse than normal ones: Δω = (R/I) m Δv.
        let spin = 2.5 * self.velocity / found.radius[k];
        for (before, found, allowed) in [
            ("", found.position[k], self.position),
            ("v", found.velocity[k], self.velocity),
            ("w", found.angular_velocity[k], spin),
        ] {
            let expected = table.vector(row, before, suffix);
            let off = (found - expected).abs().max_element();
            assert!(
                off <= allowed,
                "step {}, {before}x{suffix}: {found} is off by {off:e} of {allowed:e}",
                row[0]
            );
        }
    }
}

/// Grain `k` of `grains` moves as the columns that end with `suffix` say.
fn set(grains: &mut Grains, k: usize, table: &Table, row: &[f64], suffix: &str) {
    grains.position[k] = table.vector(row, "", suffix);
    grains.velocity[k] = table.vector(row, "v", suffix);
    grains.angular_velocity[k] = table.vector(row, "w", suffix);
}

/// Two grains without walls follow the table at each of its steps.
fn follow_pair(name: &str, radii: [f64; 2]) {
    let table = Table::read(name);
    let mut start = tests::state(&radii.map(|r| (DVec3::ZERO, r)), 0);
    set(&mut start.grains, 0, &table, &table.rows[0], "1");
    set(&mut start.grains, 1, &table, &table.rows[0], "2");
    let mut solver = solver(&model(LAW, STEP), &start);
    for row in &table.rows[1..] {
        solver.advance(1).unwrap();
        let now = solver.snapshot();
        assert_eq!(now.sums.steps, row[0] as u64);
        for (k, suffix) in ["1", "2"].iter().enumerate() {
            let round_off = RoundOff::of_collision(radii[k], radii[0] + radii[1], now.state.time);
            round_off.allows(&now.state.grains, k, &table, row, suffix);
        }
    }
}

#[test]
fn case_1_head_on() {
    follow_pair("lammps/case1_headon_equal.csv", [1e-2, 1e-2]);
    follow_pair("lammps/case1_headon_unequal.csv", [8e-3, 1.2e-2]);
}

#[test]
fn case_2_oblique_step_by_step() {
    for angle in [10, 30, 60] {
        follow_pair(
            &format!("lammps/case2_oblique_traj_{angle}.csv"),
            [1e-2, 1e-2],
        );
    }
}

#[test]
fn case_2_oblique_after_the_impact() {
    let table = Table::read("lammps/case2_oblique_final.csv");
    for row in &table.rows {
        let angle = table.get(row, "angle_deg").to_radians();
        let place = DVec3::X * (RADIUS + 5e-9);
        let mut start = tests::state(&[(-place, RADIUS), (place, RADIUS)], 0);
        start.grains.velocity[0] = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let grains = tests::run(&model(LAW, STEP), &start, 400).state.grains;
        let allowed = QUANTA * quantum(tests::mass(RADIUS), 2.0 * RADIUS);
        for (k, suffix) in ["1", "2"].iter().enumerate() {
            let v = grains.velocity[k] - table.vector(row, "v", suffix);
            let w = grains.angular_velocity[k] - table.vector(row, "w", suffix);
            assert!(v.length() < allowed, "{} deg: velocity off by {v}", row[0]);
            let spin = 2.5 / RADIUS * allowed;
            assert!(
                w.length() < spin,
                "{} deg: angular velocity off by {w}",
                row[0]
            );
        }
    }
}

/// One grain on a floor with friction, under gravity, as the table begins.
fn on_floor(table: &Table) -> Solver {
    let mut start = tests::state(&[(DVec3::ZERO, RADIUS)], 1);
    set(&mut start.grains, 0, table, &table.rows[0], "");
    let mut model = model(LAW, STEP);
    model.walls = vec![floor(Surface::Full)];
    model.gravity = -GRAVITY * DVec3::Z;
    solver(&model, &start)
}

/// The state of `solver` at step `until`.
fn state_at(solver: &mut Solver, until: f64) -> State {
    let ahead = until as u64 - solver.snapshot().sums.steps;
    solver.advance(ahead).unwrap();
    solver.snapshot().state
}

#[test]
fn case_3_slide_and_oblique() {
    for name in [
        "lammps/case3_wall_slide.csv",
        "lammps/case3_wall_oblique.csv",
    ] {
        let table = Table::read(name);
        let mut solver = on_floor(&table);
        for row in &table.rows[1..] {
            let now = state_at(&mut solver, row[0]);
            let round_off = RoundOff::of_collision(RADIUS, RADIUS, now.time);
            round_off.allows(&now.grains, 0, &table, row, "");
        }
    }
}

/// A grain that bounces. In flight, each step rounds the velocity (by up to 0.25 m/s) once in
/// each program; a bounce turns a distance Δx at its beginning into ω Δx of velocity. So the
/// trajectories part by a factor of some hundred with each bounce; they are followed until
/// round-off could be a micrometre a second.
#[test]
fn case_3_drop() {
    let table = Table::read("lammps/case3_wall_drop.csv");
    let mut solver = on_floor(&table);
    let omega = (LAW.normal_stiffness / tests::mass(RADIUS)).sqrt();
    let mut round_off = RoundOff {
        position: f64::EPSILON * RADIUS,
        velocity: 0.0,
    };
    let (mut bounces, mut before) = (0, &table.rows[0]);
    for row in &table.rows[1..] {
        let now = state_at(&mut solver, row[0]);
        let steps = row[0] - before[0];
        round_off.velocity += steps * f64::EPSILON * 0.25;
        round_off.position += steps * (STEP * round_off.velocity + f64::EPSILON * RADIUS);
        if table.get(row, "vz") > table.get(before, "vz") {
            bounces += 1;
            round_off.velocity +=
                omega * round_off.position + QUANTA * quantum(tests::mass(RADIUS), RADIUS);
        }
        if round_off.velocity > 1e-6 {
            break;
        }
        round_off.allows(&now.grains, 0, &table, row, "");
        before = row;
    }
    assert!(bounces >= 2, "followed over {bounces} bounces");
}
