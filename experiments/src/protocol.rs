//! The laboratory protocol: what each phase makes of the state that it is handed.

use crate::scene::{Motion, Phase, Scene, Shear};
use crate::start::highest;
use anyhow::{Result, ensure};
use dem::{
    Constraint, Drive, Grains, Horizontal, Model, State, Surface, Wall, WallMotion, WallState,
    measure,
};
use glam::DVec3;

/// Solid fraction at which a bed is expected to settle.
pub const SETTLED: f64 = 0.6;

/// Index of the top wall in [`Model::walls`].
pub const TOP: usize = 1;

/// A phase that is ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// What acts on the grains.
    pub model: Model,
    /// The state at the start of the phase.
    pub state: State,
    /// Height of the bed when the phase began [m]; strains refer to it.
    pub height: f64,
}

/// What a phase measures from: the bed at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Time of the state [s].
    pub time: f64,
    /// Height of the bed [m].
    pub height: f64,
    /// Way of the driven layer [m].
    pub way: f64,
    /// Shear strain of the phases before [-].
    pub strain: f64,
}

/// A phase that was stopped before its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Unfinished {
    /// Its name.
    pub phase: String,
    /// What it measures from.
    pub reference: Reference,
}

/// What came before a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Past {
    /// Shear strain since shearing began [-].
    pub strain: f64,
    /// The phase that the state is in the middle of; none: it is at the end of one.
    pub unfinished: Option<Unfinished>,
    /// The water between the grains; none: they were dry.
    pub water: Option<PastWater>,
}

/// The water that came with a state.
#[derive(Clone, Debug, PartialEq)]
pub struct PastWater {
    /// Number of cells along x, y, z.
    pub cells: [usize; 3],
    /// Pressure, flux, vapour, loads of the grains.
    pub state: coupling::State,
    /// Stiffness of the skeleton, if it was known [Pa].
    pub stiffness: Option<f64>,
}

impl Past {
    /// What `phase` measures from, if it is to go on where it was stopped: it has the same
    /// name, and keeps the motion.
    pub fn reference_of(&self, phase: &Phase) -> Option<Reference> {
        let same = |u: &&Unfinished| u.phase == phase.name && phase.start == Motion::Keep;
        let unfinished = self.unfinished.as_ref().filter(same);
        unfinished.map(|unfinished| unfinished.reference)
    }
}

/// The model of `phase` on a bed of `height` [m].
pub fn model(scene: &Scene, phase: &Phase, height: f64) -> Model {
    Model {
        domain: scene.domain,
        gravity: phase.gravity,
        law: phase.law,
        walls: walls(scene, phase),
        drive: drive(phase, height),
        step: scene.step,
        skin: scene.skin,
        ledger: scene.output.needs_ledger(),
    }
}

fn drive(phase: &Phase, height: f64) -> Option<Drive> {
    phase.shear.map(|shear| match shear {
        Shear::StrainRate(rate) => Drive::Velocity(rate * height),
        Shear::Velocity(velocity) => Drive::Velocity(velocity),
        Shear::Stress(stress) => Drive::ShearStress(stress),
    })
}

/// The models of all phases, where heights do not matter.
pub fn models(scene: &Scene) -> impl Iterator<Item = Model> {
    scene.phases.iter().map(|phase| model(scene, phase, 1.0))
}

/// Bottom, top, and a pair of frictionless ones for each side that is not periodic.
fn walls(scene: &Scene, phase: &Phase) -> Vec<Wall> {
    let wall = |name: &str, normal, surface, motion| Wall {
        name: name.into(),
        normal,
        surface,
        motion,
    };
    let mut walls = vec![
        wall("bottom", DVec3::Z, scene.bottom, WallMotion::Held),
        wall("top", -DVec3::Z, scene.top, phase.top),
    ];
    let sides = [(DVec3::X, ["left", "right"]), (DVec3::Y, ["front", "back"])];
    for (k, (normal, names)) in sides.into_iter().enumerate() {
        if !scene.domain.periodic[k] {
            let side = |name, normal| wall(name, normal, Surface::Frictionless, WallMotion::Held);
            walls.extend([side(names[0], normal), side(names[1], -normal)]);
        }
    }
    walls
}

/// Height of the bed at the start [m].
pub fn start_height(scene: &Scene) -> f64 {
    let model = model(scene, &scene.phases[0], 1.0);
    measure::bed_height(&model, &scene.start)
}

/// Height that the bed will have once it carries a load [m], as far as it can be guessed: that of
/// a state as it is, that of other grains at a solid fraction of 0.6.
pub fn expected_height(scene: &Scene) -> f64 {
    if !scene.start.contacts.is_empty() {
        return start_height(scene);
    }
    settled_height(&scene.start, scene.domain.area())
}

fn settled_height(start: &State, area: f64) -> f64 {
    let grains = &start.grains;
    let volume: f64 = (0..grains.len()).map(|k| grains.volume(k)).sum();
    volume / (SETTLED * area)
}

