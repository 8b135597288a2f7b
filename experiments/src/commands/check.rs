//! `esker check`: what the numbers of a scene imply, before a step is made.

use super::SceneArgs;
use super::cost;
use super::left_out::left_out;
use super::pores;
use crate::backend::{Backend, Machine};
use crate::protocol;
use crate::run::expected_steps;
use crate::scene::{AnyScene, Phase, Scene, Shear};
use anyhow::Result;
use clap::Args;
use dem::contact::Tension;
use dem::stability::{contact_time, restitution, restitution_scatter};
use dem::{ContactLaw, WallMotion};
use std::process::ExitCode;

/// Arguments of `esker check`.
#[derive(Clone, Debug, Args)]
pub struct Check {
    #[command(flatten)]
    scene: SceneArgs,
    /// Who would compute
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// Number of threads for the estimate of the run time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

/// `esker check`
///
/// # Errors
/// Everything that is wrong with the scene.
pub fn check(arguments: &Check) -> Result<ExitCode> {
    let (scene, _) = arguments.scene.read()?;
    let threads = arguments.threads.map_or(0, usize::from);
    match &scene {
        AnyScene::Grains(scene) => check_grains(scene, arguments.backend, threads),
        AnyScene::Water(scene) => super::water::check(scene, arguments.backend, threads),
    }
}

fn check_grains(scene: &Scene, backend: Backend, threads: usize) -> Result<ExitCode> {
    let chosen = backend.choose_for(scene, threads)?;
    let facts = Facts::of(scene);
    println!("{}\n", scene.title);
    bed(scene, &facts);
    step(scene, &facts);
    collisions(scene, &facts);
    if let Some(water) = &scene.water {
        pores::facts(scene, water);
    }
    println!();
    for phase in &scene.phases {
        describe(scene, phase, &facts);
    }
    pores::report(scene, &chosen.machine)?;
    println!();
    line(
        "computed on",
        &format!("{} ({})", chosen.machine.describe(), chosen.why),
    );
    cost::time_and_memory(scene, &chosen.machine)?;
    if let Machine::Gpu(device) = &chosen.machine {
        cost::memory_on_device(scene, &device.adapter)?;
        cost::accuracy(scene, facts.diameter)?;
    }
    let out = left_out(scene, &chosen.machine);
    if !out.is_empty() {
        line("left out", &out.join(", "));
    }
    for warning in scene.warnings() {
        line("warning", &warning);
    }
    Ok(ExitCode::SUCCESS)
}

/// Numbers of the grains that many lines need.
struct Facts {
    /// Number of grains.
    count: usize,
    /// Mean diameter [m].
    diameter: f64,
    /// Mean mass [kg].
    mass: f64,
    /// Density [kg/m³].
    density: f64,
    /// Height that the bed is expected to have once it is loaded [m].
    height: f64,
}

impl Facts {
    fn of(scene: &Scene) -> Self {
        let grains = &scene.start.grains;
        let count = grains.len();
        let mass: f64 = grains.mass.iter().sum();
        let volume: f64 = (0..count).map(|k| grains.volume(k)).sum();
        Self {
            count,
            diameter: 2.0 * grains.mean_radius(),
            mass: mass / count as f64,
            density: mass / volume,
            height: protocol::expected_height(scene),
        }
    }
}

pub(super) fn line(what: &str, value: &str) {
    println!("{what:<22}{value}");
}

fn bed(scene: &Scene, facts: &Facts) {
    let radius = &scene.start.grains.radius;
    let min = radius.iter().copied().fold(f64::INFINITY, f64::min);
    let max = radius.iter().copied().fold(0.0, f64::max);
    line(
        "grains",
        &format!(
            "{}, radius {min:.3e} to {max:.3e} m, mass {:.3e} kg",
            facts.count, facts.mass
        ),
    );
    let [x, y] = scene.domain.size;
    let diameters = |length: f64| length / facts.diameter;
    line(
        "box",
        &format!(
            "{x:.4} x {y:.4} m, {:.1} x {:.1} diameters",
            diameters(x),
            diameters(y)
        ),
    );
    line(
        "bed when settled",
        &format!(
            "about {:.4} m high, {:.1} diameters ({})",
            facts.height,
            diameters(facts.height),
            match scene.start.contacts.is_empty() {
                true => "at solid fraction 0.6",
                false => "as the state has it",
            }
        ),
    );
}

fn step(scene: &Scene, facts: &Facts) {
    let limit = scene.stable_step();
    line(
        "time step",
        &format!(
            "{:.3e} s, {:.2} of the stability limit {limit:.3e} s (lightest grain)",
            scene.step,
            scene.step / limit
        ),
    );
    let law = &scene.phases[0].law;
    let time = contact_time(
        law.normal_stiffness(),
        law.normal_damping(),
        0.5 * facts.mass,
    );
    let text = if time.is_finite() {
        format!("{:.1} for two grains of mean mass", time / scene.step)
    } else {
        "overdamped: grains do not part again".into()
    };
    line("steps per contact", &text);
}

fn collisions(scene: &Scene, facts: &Facts) {
    let law = &scene.phases[0].law;
    let clipped = matches!(law, ContactLaw::Linear(linear) if linear.tension == Tension::Clip);
    let (stiffness, damping, m) = (
        law.normal_stiffness(),
        law.normal_damping(),
        0.5 * facts.mass,
    );
    let exact = restitution(stiffness, damping, m, clipped);
    let scatter = restitution_scatter(stiffness, damping, m, clipped, scene.step);
    line(
        "restitution",
        &format!(
            "{exact:.3} in the law; {:.3} to {:.3}, mean {:.3}, at this step",
            scatter.min, scatter.max, scatter.mean
        ),
    );
}

fn describe(scene: &Scene, phase: &Phase, facts: &Facts) {
    let steps = expected_steps(scene, phase);
    let seconds = steps as f64 * scene.step;
    let most = if phase.end.at_rest.is_some() {
        "at most "
    } else {
        ""
    };
    println!("phase {}", phase.name);
    line(
        "  duration",
        &format!("{most}{seconds:.4} s, {most}{steps} steps"),
    );
    let stress = match phase.top {
        WallMotion::Stress(load) => {
            line(
                "  wall",
                &format!(
                    "{:.4e} Pa, mass {:.3e} kg, damping {:.3e} N s/m",
                    load.mean, load.mass, load.damping
                ),
            );
            Some(load.mean)
        }
        WallMotion::Velocity(v) => {
            line("  wall", &format!("moves at {v} m/s, positive downwards"));
            None
        }
        WallMotion::Held => None,
    };
    let rate = match phase.shear {
        Some(Shear::StrainRate(rate)) => Some(rate),
        Some(Shear::Velocity(v)) => Some(v / facts.height),
        Some(Shear::Stress(tau)) => {
            line("  shear stress", &format!("{tau:.4e} Pa"));
            None
        }
        None => None,
    };
    if let Some(rate) = rate {
        let velocity = rate * facts.height;
        line(
            "  shear",
            &format!("{rate:.4e} 1/s, upper layer at about {velocity:.3e} m/s"),
        );
    }
    if let Some(water) = &scene.water {
        pores::describe(scene, water, phase, facts.height, rate);
    }
    if phase.shear.is_some() {
        let share = 2.0 * phase.layer / facts.height;
        let thickness = phase.layer;
        line(
            "  layers",
            &format!(
                "{thickness:.4} m each, held and driven, {:.0} % of the bed",
                100.0 * share
            ),
        );
    }
    if let Some(stress) = stress {
        let kappa = phase.law.normal_stiffness() / (stress * facts.diameter);
        line(
            "  stiffness number",
            &format!("{kappa:.3e}, k_n / (stress x diameter)"),
        );
        if let Some(rate) = rate {
            let number = rate.abs() * facts.diameter * (facts.density / stress).sqrt();
            let regime = match number {
                n if n < 1e-3 => "quasi-static",
                n if n < 1e-1 => "dense flow",
                _ => "gas-like",
            };
            line(
                "  inertial number",
                &format!("{number:.3e}, {regime} (with the diameter; sphere takes the radius)"),
            );
        }
    }
}
