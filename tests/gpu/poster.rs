//! A bed at the poster's stiffness: 1000 grains of 1 cm under 100 kPa, k_n = 1e9 N/m, whose
//! contacts overlap by some 3e-8 m.

use crate::compare::{apart, assert_within};
use crate::lab::Suite;
use crate::rounding::{allowed, nudged};
use dem::contact::{Linear, Sliding, Tension};
use dem::{
    Constraint, ContactLaw, Domain, Drive, Horizontal, Model, Snapshot, State, StressLoad, Surface,
    Wall, WallMotion, WallState, gpu,
};
use glam::DVec3;
use shaders::Device;
use tests::{DENSITY, floor, solver};

pub fn list(suite: &mut Suite) {
    suite.gpu("contact_forces_of_the_poster_s_packing", packing_forces);
    suite.gpu("the_poster_s_shear_beside_the_cpu", shear);
}

const SIDE: f64 = 0.2;
const HEIGHT: f64 = 0.174_287_454_884_305;
/// Strain rate of the poster times the height [m/s].
const SPEED: f64 = 0.25 * HEIGHT;

/// The packing of `esker bench speed`, in equilibrium without friction, under the poster's law, load
/// and step, its uppermost layer driven.
fn poster() -> (Model, State) {
    let mut state = State::default();
    let table = include_str!("../../experiments/src/bench/packing.csv");
    for line in table.lines().skip(1) {
        let number = |word: &str| word.parse::<f64>().expect("a number");
        let row: Vec<f64> = line.split(',').map(number).collect();
        let place = DVec3::new(row[0], row[1], row[2]);
        let k = state.grains.add_sphere(place, row[3], DENSITY) as usize;
        let (horizontal, speed) = if place.z < 0.013 {
            (Horizontal::Held, 0.0)
        } else if place.z > HEIGHT - 0.013 {
            (Horizontal::Driven, SPEED)
        } else {
            (Horizontal::Free, SPEED * place.z / HEIGHT)
        };
        state.grains.velocity[k].x = speed;
        state.grains.constraint[k] = Constraint {
            horizontal,
            rotation_held: horizontal != Horizontal::Free,
        };
    }
    let top = WallState {
        offset: -HEIGHT,
        velocity: 0.0,
    };
    state.walls = vec![WallState::default(), top];
    let load = StressLoad {
        mean: 1e5,
        amplitude: 0.0,
        frequency: 0.0,
        area: SIDE * SIDE,
        mass: state.grains.mass.iter().sum(),
        damping: 0.0,
    };
    let lid = Wall {
        name: "top".into(),
        normal: -DVec3::Z,
        surface: Surface::Frictionless,
        motion: WallMotion::Stress(load),
    };
    let model = Model {
        domain: Domain {
            size: [SIDE; 2],
            periodic: [true; 2],
        },
        gravity: -9.81 * DVec3::Z,
        law: ContactLaw::Linear(Linear {
            normal_stiffness: 1e9,
            normal_damping: 780.0,
            tension: Tension::Clip,
            sliding: Some(Sliding {
                stiffness: 1e8,
                damping: 780.0,
                friction_static: 0.58,
                friction_dynamic: 0.47,
            }),
            rolling: None,
            twisting: None,
        }),
        walls: vec![floor(Surface::Frictionless), lid],
        drive: Some(Drive::Velocity(SPEED)),
        step: 6.6e-7,
        skin: None,
        ledger: true,
    };
    (model, state)
}

