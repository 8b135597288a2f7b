//! What holds identically, in a bed of grains thrown about, seen from inside.

use crate::{Model, Permeability, Resistance, Water};
use dem::contact::{Linear, Tension};
use dem::{Companion, ContactLaw, Domain, Moved, Row, Solver, State, Surface, Threads};
use dem::{Wall, WallMotion, WallState};
use glam::DVec3;
use lbm::Fluid;
use std::ops::Range;
use std::sync::Mutex;

/// Numbers from -1 to 1 without structure.
pub(crate) fn random() -> impl FnMut() -> f64 {
    let mut x = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Grains that do not push each other in a box of 1 m, some beside the walls, and walls that move.
fn bed(
    velocity: impl Fn(&mut dyn FnMut() -> f64) -> DVec3,
    walls: [f64; 2],
) -> (dem::Model, State) {
    let mut state = State::default();
    let mut random = random();
    for _ in 0..700 {
        let place = DVec3::new(random(), random(), random()) * 0.5 + 0.5;
        let radius = 0.045 * (1.0 + 0.3 * random());
        let place = place.with_z(place.z.clamp(radius, 1.0 - radius));
        let id = state.grains.add_sphere(place, radius, 2600.0);
        state.grains.velocity[id as usize] = velocity(&mut random);
    }
    let wall = |name: &str, normal, velocity| Wall {
        name: name.into(),
        normal,
        surface: Surface::Frictionless,
        motion: WallMotion::Velocity(velocity),
    };
    state.walls = vec![
        WallState::default(),
        WallState {
            offset: -1.0,
            velocity: 0.0,
        },
    ];
    let model = dem::Model {
        domain: Domain {
            size: [1.0, 1.0],
            periodic: [true, true],
        },
        gravity: DVec3::ZERO,
        law: ContactLaw::Linear(Linear {
            normal_stiffness: 1e-9,
            normal_damping: 0.0,
            tension: Tension::Clip,
            sliding: None,
            rolling: None,
            twisting: None,
        }),
        walls: vec![
            wall("bottom", DVec3::Z, walls[0]),
            wall("top", -DVec3::Z, -walls[1]),
        ],
        drive: None,
        step: 1e-7,
        skin: None,
        ledger: false,
    };
    (model, state)
}

/// Water whose pressure is what it is told, and the powers of its forces in the last step.
struct Probe<const N: usize> {
    water: Water<N>,
    /// Of the forces on grains and walls, of the pressure on the volume that faces bring, and sizes.
    works: Mutex<[f64; 3]>,
    before: Mutex<Vec<f64>>,
}

impl<const N: usize> Companion for Probe<N> {
    fn arrange(&mut self, bed: &dem::Bed) -> Result<(), String> {
        self.water.arrange(bed)
    }
    fn exchanges(&self, step: u64) -> bool {
        self.water.exchanges(step)
    }
    fn follow(&self, moved: &Moved, threads: &Threads) {
        *self.before.lock().unwrap() = self.water.collected().to_vec();
        self.water.follow(moved, threads);
        let mut random = random();
        // SAFETY: there is one thread.
        let pressure = unsafe { self.water.pressure_to_tell() };
        pressure.fill_with(|| 1e5 * random());
    }
    fn wants_to_be_alone(&self, _: u64) -> bool {
        false
    }
    fn alone(&mut self, _: &Moved) {}
    fn due(&self, _: u64) -> bool {
        false
    }
    fn settle(&mut self, _: &dem::Bed) -> Result<(), String> {
        Ok(())
    }
    fn push(&self, moved: &Moved, threads: &Threads, own: Range<usize>, force: &mut [Row]) {
        let mut pushed = vec![Row::ZERO; force.len()];
        self.water.push(moved, threads, own.clone(), &mut pushed);
        let (mut gained, mut size) = (0.0, 0.0);
        for (push, way) in pushed.iter().zip(&moved.way[own]) {
            let work = push.xyz().dot(way.xyz());
            gained += work;
            size += work.abs();
        }
        for wall in 0..2 {
            // Force and way along the normal are of opposite sense.
            gained -= self.water.wall_force(wall) * moved.wall_ways[wall];
        }
        let before = self.before.lock().unwrap();
        let volumes = self.water.collected().iter().zip(before.iter());
        let pressures = self.water.pressure().iter();
        let lost = pressures
            .zip(volumes)
            .map(|(p, (now, before))| p * (now - before));
        *self.works.lock().unwrap() = [gained, lost.sum(), size];
    }
    fn wall_force(&self, _: usize) -> f64 {
        0.0
    }
}

fn water<const N: usize>(grains: &Solver) -> Water<N> {
    let fluid = Fluid::COLD_WATER;
    let law = Resistance::Darcy(Permeability::constant(1e-12));
    let mut model = Model::new([6, 6, 5], fluid, law);
    model.exchange = Some(1);
    Water::new(model, grains, None).unwrap()
}

fn works_agree<const N: usize>() {
    let (model, state) = bed(
        |random| DVec3::new(random(), random(), random()),
        [0.3, -0.2],
    );
    let mut solver = Solver::new(model, state, 1).unwrap();
    let mut probe = Probe {
        water: water::<N>(&solver),
        works: Mutex::default(),
        before: Mutex::default(),
    };
    // Not a step at which loose grains are dragged: drag only takes.
    for step in 1..crate::faces::DRAG_EVERY {
        solver.advance_together(1, &mut probe).unwrap();
        let [gained, taken, size] = *probe.works.lock().unwrap();
        assert!(
            size > 1e-7 && taken.abs() > 1e-3 * size,
            "{taken} of {size} J"
        );
        // The volumes are differences of sums.
        assert!(
            (gained - taken).abs() < 1e-9 * size,
            "step {step}: {gained} and {taken} J"
        );
    }
    solver.advance_together(1, &mut probe).unwrap();
    let [gained, taken, size] = *probe.works.lock().unwrap();
    assert!(
        gained < taken - 1e-3 * size,
        "drag of loose grains gives {} J",
        gained - taken
    );
}

#[test]
fn forces_do_the_work_of_the_pressure_on_the_volume() {
    works_agree::<3>();
    works_agree::<5>();
}

fn volumes_sum<const N: usize>() {
    let (model, state) = bed(|_| DVec3::ZERO, [0.0; 2]);
    let volume: f64 = (0..state.grains.len())
        .map(|k| state.grains.volume(k))
        .sum();
    let solver = Solver::new(model, state, 1).unwrap();
    let laid: f64 = water::<N>(&solver).solid.iter().sum();
    assert!((laid / volume - 1.0).abs() < 1e-14, "{laid} of {volume} m³");
}

#[test]
fn volumes_of_grains_sum_to_the_volume_in_the_cells() {
    volumes_sum::<3>();
    volumes_sum::<5>();
}

fn translation<const N: usize>() {
    let velocity = DVec3::new(0.3, -0.2, 0.1);
    let (mut model, state) = bed(|_| velocity, [velocity.z; 2]);
    // Ways are differences of places, which are rounded by 3e-17 m.
    model.step = 1e-4;
    let mut solver = Solver::new(model, state, 1).unwrap();
    let mut water = water::<N>(&solver);
    solver.advance_together(1, &mut water).unwrap();
    for (cell, mean) in water.velocities().iter().enumerate() {
        assert!(
            (mean.xyz() - velocity).length() < 1e-12,
            "cell {cell}: {mean:?}"
        );
    }
    let volume = 1e-4 * velocity.length() / 30.0;
    let most = water.collected().iter().fold(0.0f64, |m, v| m.max(v.abs()));
    assert!(most < 1e-11 * volume, "{most:e} of {volume:e} m³");
}

#[test]
fn means_of_one_velocity_are_that_velocity() {
    translation::<3>();
    translation::<5>();
}

fn portable_follow<const N: usize>() {
    let run = |portable: bool| {
        let (model, state) = bed(
            |random| DVec3::new(random(), random(), random()),
            [0.3, -0.2],
        );
        let mut solver = Solver::new(model, state, 1).unwrap();
        let mut water = water::<N>(&solver);
        if portable {
            water.kernels = crate::kernels::Kernels::portable();
        }
        let before = solver.snapshot().state.grains.velocity;
        solver.advance_together(100, &mut water).unwrap();
        (before, solver.snapshot().state.grains.velocity)
    };
    let ((before, fast), (_, portable)) = (run(false), run(true));
    let gained = |(a, b): (&DVec3, &DVec3)| (a - b).length();
    let most = before.iter().zip(&fast).map(gained).fold(0.0, f64::max);
    let apart = fast.iter().zip(&portable).map(gained).fold(0.0, f64::max);
    // Rounding of fused multiplications.
    assert!(
        most > 1e-3 && apart < 1e-12 * most.max(1.0),
        "{apart:e} of {most:e} m/s"
    );
}

#[test]
fn portable_loops_follow_those_of_the_processor() {
    portable_follow::<3>();
    portable_follow::<5>();
}

/// Where every grain counts the same, solid is where it has flowed: also where walls move, and
/// grains cross the sides of the box. Where half of them count less, it is not.
fn solid_goes_where_it_flows<const N: usize>() {
    let drift = |loads: f64| -> [f64; 2] {
        let throw = |random: &mut dyn FnMut() -> f64| DVec3::new(random(), random(), random());
        let (mut model, state) = bed(throw, [0.3, -0.2]);
        model.ledger = true;
        model.step = 3e-5;
        let mut solver = Solver::new(model, state, 1).unwrap();
        let mut water = water::<N>(&solver);
        let before = water.solid.clone();
        for _ in 0..10 {
            // Loads as if they had been measured: half of the grains carry this part of the others'.
            water.loads.mean.fill(1.0);
            water.loads.mean[..350].fill(loads);
            solver.advance_together(64, &mut water).unwrap();
        }
        let change = before.iter().zip(&water.solid);
        let squares: f64 = change.map(|(a, b)| (a - b) * (a - b)).sum();
        let moved = (squares / 180.0).sqrt() / water.lattice.volume();
        [water.drift.rms().unwrap(), moved]
    };
    let [same, moved] = drift(1.0);
    println!("{same:e} of {moved:e}");
    assert!(moved > 1e-4 && same < 5e-3 * moved, "{same:e} of {moved:e}");
    let [other, _] = drift(0.01);
    println!("{other:e}");
    assert!(other > 0.1 * moved, "{other:e} of {moved:e}");
}

#[test]
fn solid_of_grains_that_count_the_same_goes_where_it_flows() {
    solid_goes_where_it_flows::<3>();
    solid_goes_where_it_flows::<5>();
}
