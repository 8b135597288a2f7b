//! Trajectories of LAMMPS, `reference/lammps/README.md`, as `verification/lammps` follows them on the
//! CPU, with tolerances that follow from f32.
//!
//! Few grains: each step rounds a velocity by [`PER_STEP`] of the largest, linear contacts neither
//! amplify nor forget that, and a distance is off by that times the time.
//! Beds: the CPU once more from a start that is off by one step's roundings tells how these grow
//! (`rounding.rs`); after n steps n times that is allowed. A bed is followed as long as that says
//! anything, [`TELLING`].

use crate::compare::{Amounts, apart};
use crate::lab::Suite;
use crate::rounding::{ROUNDING, allowed, nudged};
use dem::contact::LinearLammps;
use dem::{
    Constraint, ContactLaw, Domain, Drive, Grains, Horizontal, Model, Snapshot, State, StressLoad,
    Surface, Wall, WallMotion, WallState, gpu,
};
use glam::DVec3;
use shaders::Device;
use tests::packing::separation;
use tests::table::Table;
use tests::{DENSITY, GRAVITY, RADIUS, floor, solver};

pub fn list(suite: &mut Suite) {
    suite.gpu("lammps_case_1_head_on", head_on);
    suite.gpu("lammps_case_2_oblique", oblique);
    suite.gpu("lammps_case_3_at_a_wall", at_a_wall);
    suite.gpu("lammps_case_4_compression_of_125_grains", compression);
    suite.gpu("lammps_case_5_shear_of_1000_grains", shear);
}

const LAW: LinearLammps = LinearLammps {
    normal_stiffness: 1e9,
    normal_damping: 780.0,
    tangential_stiffness: 1e8,
    tangential_damping: 780.0,
    friction: 0.5,
};
const STEP: f64 = 6.6e-7;

