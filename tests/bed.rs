//! Beds of many grains between a floor and a wall under stress, made inside the test:
//! a loose start, compressed, then sheared between two layers.

use dem::contact::{Linear, Tension};
use dem::stability::{damping_for, default_step};
use dem::{
    Constraint, ContactLaw, Domain, Drive, Horizontal, Model, Solver, State, StressLoad, Surface,
    Wall, WallMotion, WallState,
};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::{Mutex, PoisonError};

use crate::{floor, friction, smooth};

/// What is sheared. Lengths in mean diameters d, stresses in the normal stress σ, density of
/// the grains 1: time is in d √(ρ/σ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bed {
    /// Number of grains.
    pub grains: usize,
    /// Smallest and largest diameter; uniform between them.
    pub diameters: [f64; 2],
    /// Side of the square, periodic box.
    pub side: f64,
    /// Friction between grains [-].
    pub friction: f64,
    /// k_n/(σ d) [-].
    pub stiffness: f64,
    /// Restitution of two grains of mean size [-].
    pub restitution: f64,
    /// Seed of sizes and places.
    pub seed: u64,
}

/// Stress on the upper wall.
const STRESS: f64 = 1.0;

impl Bed {
    /// Spheres as in the independent runs that the plane shear is compared with.
    pub fn new(grains: usize, side: f64, friction: f64, seed: u64) -> Self {
        Self {
            grains,
            diameters: [0.9, 1.1],
            side,
            friction,
            stiffness: 1000.0,
            restitution: 0.5,
            seed,
        }
    }

    /// The law: k_t = 2/7 k_n, no tangential dashpot.
    pub fn law(&self) -> Linear {
        let effective_mass = std::f64::consts::PI / 12.0;
        let damping = damping_for(self.restitution, self.stiffness, effective_mass, true);
        Linear {
            sliding: friction(self.stiffness, self.friction),
            ..smooth(self.stiffness, damping, Tension::Clip)
        }
    }

    /// Grains apart from each other, on a shaken lattice below the wall.
    pub fn loose(&self) -> State {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut state = State::default();
        let [small, large] = self.diameters;
        let across = (self.side / (1.1 * large)).floor() as usize;
        let spacing = self.side / across as f64;
        let play = 0.5 * (spacing - large);
        for k in 0..self.grains {
            let site = [k % across, k / across % across, k / (across * across)];
            let place = DVec3::from(site.map(|s| (s as f64 + 0.5) * spacing));
            let shift = DVec3::from([0, 1, 2].map(|_| random.random_range(-play..play)));
            let diameter = random.random_range(small..=large);
            let id = state.grains.add_sphere(place + shift, 0.5 * diameter, 1.0) as usize;
            let speed = [0, 1, 2].map(|_| random.random_range(-0.2..0.2));
            state.grains.velocity[id] = DVec3::from(speed);
        }
        let layers = self.grains.div_ceil(across * across);
        let top = layers as f64 * spacing;
        state.walls = vec![
            WallState::default(),
            WallState {
                offset: -top,
                velocity: 0.0,
            },
        ];
        state
    }

    /// The description: a held floor, and a wall under a unit of stress with about the mass of two
    /// layers, damped so that it sinks freely at no more than a quarter of √(σ/ρ).
    pub fn model(&self, state: &State) -> Model {
        let area = self.side * self.side;
        let load = StressLoad {
            mean: STRESS,
            amplitude: 0.0,
            frequency: 0.0,
            area,
            mass: area,
            damping: 4.0 * area,
        };
        let top = Wall {
            name: "top".into(),
            normal: -DVec3::Z,
            surface: Surface::Frictionless,
            motion: WallMotion::Stress(load),
        };
        let mut model = Model {
            domain: Domain {
                size: [self.side; 2],
                periodic: [true, true],
            },
            gravity: DVec3::ZERO,
            law: ContactLaw::Linear(self.law()),
            walls: vec![floor(Surface::Frictionless), top],
            drive: None,
            step: f64::NAN,
            skin: None,
            ledger: true,
        };
        model.step = default_step(&model, &state.grains);
        model
    }

    /// Compress the loose grains until they carry the wall, and stop them; time begins then.
    ///
    /// # Panics
    /// If the wall does not come to rest on the grains in time.
    pub fn compressed(&self) -> (Model, State) {
        /// Beds made before, for the tests of one program that start from the same.
        static MADE: Mutex<Vec<(Bed, (Model, State))>> = Mutex::new(vec![]);
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, bed)) = made.iter().find(|(bed, _)| bed == self) {
            return bed.clone();
        }
        let bed = self.compress();
        made.push((*self, bed.clone()));
        bed
    }

    fn compress(&self) -> (Model, State) {
        let loose = self.loose();
        let model = self.model(&loose);
        let mut solver =
            Solver::new(model.clone(), loose, 1).expect("a loose bed is a valid start");
        let mut at_rest = 0;
        for _ in 0..200 {
            solver
                .advance((1.0 / model.step) as u64)
                .expect("a stable step");
            let now = solver.snapshot();
            let carried = now.wall_force[1] / (STRESS * model.domain.area());
            // Grains that nothing holds may fly about for long: the wall tells.
            let rests = (carried - 1.0).abs() < 0.1 && now.state.walls[1].velocity.abs() < 1e-2;
            at_rest = if rests { at_rest + 1 } else { 0 };
            if at_rest == 5 {
                let mut state = now.state;
                state.time = 0.0;
                state.grains.velocity.fill(DVec3::ZERO);
                state.grains.angular_velocity.fill(DVec3::ZERO);
                state.walls[1].velocity = 0.0;
                return (model, state);
            }
        }
        panic!("the bed of {} grains did not come to rest", self.grains);
    }

    /// Compressed grains with layers one diameter thick held below and driven above at
    /// inertial number `inertial` = γ̇ d √(ρ/σ), γ̇ between the layers; the velocity starts linear.
    pub fn sheared(&self, inertial: f64) -> (Model, State) {
        let (mut model, mut state) = self.compressed();
        let top = -state.walls[1].offset;
        let speed = inertial * (top - 2.0);
        model.drive = Some(Drive::Velocity(speed));
        let grains = &mut state.grains;
        for k in 0..grains.len() {
            let z = grains.position[k].z;
            let horizontal = if z < 1.0 {
                Horizontal::Held
            } else if z > top - 1.0 {
                Horizontal::Driven
            } else {
                Horizontal::Free
            };
            let rotation_held = horizontal != Horizontal::Free;
            grains.constraint[k] = Constraint {
                horizontal,
                rotation_held,
            };
            grains.velocity[k].x = speed * ((z - 1.0) / (top - 2.0)).clamp(0.0, 1.0);
        }
        (model, state)
    }
}
