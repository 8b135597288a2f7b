//! Cases 4 and 5: beds, held to the distances that an independent program was found at.

use super::{LAW, STEP, model};
use dem::contact::LinearLammps;
use dem::{
    Body, Constraint, Contact, Domain, Drive, Horizontal, Snapshot, State, StressLoad, Surface,
    Wall, WallMotion, WallState,
};
use glam::DVec3;
use tests::packing::separation;
use tests::table::Table;
use tests::{DENSITY, floor, solver};

fn lid(motion: WallMotion) -> Wall {
    Wall {
        name: "top".into(),
        normal: -DVec3::Z,
        surface: Surface::Frictionless,
        motion,
    }
}

/// The grains of a table with columns id, radius, x, y, z, between walls at 0 and `height`.
fn bed(table: &Table, height: f64, lid_velocity: f64) -> State {
    let mut state = State::default();
    for row in &table.rows {
        let place = table.vector(row, "", "");
        state
            .grains
            .add_sphere(place, table.get(row, "radius"), DENSITY);
    }
    let top = WallState {
        offset: -height,
        velocity: lid_velocity,
    };
    state.walls = vec![WallState::default(), top];
    state
}

/// How far an independent program was found from LAMMPS in the places of grains: step, distance
/// [m] and unit of its last stated digit. In between the distance grows exponentially.
struct Stated(&'static [(u64, f64, f64)]);

impl Stated {
    /// Distance [m] at `step`: half a unit of the last digit is open, and so are the last
    /// places of coordinates beyond 0.125 m, to which both programs round.
    fn at(&self, step: u64) -> f64 {
        let rounding = 3.0_f64.sqrt() * f64::EPSILON * 0.125;
        let up_to = |k: usize| self.0[k].1 + 0.5 * self.0[k].2;
        let next = self.0.iter().position(|s| s.0 >= step);
        let next = next.expect("a distance is stated at a later step");
        if next == 0 || self.0[next].0 == step {
            return up_to(next) + rounding;
        }
        let [before, after] = [next - 1, next];
        let way = (self.0[after].0 - self.0[before].0) as f64;
        let part = (step - self.0[before].0) as f64 / way;
        up_to(before) * (up_to(after) / up_to(before)).powf(part) + rounding
    }
}

/// Highest frequency of two grains on their contact [rad/s]: motion that is off by a distance is
/// off by this times the distance in velocity.
fn frequency(law: &LinearLammps, state: &State) -> f64 {
    let lightest = state
        .grains
        .mass
        .iter()
        .fold(f64::INFINITY, |a, &b| a.min(b));
    (2.0 * law.normal_stiffness / lightest).sqrt()
}

/// How much [N/m] the force of one contact is off for each metre that one of its bodies is off.
fn sensitivity(law: &LinearLammps, frequency: f64) -> f64 {
    let springs = law.normal_stiffness + law.tangential_stiffness;
    springs + (law.normal_damping + law.tangential_damping) * frequency
}

/// Every grain has the place, velocity and spin that `frames` tells for `step`, its place within
/// `allowed` [m], its velocity within `frequency` times that, its spin as the surface's velocity.
fn assert_frame(
    now: &Snapshot,
    domain: &Domain,
    frames: &Table,
    step: u64,
    allowed: f64,
    frequency: f64,
) {
    let rows: Vec<_> = frames
        .rows
        .iter()
        .filter(|row| row[0] as u64 == step)
        .collect();
    let grains = &now.state.grains;
    assert_eq!(rows.len(), grains.len(), "frame {step}");
    let mut worst = [0.0_f64; 3];
    for row in rows {
        let k = frames.get(row, "id") as usize - 1;
        let place = separation(grains.position[k], frames.vector(row, "", ""), domain);
        let velocity = grains.velocity[k] - frames.vector(row, "v", "");
        let spin = grains.angular_velocity[k] - frames.vector(row, "w", "");
        // A tangential impulse turns a sphere by 5/2 of its velocity over R.
        let surface = grains.radius[k] / 2.5 * spin;
        for (worst, off) in worst.iter_mut().zip([place, velocity, surface]) {
            *worst = worst.max(off.length());
        }
    }
    let allowed = [allowed, frequency * allowed, frequency * allowed];
    let short = |x: [f64; 3]| x.map(|x| format!("{x:.1e}")).join(", ");
    println!("step {step}: off by {} of {}", short(worst), short(allowed));
    for (k, what) in ["m", "m/s", "m/s by its spin"].iter().enumerate() {
        let (off, allowed) = (worst[k], allowed[k]);
        assert!(
            off <= allowed,
            "step {step}: a grain is off by {off:e} {what} of {allowed:e}"
        );
    }
}

/// `found` agrees with `expected` to `tolerance`.
fn assert_close(what: &str, step: u64, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "step {step}: {what} {found:.12e}, LAMMPS {expected:.12e}, off by {:.1e} of {tolerance:.1e}",
        (found - expected).abs()
    );
}