/// Height from wall to wall [m] over `area` [m²] when water comes to what begins as `start`: that
/// of the top wall, held or moved as the `phases` say, or of a settled bed where it is pushed onto
/// the grains. That of a state is as it is.
pub fn height_when_wet(phases: &[Phase], start: &State, area: f64) -> f64 {
    let mut height = -start.walls[TOP].offset;
    if !start.contacts.is_empty() {
        return height;
    }
    let settled = settled_height(start, area);
    for phase in phases {
        let wet = phase.water.is_some();
        match phase.top {
            WallMotion::Stress(_) => return settled,
            WallMotion::Velocity(down) if !wet => height -= down * phase.end.duration,
            WallMotion::Velocity(_) | WallMotion::Held => {}
        }
        if wet {
            break;
        }
    }
    // A wall that moves for an unknown time stops at the grains.
    if height.is_finite() {
        height.max(settled)
    } else {
        settled
    }
}

/// Way of the driven layer along x [m], the mean of its grains; zero without one.
pub fn driven_way(state: &State) -> f64 {
    let grains = &state.grains;
    let each = grains.constraint.iter().zip(&grains.displacement);
    let driven = each.filter(|(c, _)| c.horizontal == Horizontal::Driven);
    let (sum, count) = driven.fold((0.0, 0.0), |(s, n), (_, d)| (s + d.x, n + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Hand `state` to `phase`: lower the wall, choose the layers, set the motion. `reference`:
/// what a phase that goes on in its middle measures from.
///
/// # Errors
/// A bed that is too thin for its layers.
pub fn prepare(
    scene: &Scene,
    phase: &Phase,
    mut state: State,
    reference: Option<Reference>,
) -> Result<Prepared> {
    let goes_on = phase.start == Motion::Keep;
    if !goes_on && matches!(phase.top, WallMotion::Stress(_)) {
        lower_wall(&mut state);
    }
    // The drive follows once the height is known.
    let mut model = model(scene, phase, 1.0);
    let [floor, top] = measure::bed_span(&model, &state);
    let height = reference.map_or(top - floor, |reference| reference.height);
    model.drive = drive(phase, height);
    choose_layers(phase, &mut state, floor, height)?;
    match phase.start {
        Motion::Keep => {}
        Motion::Rest => stop(&mut state),
        Motion::Profile => {
            stop(&mut state);
            if let Some(Drive::Velocity(velocity)) = model.drive {
                set_profile(&mut state.grains, velocity, floor, height, phase.layer);
            }
        }
    }
    Ok(Prepared {
        model,
        state,
        height,
    })
}

/// A wall that will be pushed down begins on the highest grain: it would fall through
/// the space above, and hit the bed with what it gained there.
fn lower_wall(state: &mut State) {
    let top = highest(&state.grains);
    if -state.walls[TOP].offset > top {
        state.walls[TOP] = WallState {
            offset: -top,
            velocity: 0.0,
        };
    }
}

fn choose_layers(phase: &Phase, state: &mut State, floor: f64, height: f64) -> Result<()> {
    let grains = &mut state.grains;
    let is = |horizontal| move |c: &Constraint| c.horizontal == horizontal;
    if phase.shear.is_none() {
        grains.constraint.fill(Constraint::default());
        return Ok(());
    }
    // A shear that goes on keeps the layers that it has.
    if phase.start == Motion::Keep && grains.constraint.iter().any(is(Horizontal::Driven)) {
        return Ok(());
    }
    ensure!(
        2.0 * phase.layer < height,
        "the bed is {height:.4} m high, and the held and the driven layer of {} m each leave \
         nothing between them; write a smaller layer, or use more grains",
        phase.layer
    );
    for (constraint, position) in grains.constraint.iter_mut().zip(&grains.position) {
        let z = position.z - floor;
        let horizontal = if z < phase.layer {
            Horizontal::Held
        } else if z > height - phase.layer {
            Horizontal::Driven
        } else {
            Horizontal::Free
        };
        *constraint = Constraint {
            horizontal,
            rotation_held: horizontal != Horizontal::Free,
        };
    }
    for (horizontal, name) in [(Horizontal::Held, "held"), (Horizontal::Driven, "driven")] {
        ensure!(
            grains.constraint.iter().any(is(horizontal)),
            "no grain has its centre in the {name} layer of {} m; write a thicker layer",
            phase.layer
        );
    }
    Ok(())
}

fn stop(state: &mut State) {
    state.grains.velocity.fill(DVec3::ZERO);
    state.grains.angular_velocity.fill(DVec3::ZERO);
    for wall in &mut state.walls {
        wall.velocity = 0.0;
    }
}

/// Velocities along x from zero at the top of the held layer to `velocity` at the bottom
/// of the driven one.
fn set_profile(grains: &mut Grains, velocity: f64, floor: f64, height: f64, layer: f64) {
    for (v, position) in grains.velocity.iter_mut().zip(&grains.position) {
        let share = (position.z - floor - layer) / (height - 2.0 * layer);
        v.x = velocity * share.clamp(0.0, 1.0);
    }
}