/// At rest, with the springs that some sheared steps on the CPU leave: rms of the difference of
/// contact forces over their rms, f32 against f64. Found: 8.5e-8.
fn packing_forces(device: &Device) {
    let (model, state) = poster();
    let mut sheared = solver(&model, &state);
    sheared.advance(1000).unwrap();
    let mut state = sheared.snapshot().state;
    state.grains.velocity.fill(DVec3::ZERO);
    state.grains.angular_velocity.fill(DVec3::ZERO);
    state.walls[1].velocity = 0.0;
    let mut model = model;
    model.drive = None;
    let on_gpu = gpu::Solver::new(device, model, state.clone()).unwrap();
    let cpu = solver(on_gpu.model(), &state).snapshot().state.contacts;
    let gpu = on_gpu.snapshot().unwrap().state.contacts;
    assert_eq!(cpu.len(), gpu.len());
    let (mut off, mut all, mut overlap) = (0.0, 0.0, 0.0);
    let mut each: Vec<f64> = vec![];
    for (c, g) in cpu.iter().zip(&gpu) {
        assert_eq!((c.i, c.j), (g.i, g.j));
        let by = c.force.distance(g.force);
        off += by * by;
        all += c.force.length_squared();
        overlap += c.overlap;
        each.push(by / c.force.length());
    }
    each.sort_by(f64::total_cmp);
    let rms = (off / all).sqrt();
    println!(
        "{} contacts, mean overlap {:.2e} m: rms error of forces {rms:.2e}, median {:.2e}, largest {:.2e}",
        cpu.len(),
        overlap / cpu.len() as f64,
        each[each.len() / 2],
        each[each.len() - 1]
    );
    assert!(cpu.len() > 1500, "{} contacts", cpu.len());
    assert!(rms < 1e-6, "rms error of contact forces {rms:e}");
}

const STEPS: u64 = 3000;

/// Shear stress, wall, energies and what the ledger misses, side by side.
fn shear(device: &Device) {
    let (model, state) = poster();
    let mut on_gpu = gpu::Solver::new(device, model, state.clone()).unwrap();
    let model = on_gpu.model().clone();
    let mut cpu = solver(&model, &state);
    let start = cpu.snapshot();
    let mut off = solver(&model, &nudged(&state, &start, &model));
    println!("{}", row("step", HEADS.map(String::from)));
    for part in 0..=6 {
        if part > 0 {
            let steps = STEPS / 6;
            on_gpu.advance(steps).unwrap();
            cpu.advance(steps).unwrap();
            off.advance(steps).unwrap();
        }
        let (a, b) = (cpu.snapshot(), on_gpu.snapshot().unwrap());
        let step = a.sums.steps;
        println!("{}", row(&format!("{step} CPU"), entries(&a)));
        println!("{}", row(&format!("{step} GPU"), entries(&b)));
        let allowed = allowed(&a, &off.snapshot(), &start, &model);
        assert_within(&format!("step {step}"), &apart(&a, &b, &model), &allowed);
        if step > 0 {
            let share = |s: &Snapshot| s.ledger.residual / s.ledger.work_drive;
            assert!(
                share(&b).abs() < share(&a).abs() + 1e-5,
                "the ledger misses {:e} of the work of the drive, on the CPU {:e}",
                share(&b),
                share(&a)
            );
        }
    }
    let ends = [cpu.snapshot(), off.snapshot(), on_gpu.snapshot().unwrap()];
    let means = ends.map(|s| -s.sums.driven_force / (SIDE * SIDE * 1e3 * STEPS as f64));
    println!(
        "mean shear over {STEPS} steps: CPU {:.4} kPa, nudged {:.4}, GPU {:.4}",
        means[0], means[1], means[2]
    );
}

const HEADS: [&str; 9] = [
    "shear kPa",
    "load kPa",
    "wall mm",
    "motion J",
    "springs J",
    "friction J",
    "viscosity J",
    "drive J",
    "residual J",
];

fn row(name: &str, entries: [String; 9]) -> String {
    let entries = entries.map(|entry| format!("{entry:>15}"));
    format!("{name:>9} {}", entries.join(""))
}

fn entries(s: &Snapshot) -> [String; 9] {
    let area = SIDE * SIDE * 1e3;
    let l = &s.ledger;
    [
        format!("{:.8}", -s.driven_force / area),
        format!("{:.7}", s.wall_force[1] / area),
        format!("{:.9}", -1e3 * s.state.walls[1].offset),
        format!("{:.8e}", l.kinetic + l.rotational),
        format!("{:.8e}", l.elastic_normal + l.elastic_tangential),
        format!("{:.7e}", l.dissipated_friction),
        format!("{:.7e}", l.dissipated_viscosity),
        format!("{:.7e}", l.work_drive),
        format!("{:.3e}", l.residual),
    ]
}
