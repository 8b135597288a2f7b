//! `esker check`: what the numbers of a scene imply, before a step is made.

use super::SceneArgs;
use super::calibrate::calibrate;
use crate::protocol;
use crate::run::expected_steps;
use crate::scene::{Phase, Scene, Shear};
use anyhow::Result;
use clap::Args;
use dem::contact::Tension;
use dem::stability::{contact_time, restitution, restitution_scatter};
use dem::{ContactLaw, Model, Surface, WallMotion};
use std::process::ExitCode;

/// Arguments of `esker check`.
#[derive(Clone, Debug, Args)]
pub struct Check {
    #[command(flatten)]
    scene: SceneArgs,
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
    let facts = Facts::of(&scene);
    println!("{}\n", scene.title);
    bed(&scene, &facts);
    step(&scene, &facts);
    collisions(&scene, &facts);
    println!();
    for phase in &scene.phases {
        describe(&scene, phase, &facts);
    }
    println!();
    cost(&scene, arguments.threads.map_or(0, usize::from))?;
    left_out(&scene);
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

fn line(what: &str, value: &str) {
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

fn cost(scene: &Scene, threads: usize) -> Result<()> {
    let count = scene.start.grains.len() as f64;
    let mut seconds = 0.0;
    let mut bytes: f64 = 0.0;
    for phase in &scene.phases {
        let cost = calibrate(scene, &protocol::model(scene, phase, 1.0), threads)?;
        seconds += cost.grain_step * count * expected_steps(scene, phase) as f64;
        bytes = bytes.max(cost.bytes);
    }
    // Beside the solver: the state it began with, and some copies on their way to the files.
    let copies = 6.0 * 250.0;
    line(
        "memory",
        &format!("about {:.0} MiB", count * (bytes + copies) / 1_048_576.0),
    );
    let any = scene.phases.iter().any(|phase| phase.end.at_rest.is_some());
    let most = if any { "at most " } else { "" };
    line(
        "run time",
        &format!("{most}about {} on this machine", duration(seconds)),
    );
    Ok(())
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// What costs nothing because the scene does not need it.
fn left_out(scene: &Scene) {
    let models: Vec<Model> = scene
        .phases
        .iter()
        .map(|phase| protocol::model(scene, phase, 1.0))
        .collect();
    let never = |test: &dyn Fn(&Model) -> bool| !models.iter().any(test);
    let linear = |model: &Model, test: &dyn Fn(&dem::contact::Linear) -> bool| matches!(&model.law, ContactLaw::Linear(law) if test(law));
    let slides = |model: &Model| model.law.slides();
    let mut out = Vec::new();
    if never(&slides) {
        out.push("tangential forces and their springs");
    }
    if never(&|m| linear(m, &|law| law.rolling.is_some())) {
        out.push("rolling resistance");
    }
    if never(&|m| linear(m, &|law| law.twisting.is_some())) {
        out.push("twisting resistance");
    }
    if never(&|m| m.walls.iter().any(|wall| wall.surface == Surface::Full)) {
        out.push("friction at walls");
    }
    if never(&|m| m.ledger) {
        out.push("sums of the energy ledger");
    }
    if scene.domain.periodic == [true; 2] {
        out.push("vertical walls");
    }
    let files = scene.output.files.iter();
    let none: Vec<String> = files
        .filter(|(_, file)| file.is_none())
        .map(|(kind, _)| kind.file_name())
        .collect();
    out.extend(none.iter().map(String::as_str));
    if !out.is_empty() {
        line("left out", &out.join(", "));
    }
}