fn model(law: LinearLammps, step: f64) -> Model {
    Model {
        domain: Domain {
            size: [0.1; 2],
            periodic: [false; 2],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::LinearLammps(law),
        walls: vec![],
        drive: None,
        step,
        skin: None,
        ledger: false,
    }
}

/// Roundings of a velocity in a step, of the largest velocity: its own, and a handful of the force,
/// which changes it by at most a quarter (13 steps a contact).
const PER_STEP: f64 = 1.0 + 0.25 * 8.0;

/// How far rounding may have taken a grain.
#[derive(Clone, Copy)]
struct RoundOff {
    position: f64,
    velocity: f64,
}

impl RoundOff {
    fn after(steps: f64, speed: f64) -> Self {
        let velocity = (steps + 1.0) * PER_STEP * ROUNDING * speed;
        Self {
            position: velocity * steps * STEP + 4.0 * f64::EPSILON * RADIUS,
            velocity,
        }
    }

    /// The share of what is allowed that is used.
    fn assert(self, found: &Grains, k: usize, table: &Table, row: &[f64], suffix: &str) -> f64 {
        // Tangential forces round no worse than normal ones: Δω = (R/I) m Δv.
        let spin = 2.5 * self.velocity / found.radius[k];
        let mut share: f64 = 0.0;
        for (before, found, allowed) in [
            ("", found.position[k], self.position),
            ("v", found.velocity[k], self.velocity),
            ("w", found.angular_velocity[k], spin),
        ] {
            let expected = table.vector(row, before, suffix);
            let off = (found - expected).length();
            assert!(
                off <= allowed,
                "step {}, {before}x{suffix}: {found} is off by {off:e} of {allowed:e}",
                row[0]
            );
            share = share.max(off / allowed);
        }
        share
    }
}

/// Grain `k` of `grains` moves as the columns that end with `suffix` say.
fn set(grains: &mut Grains, k: usize, table: &Table, row: &[f64], suffix: &str) {
    grains.position[k] = table.vector(row, "", suffix);
    grains.velocity[k] = table.vector(row, "v", suffix);
    grains.angular_velocity[k] = table.vector(row, "w", suffix);
}

fn begun(device: &Device, model: &Model, state: &State) -> gpu::Solver {
    gpu::Solver::new(device, model.clone(), state.clone()).unwrap()
}

/// Two grains without walls follow the table at each of its steps.
fn follow_pair(device: &Device, name: &str, radii: [f64; 2]) {
    let table = Table::read(name);
    let mut start = tests::state(&radii.map(|r| (DVec3::ZERO, r)), 0);
    set(&mut start.grains, 0, &table, &table.rows[0], "1");
    set(&mut start.grains, 1, &table, &table.rows[0], "2");
    let speed = largest_speed(&start);
    let mut solver = begun(device, &model(LAW, STEP), &start);
    let mut worst: f64 = 0.0;
    for row in &table.rows[1..] {
        solver.advance(1).unwrap();
        let now = solver.snapshot().unwrap();
        assert_eq!(now.sums.steps, row[0] as u64);
        for (k, suffix) in ["1", "2"].iter().enumerate() {
            let allowed = RoundOff::after(row[0], speed);
            worst = worst.max(allowed.assert(&now.state.grains, k, &table, row, suffix));
        }
    }
    println!("{name}: worst {worst:.3} of what is allowed");
}

fn largest_speed(state: &State) -> f64 {
    let speeds = state.grains.velocity.iter().map(|v| v.length());
    speeds.fold(0.0, f64::max)
}

fn head_on(device: &Device) {
    follow_pair(device, "lammps/case1_headon_equal.csv", [1e-2, 1e-2]);
    follow_pair(device, "lammps/case1_headon_unequal.csv", [8e-3, 1.2e-2]);
}

fn oblique(device: &Device) {
    for angle in [10, 30, 60] {
        let name = format!("lammps/case2_oblique_traj_{angle}.csv");
        follow_pair(device, &name, [1e-2, 1e-2]);
    }
    let table = Table::read("lammps/case2_oblique_final.csv");
    for row in &table.rows {
        let angle = table.get(row, "angle_deg").to_radians();
        let place = DVec3::X * (RADIUS + 5e-9);
        let mut start = tests::state(&[(-place, RADIUS), (place, RADIUS)], 0);
        start.grains.velocity[0] = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let mut solver = begun(device, &model(LAW, STEP), &start);
        solver.advance(400).unwrap();
        let grains = solver.snapshot().unwrap().state.grains;
        // Flight changes nothing: the steps of the contact, which last the longer the more
        // slowly the grains meet, and end with a step without force.
        let contact = 14.0 + 1e-8 / (angle.cos() * STEP);
        let allowed = RoundOff::after(contact, 1.0).velocity;
        for (k, suffix) in ["1", "2"].iter().enumerate() {
            let v = grains.velocity[k] - table.vector(row, "v", suffix);
            let w = grains.angular_velocity[k] - table.vector(row, "w", suffix);
            assert!(v.length() < allowed, "{} deg: off by {v}", row[0]);
            assert!(
                w.length() < 2.5 / RADIUS * allowed,
                "{} deg: off by {w}",
                row[0]
            );
        }
    }
}

/// One grain on a floor with friction, under gravity, at every step of the tables. In free fall
/// g dt is a few hundred last places of a velocity, always rounded alike: half of one in each
/// step at worst. A bounce turns a distance Δx at its beginning into ω Δx of velocity.
fn at_a_wall(device: &Device) {
    let omega = (LAW.normal_stiffness / tests::mass(RADIUS)).sqrt();
    for (name, speed) in [
        ("lammps/case3_wall_slide.csv", 0.1),
        ("lammps/case3_wall_oblique.csv", 0.6),
        ("lammps/case3_wall_drop.csv", 0.15),
    ] {
        let table = Table::read(name);
        let mut start = tests::state(&[(DVec3::ZERO, RADIUS)], 1);
        set(&mut start.grains, 0, &table, &table.rows[0], "");
        let mut model = model(LAW, STEP);
        model.walls = vec![floor(Surface::Full)];
        model.gravity = -GRAVITY * DVec3::Z;
        let mut solver = begun(device, &model, &start);
        let (mut worst, mut last, mut off): (f64, _, _) = (0.0, 0.0, 0.0);
        let mut allowed = RoundOff::after(0.0, speed);
        let mut before = &table.rows[0];
        for row in &table.rows[1..] {
            let steps = row[0] - before[0];
            allowed.velocity += steps * PER_STEP * ROUNDING * speed;
            allowed.position += steps * STEP * allowed.velocity;
            let bounced = table.get(row, "vz") > table.get(before, "vz") + 0.01 * speed;
            if bounced && name.contains("drop") {
                allowed.velocity += omega * allowed.position;
            }
            // Beyond, nothing is said.
            if allowed.velocity > 0.1 * speed {
                break;
            }
            solver.advance(steps as u64).unwrap();
            let grains = solver.snapshot().unwrap().state.grains;
            worst = worst.max(allowed.assert(&grains, 0, &table, row, ""));
            off = (grains.position[0] - table.vector(row, "", "")).length();
            (last, before) = (row[0], row);
        }
        println!("{name}: {off:.1e} m off at step {last}, worst {worst:.3} of what is allowed");
        assert!(last > 0.0);
    }
}

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
        let radius = table.get(row, "radius");
        state.grains.add_sphere(place, radius, DENSITY);
    }
    let top = WallState {
        offset: -height,
        velocity: lid_velocity,
    };
    state.walls = vec![WallState::default(), top];
    state
}

