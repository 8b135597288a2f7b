//! Trajectories of LAMMPS, step by step, with the law written as LAMMPS computes it.
//!
//! `reference/lammps/README.md` tells the cases, and how far an independent program that
//! evaluates the same formulas agrees with them.

mod beds;
mod few;

use dem::contact::LinearLammps;
use dem::{ContactLaw, Domain, Model};
use glam::DVec3;

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
            size: [0.1, 0.1],
            periodic: [false, false],
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
