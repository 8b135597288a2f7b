//! The grains: one array per quantity, all of one length, SI units.

use glam::{DQuat, DVec3};
use std::f64::consts::PI;

/// The spheres of a bed. Element `k` of every array belongs to one grain.
///
/// Outside the solver the order is that of `id`; inside it grains are sorted along
/// the cells, and `id` is what tells them apart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grains {
    /// Identity; survives every reordering.
    pub id: Vec<u32>,
    /// Radius [m].
    pub radius: Vec<f64>,
    /// Mass [kg].
    pub mass: Vec<f64>,
    /// Moment of inertia about the centre, 2/5 m R² for a solid sphere [kg m²].
    pub moment_of_inertia: Vec<f64>,
    /// Centre, inside the box along periodic sides [m].
    pub position: Vec<DVec3>,
    /// Way travelled since the bed was made, not wrapped at periodic sides [m].
    pub displacement: Vec<DVec3>,
    /// Velocity [m/s].
    pub velocity: Vec<DVec3>,
    /// Angular velocity [rad/s].
    pub angular_velocity: Vec<DVec3>,
    /// Orientation relative to the start, a unit quaternion.
    pub orientation: Vec<DQuat>,
    /// What is held or prescribed.
    pub constraint: Vec<Constraint>,
}

/// What of a grain's motion is not left to the forces. Motion along z is always free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Constraint {
    /// Motion along x and y.
    pub horizontal: Horizontal,
    /// Is the angular velocity held at zero?
    pub rotation_held: bool,
}

/// The horizontal motion of a grain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Horizontal {
    /// Follows the forces.
    #[default]
    Free,
    /// Stays where it is.
    Held,
    /// Moves along x as the [`Drive`](crate::Drive) says, and not along y.
    Driven,
}

impl Constraint {
    /// Factors of force and torque: 1 along what follows them, 0 along what does not.
    pub(crate) fn freedom(self) -> [DVec3; 2] {
        let free = match self.horizontal {
            Horizontal::Free => DVec3::ONE,
            Horizontal::Held | Horizontal::Driven => DVec3::Z,
        };
        let turns = if self.rotation_held { 0.0 } else { 1.0 };
        [free, DVec3::splat(turns)]
    }
}

impl Grains {
    /// Number of grains.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Is there no grain?
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Add a solid sphere at rest and return its identity.
    ///
    /// `position` and `radius` in m, `density` in kg/m³.
    pub fn add_sphere(&mut self, position: DVec3, radius: f64, density: f64) -> u32 {
        let id = self.len() as u32;
        let mass = density * 4.0 / 3.0 * PI * radius.powi(3);
        self.id.push(id);
        self.radius.push(radius);
        self.mass.push(mass);
        self.moment_of_inertia.push(0.4 * mass * radius * radius);
        self.position.push(position);
        self.displacement.push(DVec3::ZERO);
        self.velocity.push(DVec3::ZERO);
        self.angular_velocity.push(DVec3::ZERO);
        self.orientation.push(DQuat::IDENTITY);
        self.constraint.push(Constraint::default());
        id
    }

    /// Volume of grain `k` [m³].
    pub fn volume(&self, k: usize) -> f64 {
        4.0 / 3.0 * PI * self.radius[k].powi(3)
    }

    /// Mean grain radius [m]; zero without grains.
    pub fn mean_radius(&self) -> f64 {
        self.radius.iter().sum::<f64>() / self.len().max(1) as f64
    }

    /// Kinetic energy of translation [J].
    pub fn kinetic_energy(&self) -> f64 {
        let each = self.mass.iter().zip(&self.velocity);
        each.map(|(m, v)| 0.5 * m * v.length_squared()).sum()
    }

    /// Kinetic energy of rotation [J].
    pub fn rotational_energy(&self) -> f64 {
        let each = self.moment_of_inertia.iter().zip(&self.angular_velocity);
        each.map(|(i, w)| 0.5 * i * w.length_squared()).sum()
    }
}