/// Distance of a grain up to which a bed is followed, in radii.
const TELLING: f64 = 1e-2;

/// The GPU, and three runs of the CPU: in the GPU's box, in it from a nudged start, and in the
/// box of LAMMPS, whose sides are no whole units: up to 2e-9 m longer or shorter.
struct Beds {
    gpu: gpu::Solver,
    cpu: dem::Solver,
    off: dem::Solver,
    exact: dem::Solver,
    start: Snapshot,
    model: Model,
}

impl Beds {
    fn new(device: &Device, model: &Model, state: &State) -> Self {
        let gpu = begun(device, model, state);
        let exact = solver(model, state);
        let model = gpu.model().clone();
        let cpu = solver(&model, state);
        let start = cpu.snapshot();
        let off = solver(&model, &nudged(state, &start, &model));
        Self {
            gpu,
            cpu,
            off,
            exact,
            start,
            model,
        }
    }

    /// The GPU at `step`, and how far it may be off, if that tells anything.
    fn at(&mut self, step: u64) -> Option<(Snapshot, Amounts)> {
        let steps = step - self.cpu.snapshot().sums.steps;
        self.cpu.advance(steps).unwrap();
        self.off.advance(steps).unwrap();
        self.exact.advance(steps).unwrap();
        let [cpu, off, exact] = [&self.cpu, &self.off, &self.exact].map(|s| s.snapshot());
        let mut allowed = allowed(&cpu, &off, &self.start, &self.model);
        for (name, by) in apart(&cpu, &exact, &self.model) {
            *allowed.entry(name).or_default() += by;
        }
        if allowed["place"] > TELLING * RADIUS {
            return None;
        }
        self.gpu.advance(steps).unwrap();
        Some((self.gpu.snapshot().unwrap(), allowed))
    }
}

/// `found` is within `allowed` of `expected`.
fn assert_close(what: &str, step: u64, found: f64, expected: f64, allowed: f64) {
    let off = (found - expected).abs();
    assert!(
        off <= allowed,
        "step {step}: {what} {found:.9e}, LAMMPS {expected:.9e}, off by {off:.1e} of {allowed:.1e}"
    );
}

fn assert_frame(now: &Snapshot, domain: &Domain, frames: &Table, step: u64, allowed: &Amounts) {
    let rows = frames.rows.iter().filter(|row| row[0] as u64 == step);
    let grains = &now.state.grains;
    let (mut count, mut worst) = (0, [0.0_f64; 3]);
    for row in rows {
        let k = frames.get(row, "id") as usize - 1;
        let place = separation(grains.position[k], frames.vector(row, "", ""), domain);
        let velocity = grains.velocity[k] - frames.vector(row, "v", "");
        let spin = grains.angular_velocity[k] - frames.vector(row, "w", "");
        for (worst, off) in worst.iter_mut().zip([place, velocity, spin]) {
            *worst = worst.max(off.length());
        }
        count += 1;
    }
    assert_eq!(count, grains.len(), "frame {step}");
    let allowed = ["place", "velocity", "spin"].map(|name| allowed[name]);
    let short = |x: [f64; 3]| x.map(|x| format!("{x:.1e}")).join(", ");
    println!("step {step}: off by {} of {}", short(worst), short(allowed));
    for k in 0..3 {
        assert!(worst[k] <= allowed[k], "step {step}: a grain is off");
    }
}

