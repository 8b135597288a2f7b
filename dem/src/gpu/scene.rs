//! What the step kernels read of a scene, and the rows of the grains. Twins:
//! shaders/dem/scene.wgsl and boundary.wgsl.

use super::law::Law;
use super::wide::Wide;
use bytemuck::{Pod, Zeroable};

/// Walls at most: a pair along each axis.
pub(super) const MOST_WALLS: usize = 6;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Scene {
    pub law: Law,
    pub gravity: [f32; 3],
    pub step: f32,
    pub length: [i32; 3],
    pub unit: f32,
    pub count: u32,
    pub way: f32,
    pub force_scale: f32,
    pub energy_scale: f32,
    pub drive_velocity: f32,
    pub drive_force: f32,
    pub drive_kick: f32,
    pub part: f32,
    pub parts: f32,
    pub work_scale: f32,
    pub unused_a: u32,
    pub unused_b: u32,
    pub walls: [WallScene; MOST_WALLS],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct WallScene {
    pub axis: u32,
    pub side: i32,
    pub kick: f32,
    pub damping: f32,
    pub push: f32,
    pub amplitude: f32,
    pub turn: [u32; 2],
    pub start: [u32; 2],
    pub full: u32,
    pub unused: u32,
}

/// The row of a grain that its neighbours read, beside its place.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Motion {
    /// [m/s], half a step behind but for the start's.
    pub velocity: [f32; 3],
    /// [m]
    pub radius: f32,
    /// [rad/s], half a step behind.
    pub spin: [f32; 3],
    /// Identity.
    pub id: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct Own {
    pub kick: f32,
    pub twist: f32,
    pub flags: u32,
    pub image: u32,
}

pub(super) const HELD: u32 = 1;
pub(super) const DRIVEN: u32 = 2;
pub(super) const STILL: u32 = 4;
/// The first of the bits of walls.
pub(super) const TOUCHES: u32 = 8;

/// Of the word of a neighbour: its row.
pub const INDEX: u32 = 0x3fff_ffff;
/// Of the word of a neighbour: the contact slides.
pub const SLIDING: u32 = 0x4000_0000;
/// Of the word of a neighbour: there is a contact.
pub const TOUCHING: u32 = 0x8000_0000;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct Body {
    pub offset: Wide,
    pub velocity: f32,
    pub unused: u32,
}

/// Places that losses of `grains` are spread over: each is shared by two thousand of them at most,
/// which may lose 0.03 k_n R² each until sums are taken off the device.
pub(super) fn spread(grains: usize) -> usize {
    (grains / 2048).next_power_of_two().clamp(32, 1 << 14)
}

/// What of a companion's force moves a wall. Twin: shaders/dem/boundary.wgsl
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct Relief {
    /// Share of the force.
    pub share: f32,
    /// What is taken off [N].
    pub off: f32,
    /// Step of the exchange.
    pub since: u32,
    pub unused: u32,
}

/// Where the running sums lie: as in boundary.wgsl.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slots {
    pub walls: usize,
    /// Places of the losses.
    pub spread: usize,
    /// Does something go along with the grains?
    pub companion: bool,
}

impl Slots {
    /// Forces of one step.
    pub fn forces(self) -> usize {
        self.walls + 2
    }

    /// First force of the slot of `step`.
    pub fn of_step(self, step: u64) -> usize {
        (step % 3) as usize * self.forces()
    }

    /// First force of a reading.
    pub fn reading(self) -> usize {
        3 * self.forces()
    }

    /// First force summed over steps.
    pub fn totals(self) -> usize {
        4 * self.forces()
    }

    /// Work of the first wall.
    pub fn works(self) -> usize {
        self.totals() + self.forces()
    }

    /// First loss; there are `spread` places for the four of them.
    pub fn losses(self) -> usize {
        self.works() + self.walls
    }

    /// First loss of a reading.
    pub fn losses_read(self) -> usize {
        self.losses() + 4 * self.spread
    }

    /// Force of a companion on the first wall, as it is added up.
    fn companion(self) -> usize {
        self.losses_read() + 4
    }

    /// The same of its last exchange, which is held; those of the one before follow.
    pub fn held_companion(self) -> usize {
        self.companion() + self.walls
    }

    /// All of them.
    pub fn len(self) -> usize {
        self.companion() + if self.companion { 3 * self.walls } else { 0 }
    }
}
