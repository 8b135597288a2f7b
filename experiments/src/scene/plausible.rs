//! Numbers that are possible each by itself and not together: grains that a load pushes through
//! each other, motions that leap over grains, runs that never end.

use super::reader::Reader;
use super::tree::Step;
use super::{Phase, Scene, Shear};
use crate::protocol;
use crate::run::expected_steps;
use dem::WallMotion;

/// Overlap of two grains under the load, in diameters; a contact law holds for far smaller ones.
const DEEPEST: f64 = 0.1;
/// Steps of a phase; more would take years.
const MOST_STEPS: u64 = 10_000_000_000_000;

/// Note what cannot be in `scene`.
pub fn check(scene: &Scene, reader: &Reader) {
    let grains = &scene.start.grains;
    let radius = || grains.radius.iter().copied();
    let (smallest, largest) = (
        radius().fold(f64::INFINITY, f64::min),
        radius().fold(0.0, f64::max),
    );
    check_stiffness(scene, reader);
    if let Some(skin) = scene.skin.filter(|&skin| skin > 2.0 * largest) {
        let what = format!(
            "is {skin} m, more than a grain's diameter, {:.4e} m",
            2.0 * largest
        );
        let what = format!("{what}; write e.g. a hundredth of it, or leave it out");
        reader.wrong(&["search", "skin"], what);
    }
    for (number, phase) in scene.phases.iter().enumerate() {
        let wrong = |key: &str, message| {
            let of_phase = [Step::Key("phase".into()), Step::Item(number)];
            reader.note(&[&of_phase[..], &[Step::Key(key.into())]].concat(), message);
        };
        for (key, speed) in speeds(scene, phase) {
            // The solver stops there.
            let way = speed.abs() * scene.step;
            if way >= 0.5 * smallest {
                wrong(
                    key,
                    format!(
                        "moves at about {speed:.3e} m/s, {way:.3e} m in a step of {:.3e} s, more than \
                         half the smallest radius, {smallest:.3e} m; write less than {:.3e} m/s",
                        scene.step,
                        0.5 * smallest / scene.step
                    ),
                );
            }
        }
        let steps = expected_steps(scene, phase);
        if steps > MOST_STEPS && phase.end.at_rest.is_none() {
            wrong(
                "end",
                format!(
                    "is {steps:.1e} steps of {:.3e} s away, years of computing; write less, or look \
                     at what the step follows from: the masses of grains and wall, and all \
                     stiffnesses and dampings",
                    scene.step
                ),
            );
        }
    }
}

/// A load σ pushes two grains of diameter d together with about σ d².
fn check_stiffness(scene: &Scene, reader: &Reader) {
    let grains = &scene.start.grains;
    let diameter = 2.0 * grains.mean_radius();
    let height = protocol::expected_height(scene);
    let density = dem::measure::grain_density(grains);
    let load = |phase: &Phase| {
        let wall = match phase.top {
            WallMotion::Stress(load) => load.mean + load.amplitude,
            WallMotion::Held | WallMotion::Velocity(_) => 0.0,
        };
        wall + density * phase.gravity.z.abs() * height
    };
    let heaviest = scene
        .phases
        .iter()
        .max_by(|a, b| load(a).total_cmp(&load(b)));
    let Some(phase) = heaviest else { return };
    let (stress, stiffness) = (load(phase), phase.law.normal_stiffness());
    let least = stress * diameter / DEEPEST;
    if stiffness < least {
        let (name, percent) = (&phase.name, 100.0 * DEEPEST);
        let message = format!(
            "is {stiffness:e} N/m: under the {stress:.1e} Pa of phase {name} (wall and weight) grains \
             would overlap by more than {percent:.0} % of their diameter; write {least:.1e} N/m or \
             more, or a smaller load"
        );
        reader.wrong(&["contact", "normal", "stiffness"], message);
    }
}

/// What moves in a phase, as the key that says so, and how fast [m/s].
fn speeds(scene: &Scene, phase: &Phase) -> Vec<(&'static str, f64)> {
    let mut speeds = Vec::new();
    match phase.shear {
        Some(Shear::StrainRate(rate)) => {
            speeds.push(("shear", rate * protocol::expected_height(scene)));
        }
        Some(Shear::Velocity(velocity)) => speeds.push(("shear", velocity)),
        Some(Shear::Stress(_)) | None => {}
    }
    if let WallMotion::Velocity(velocity) = phase.top {
        speeds.push(("top", velocity));
    }
    speeds
}