/// Places to the stated distances at each frame, forces on the walls every 500 steps,
/// and at the fiftieth steps at which there are any.
#[test]
fn case_4_compression_of_125_grains() {
    let initial = Table::read("lammps/case4_initial.csv");
    let frames = Table::read("lammps/case4_frames.csv");
    let forces = Table::read("lammps/case4_compress.csv");
    let stated = Stated(&[
        (2500, 1.5e-14, 1e-15),
        (5000, 5e-14, 1e-14),
        (7500, 2e-12, 1e-12),
        (10_000, 5e-12, 1e-12),
        (15_000, 1.2e-9, 1e-10),
    ]);
    let start = bed(&initial, 0.11, 1.0);
    let mut model = model(LAW, STEP);
    model.domain = Domain {
        size: [0.11, 0.11],
        periodic: [true, true],
    };
    model.walls = vec![floor(Surface::Frictionless), lid(WallMotion::Velocity(1.0))];
    let frequency = frequency(&LAW, &start);
    let mut solver = solver(&model, &start);
    let (mut loaded, mut compared) = (0, 0);
    for row in &forces.rows {
        let step = row[0] as u64;
        solver.advance(step - solver.snapshot().sums.steps).unwrap();
        let now = solver.snapshot();
        let allowed = stated.at(step);
        if frames.rows.iter().any(|row| row[0] as u64 == step) {
            assert_frame(&now, &model.domain, &frames, step, allowed, frequency);
            compared += 1;
        }
        // Two products and a difference, half a last place each in both programs.
        let rounding = 3.0 * f64::EPSILON * 0.0625;
        let height = forces.get(row, "wall_z");
        let found = -now.state.walls[1].offset;
        assert_close("wall height", step, found, height, rounding);
        for (wall, name) in ["F_bot", "F_top"].iter().enumerate() {
            let on_wall = |c: &&Contact| c.j == Body::Wall(wall as u32);
            let contacts = now.state.contacts.iter().filter(on_wall).count();
            let slack = contacts as f64 * sensitivity(&LAW, frequency) * allowed;
            let expected = forces.get(row, name);
            assert_close(name, step, now.wall_force[wall], expected, slack);
            loaded += usize::from(expected != 0.0);
        }
    }
    assert_eq!(compared, 5, "frames");
    println!("{loaded} forces that are not zero");
    assert!(loaded > 0, "the walls touched nothing");
}

/// 1000 grains sheared between layers under a wall with a stress: grains, wall and stresses.
#[test]
fn case_5_shear_of_1000_grains() {
    let initial = Table::read("lammps/case5_initial.csv");
    let frames = Table::read("lammps/case5_frames.csv");
    let series = Table::read("lammps/case5_shear_early.csv");
    let speed = 0.17;
    let mut start = bed(&initial, 0.173348613911988, 0.0);
    for (k, row) in initial.rows.iter().enumerate() {
        let horizontal = match initial.get(row, "fixed") as i32 {
            -1 => Horizontal::Held,
            1 => Horizontal::Driven,
            _ => Horizontal::Free,
        };
        start.grains.velocity[k] = initial.vector(row, "v", "");
        let rotation_held = horizontal != Horizontal::Free;
        start.grains.constraint[k] = Constraint {
            horizontal,
            rotation_held,
        };
    }
    let law = LinearLammps {
        normal_stiffness: 1e7,
        normal_damping: 78.0,
        tangential_stiffness: 1e6,
        tangential_damping: 78.0,
        friction: 0.5,
    };
    let mut model = model(law, 6.6e-6);
    model.domain = Domain {
        size: [0.2, 0.2],
        periodic: [true, true],
    };
    model.drive = Some(Drive::Velocity(speed));
    let load = StressLoad {
        mean: 1e5,
        amplitude: 0.0,
        frequency: 0.0,
        area: 0.04,
        mass: 15.52,
        damping: 0.0,
    };
    model.walls = vec![floor(Surface::Frictionless), lid(WallMotion::Stress(load))];
    let stated = Stated(&[
        (100, 4e-16, 1e-16),
        (500, 1.3e-14, 1e-15),
        (1000, 2.3e-12, 1e-13),
        (2000, 1.9e-8, 1e-9),
    ]);
    let frequency = frequency(&law, &start);
    let mut solver = solver(&model, &start);

    for row in &series.rows {
        let step = row[0] as u64;
        solver.advance(step - solver.snapshot().sums.steps).unwrap();
        let now = solver.snapshot();
        let allowed = stated.at(step);
        let area = model.domain.area();
        let [top, bottom] = [-now.driven_force / area, now.held_force / area];

        // Each contact that counts, both of its bodies off; the table has 12 digits.
        let slack = |contacts: usize, expected: f64| {
            let off = 2.0 * sensitivity(&law, frequency) * allowed / area;
            contacts as f64 * off + 1e-11 * expected.abs()
        };
        let contacts = &now.state.contacts;
        let across = |layer: Horizontal| {
            let inside = |k: u32| now.state.grains.constraint[k as usize].horizontal == layer;
            let of_layer = |c: &&Contact| match c.j {
                Body::Grain(j) => inside(c.i) != inside(j),
                Body::Wall(_) => false,
            };
            contacts.iter().filter(of_layer).count()
        };
        let expected = series.get(row, "tau_top_Pa");
        // The reference states ten equal digits of this stress at step 1000: so far apart were
        // two programs. The order of a program's sums, which the width of the neighbour search
        // decides here, moves its own last digits (1.3 units of the tenth at step 930); so the
        // stated distance of the grains bounds this stress as it does the others.
        let off = slack(across(Horizontal::Driven), expected);
        assert_close("top shear", step, top, expected, off);
        let expected = series.get(row, "tau_bottom_Pa");
        let off = slack(across(Horizontal::Held), expected);
        assert_close("bottom shear", step, bottom, expected, off);
        let on_top = |c: &&Contact| c.j == Body::Wall(1);
        let wall = contacts.iter().filter(on_top).count();
        let expected = series.get(row, "wall_stress_Pa");
        let stress = now.wall_force[1] / area;
        assert_close("stress", step, stress, expected, slack(wall, expected));
        // Half a unit of the table's last digit, and a body among the others.
        let height = -now.state.walls[1].offset;
        let expected = series.get(row, "wall_z");
        assert_close("wall height", step, height, expected, 0.5e-12 + allowed);

        if [100, 500, 1000].contains(&step) {
            assert_frame(&now, &model.domain, &frames, step, allowed, frequency);
        }
    }
}