/// Places, velocities and spins at the frames, forces on the walls in between.
fn compression(device: &Device) {
    let initial = Table::read("lammps/case4_initial.csv");
    let frames = Table::read("lammps/case4_frames.csv");
    let forces = Table::read("lammps/case4_compress.csv");
    let start = bed(&initial, 0.11, 1.0);
    let mut model = model(LAW, STEP);
    model.domain = Domain {
        size: [0.11; 2],
        periodic: [true; 2],
    };
    model.walls = vec![floor(Surface::Frictionless), lid(WallMotion::Velocity(1.0))];
    let mut beds = Beds::new(device, &model, &start);
    let (mut loaded, mut last) = (0, 0);
    for row in &forces.rows {
        let step = row[0] as u64;
        let Some((now, allowed)) = beds.at(step) else {
            break;
        };
        if frames.rows.iter().any(|row| row[0] as u64 == step) {
            assert_frame(&now, &model.domain, &frames, step, &allowed);
        }
        let height = forces.get(row, "wall_z");
        let found = -now.state.walls[1].offset;
        assert_close("wall height", step, found, height, allowed["wall place"]);
        for (wall, name) in ["F_bot", "F_top"].iter().enumerate() {
            let expected = forces.get(row, name);
            // A prescribed velocity, which the GPU rounds, is none that is nudged.
            let off = LAW.normal_stiffness * allowed["wall place"];
            let off = off + allowed["force on a wall or layer"];
            assert_close(name, step, now.wall_force[wall], expected, off);
            loaded += usize::from(expected != 0.0);
        }
        last = step;
    }
    println!("followed to step {last}, {loaded} forces that are not zero");
    assert!(last >= 5000 && loaded > 0, "followed to step {last}");
}

/// Grains, wall and stresses.
fn shear(device: &Device) {
    let initial = Table::read("lammps/case5_initial.csv");
    let frames = Table::read("lammps/case5_frames.csv");
    let series = Table::read("lammps/case5_shear_early.csv");
    let mut start = bed(&initial, 0.173_348_613_911_988, 0.0);
    for (k, row) in initial.rows.iter().enumerate() {
        let horizontal = match initial.get(row, "fixed") as i32 {
            -1 => Horizontal::Held,
            1 => Horizontal::Driven,
            _ => Horizontal::Free,
        };
        start.grains.velocity[k] = initial.vector(row, "v", "");
        start.grains.constraint[k] = Constraint {
            horizontal,
            rotation_held: horizontal != Horizontal::Free,
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
        size: [0.2; 2],
        periodic: [true; 2],
    };
    model.drive = Some(Drive::Velocity(0.17));
    let load = StressLoad {
        mean: 1e5,
        amplitude: 0.0,
        frequency: 0.0,
        area: 0.04,
        mass: 15.52,
        damping: 0.0,
    };
    model.walls = vec![floor(Surface::Frictionless), lid(WallMotion::Stress(load))];
    let area = model.domain.area();
    let mut beds = Beds::new(device, &model, &start);
    let mut last = 0;
    for row in &series.rows {
        let step = row[0] as u64;
        let Some((now, allowed)) = beds.at(step) else {
            break;
        };
        let off = allowed["force on a wall or layer"] / area;
        for (name, found) in [
            ("tau_top_Pa", -now.driven_force / area),
            ("tau_bottom_Pa", now.held_force / area),
            ("wall_stress_Pa", now.wall_force[1] / area),
        ] {
            assert_close(name, step, found, series.get(row, name), off);
        }
        let height = -now.state.walls[1].offset;
        // Half a unit of the table's last digit.
        let off = 0.5e-12 + allowed["wall place"];
        assert_close("wall height", step, height, series.get(row, "wall_z"), off);
        if [100, 500, 1000].contains(&step) {
            assert_frame(&now, &model.domain, &frames, step, &allowed);
        }
        last = step;
    }
    println!("followed to step {last}");
    assert!(last >= 500, "followed to step {last}");
}
