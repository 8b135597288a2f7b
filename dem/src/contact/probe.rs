//! The contact laws, one contact at a time, for tests that compare their twins on the GPU.

use super::{ContactLaw, Frictional, Lammps, Law, Memory, Normal, Springs, Touch, Turn};
use crate::lanes::{Lanes, Portable, Row, V3};
use crate::slots::Kept;
use glam::DVec3;

/// What a law sees of one contact, and remembers of it; SI units, normal from j to i.
#[derive(Clone, Copy, Debug, Default)]
pub struct Contact {
    /// Unit normal.
    pub normal: DVec3,
    /// Overlap [m].
    pub overlap: f64,
    /// Rate of separation [m/s].
    pub separation: f64,
    /// Tangential velocity of i's surface against j's [m/s].
    pub slip: DVec3,
    /// Spin of i against j [rad/s].
    pub spin: DVec3,
    /// R* [m].
    pub reduced_radius: f64,
    /// Tangential spring [m].
    pub spring: DVec3,
    /// Did it slide?
    pub sliding: bool,
    /// Force of the last step [N].
    pub force: DVec3,
    /// Rolling spring [m].
    pub rolling: DVec3,
    /// Twisting spring [m].
    pub twisting: f64,
    /// Rolling and twisting torque of the last step [N m].
    pub couple: DVec3,
}

/// What the law answers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answer {
    /// Normal force [N].
    pub normal_force: f64,
    /// Tangential force on i [N].
    pub tangential: DVec3,
    /// Torque on i beyond that of the tangential force [N m].
    pub couple: DVec3,
    /// Tangential spring after the step [m].
    pub spring: DVec3,
    /// Does it slide?
    pub sliding: bool,
    /// Rolling spring after the step [m].
    pub rolling: DVec3,
    /// Twisting spring after the step [m].
    pub twisting: f64,
    /// Losses of the step [J]: sliding, dashpots, rolling and twisting.
    pub losses: [f64; 3],
}

/// Arms of the surface velocity, of the torque between grains, and at a wall [m].
pub fn arms(law: &ContactLaw, radius: f64, overlap: f64) -> [f64; 3] {
    match law {
        ContactLaw::LinearLammps(_) => arms_of::<Lammps>(radius, overlap),
        ContactLaw::Linear(_) if law.slides() => arms_of::<Frictional<false>>(radius, overlap),
        ContactLaw::Linear(_) => arms_of::<Normal>(radius, overlap),
    }
}

fn arms_of<L: Law>(radius: f64, overlap: f64) -> [f64; 3] {
    let (radius, overlap) = (Portable::splat(radius), Portable::splat(overlap));
    [
        first(L::velocity_arm(radius, overlap)),
        first(L::torque_arm::<_, false>(radius, overlap)),
        first(L::torque_arm::<_, true>(radius, overlap)),
    ]
}

/// Energies that the springs of `contact` hold [J]: sliding, and rolling with twisting.
pub fn energies(law: &ContactLaw, contact: &Contact) -> [f64; 2] {
    let kept = Kept {
        spring: Row::new(contact.spring, 0.0),
        rolling: Row::new(contact.rolling, contact.twisting),
        ..Kept::default()
    };
    kept.energies(law)
}

/// The answer of `law`, with all losses, after a step of `step` [s].
pub fn respond(law: &ContactLaw, contact: &Contact, step: f64) -> Answer {
    match law {
        ContactLaw::LinearLammps(_) => respond_as::<Lammps>(law, contact, step),
        ContactLaw::Linear(_) if law.turns() => respond_as::<Frictional<true>>(law, contact, step),
        ContactLaw::Linear(_) if law.slides() => {
            respond_as::<Frictional<false>>(law, contact, step)
        }
        ContactLaw::Linear(_) => respond_as::<Normal>(law, contact, step),
    }
}

fn respond_as<L: Law>(law: &ContactLaw, contact: &Contact, step: f64) -> Answer {
    let number = Portable::splat;
    let vector = |v: DVec3| V3(number(v.x), number(v.y), number(v.z));
    let touch = Touch {
        normal: vector(contact.normal),
        overlap: number(contact.overlap),
        separation: number(contact.separation),
        slip: vector(contact.slip),
        closed: number(1.0),
    };
    let turn = Turn {
        spin: vector(contact.spin),
        reduced_radius: number(contact.reduced_radius),
    };
    let before = Memory {
        springs: Springs {
            tangential: vector(contact.spring),
            sliding: number(f64::from(u8::from(contact.sliding))),
            rolling: vector(contact.rolling),
            twisting: number(contact.twisting),
        },
        force: vector(contact.force),
        couple: vector(contact.couple),
    };
    let (law, step) = (L::of(law), number(step));
    let after = law.respond(&touch, &turn, &before.springs, step);
    let losses = law.losses(&touch, &turn, &before, &after, step);
    let vector = |v: V3<Portable>| DVec3::new(first(v.0), first(v.1), first(v.2));
    Answer {
        normal_force: first(after.normal),
        tangential: vector(after.tangential),
        couple: vector(after.couple),
        spring: vector(after.springs.tangential),
        sliding: first(after.springs.sliding) > 0.5,
        rolling: vector(after.springs.rolling),
        twisting: first(after.springs.twisting),
        losses: [losses.friction, losses.viscosity, losses.rolling].map(first),
    }
}

/// The first of four lanes.
fn first(lanes: Portable) -> f64 {
    let mut row = Row::ZERO;
    lanes.store(&mut row);
    row.0[0]
}
