//! What a million roundings do to the spring of a contact that sticks.

use crate::lab::{Suite, kernel, map};
use bytemuck::{Pod, Zeroable};
use dem::ContactLaw;
use dem::contact::{Linear, LinearLammps, Sliding, Tension};
use dem::gpu::law::{Law, flags};
use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shaders::Device;

pub fn list(suite: &mut Suite) {
    suite.gpu("springs_keep_their_length_for_a_million_steps", keep);
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Contact {
    normal: [f32; 3],
    slip: f32,
    across: [f32; 3],
    overlap: f32,
    spring: [f32; 3],
    unused: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Plan {
    steps: u32,
    begin: u32,
    period: u32,
    step: f32,
}

const STEPS: u32 = 1_000_000;
const AT_ONCE: u32 = 20_000;

fn keep(device: &Device) {
    let sliding = Sliding {
        stiffness: 1e9,
        damping: 0.0,
        friction_static: 0.5,
        friction_dynamic: 0.5,
    };
    let linear = ContactLaw::Linear(Linear {
        normal_stiffness: 1e9,
        normal_damping: 0.0,
        tension: Tension::Clip,
        sliding: Some(sliding),
        rolling: None,
        twisting: None,
    });
    let lammps = ContactLaw::LinearLammps(LinearLammps {
        normal_stiffness: 1e9,
        normal_damping: 0.0,
        tangential_stiffness: 1e9,
        tangential_damping: 0.0,
        friction: 0.5,
    });
    for (name, law) in [("linear", linear), ("lammps", lammps)] {
        // At rest the projection must not eat the spring. In motion a million roundings at
        // random may add up to sqrt(1e6) 2^-24; where a step adds no more than a rounding
        // they all go one way, yet lose but a tenth of the way that was made.
        let way = f64::from(STEPS) * 6.6e-7 * 1e-9 / 1e-8;
        for (slip, allowed) in [(0.0, 4.0 * 6e-8), (1e-5, 6e-5), (1e-9, 0.1 * way)] {
            let fault = wander(device, &law, slip);
            println!("{name}, slip {slip:e} m/s to and fro: springs change by {fault:.1e}");
            assert!(fault < allowed, "{name}, slip {slip:e} m/s: {fault:e}");
        }
    }
}

/// Largest change of springs of 1e-8 m after a whole number of ways to and fro, against them.
fn wander(device: &Device, law: &ContactLaw, slip: f32) -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(10);
    let mut direction = || loop {
        let v = DVec3::from_array(random.random()) * 2.0 - 1.0;
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    };
    let mut contacts = Vec::from_iter((0..96).map(|_| {
        let normal = direction();
        let across = normal.cross(direction()).normalize();
        let array = |v: DVec3| v.as_vec3().to_array();
        Contact {
            normal: array(normal),
            slip,
            across: array(across),
            overlap: 4e-8,
            spring: array(normal.cross(direction()).normalize() * 1e-8),
            unused: 0.0,
        }
    }));
    let first = contacts.clone();
    let kernel = kernel(
        device,
        "springs.wgsl",
        include_str!("springs.wgsl"),
        &flags(law, false),
    );
    let constants = device
        .array_of("constants", &[Law::of(law).unwrap()])
        .unwrap();
    for begin in (0..STEPS).step_by(AT_ONCE as usize) {
        let plan = Plan {
            steps: AT_ONCE,
            begin,
            period: 500,
            step: 6.6e-7,
        };
        let plan = device.array_of("plan", &[plan]).unwrap();
        let others: [(&str, &dyn shaders::Bindable); 2] =
            [("constants", &constants), ("plan", &plan)];
        let springs: Vec<[f32; 4]> = map(device, &kernel, &contacts, &others);
        for (contact, spring) in contacts.iter_mut().zip(springs) {
            assert_eq!(spring[3], 0.0, "the contact slides");
            contact.spring = [spring[0], spring[1], spring[2]];
        }
    }
    let changes = contacts.iter().zip(&first).map(|(now, then)| {
        let [now, then] = [now.spring, then.spring].map(|v| Vec3::from_array(v).as_dvec3());
        (now - then).length() / then.length()
    });
    changes.fold(0.0, f64::max)
}
