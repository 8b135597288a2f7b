//! Scenes: one TOML file becomes a checked [`Scene`] of plain SI numbers, or the list of
//! everything that is wrong with it.
//!
//! The text becomes a [tree] that knows its lines; [readers](reader) take it section
//! by section, note every problem and go on; and what depends on the grains (restitution,
//! the wall's mass, the time step) is worked out at the end.

pub mod bounds;
pub mod choices;
pub mod contact;
pub mod document;
pub mod grains;
pub mod layers;
pub mod output;
pub mod phase;
pub mod plausible;
pub mod problem;
pub mod reader;
pub mod time;
pub mod tree;
pub mod units;
pub mod water;
pub mod whole;

pub use document::Document;
pub use output::Output;
pub use phase::{End, Motion, Phase, Shear};
pub use problem::{Problem, Problems};
pub use water::{Pores, WaterScene};

use crate::protocol::{self, Past};
use crate::start::Source;
use dem::contact::{Linear, Tension};
use dem::{ContactLaw, Domain, State, Surface};
use layers::Room;
use reader::{Reader, Table};
use tree::Step;
use water::pores;

/// A checked scene, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// One line that says what it is.
    pub title: String,
    /// What it asks.
    pub question: Option<String>,
    /// Where its numbers come from.
    pub source: Option<String>,
    /// Seed of all that is random.
    pub seed: u64,
    /// The box along x and y.
    pub domain: Domain,
    /// How the top wall touches grains.
    pub top: Surface,
    /// How the bottom wall touches grains.
    pub bottom: Surface,
    /// The state at the start.
    pub start: State,
    /// What came before it.
    pub past: Past,
    /// Time step [s].
    pub step: f64,
    /// Surplus of the neighbour search [m]; none: chosen as it goes.
    pub skin: Option<f64>,
    /// The water between the grains; none: they are dry.
    pub water: Option<Pores>,
    /// The protocol.
    pub phases: Vec<Phase>,
    /// The files.
    pub output: Output,
    /// The text it was read from, with all `--set` in it and all that was chosen where it says
    /// nothing: a scene too, which gives the same run to the bit.
    pub text: String,
}

impl Scene {
    /// Read and check a scene.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn read(document: &Document) -> Result<Self, Problems> {
        let reader = Reader::new(document);
        let scene = read(&reader);
        reader.finish(scene)
    }
}

/// What a file describes.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyScene {
    /// Grains.
    Grains(Box<Scene>),
    /// Water alone.
    Water(Box<WaterScene>),
}

impl AnyScene {
    /// Read and check a scene of either kind: with `[water]` and without `[grains]` it is water
    /// alone.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn read(document: &Document) -> Result<Self, Problems> {
        let has = |key: &str| document.root.down(&Step::Key(key.into())).is_some();
        Ok(match has("water") && !has("grains") {
            true => Self::Water(Box::new(WaterScene::read(document)?)),
            false => Self::Grains(Box::new(Scene::read(document)?)),
        })
    }
}

/// Title of a scene without checking the rest.
pub fn title(document: &Document) -> Option<&str> {
    document.root.text_of("title")
}

fn read(reader: &Reader) -> Option<Scene> {
    let root = reader.root();
    root.missing("title", "title = \"Dry shear of a coarse till\"");
    let title = root.text("title");
    let question = root.text("question");
    let source = root.text("source");
    if !root.has("seed") {
        root.choose("seed", 1);
    }
    let seed = root.integer("seed", 0, "1").unwrap_or(1) as u64;

    let origin = grains::read(&root);
    let (made_in, past) = match &origin {
        Some(Source::Bed { bed, .. }) => (bounds::MadeIn::of_bed(bed.size), Past::default()),
        Some(Source::State(saved)) => (bounds::MadeIn::State(saved.domain), saved.past.clone()),
        _ => (bounds::MadeIn::Nothing, Past::default()),
    };
    let bounds = bounds::read(&root, made_in);
    let grains = origin.as_ref().map(|origin| origin.grains(seed));
    let time = time::read(&root);
    let stated = bounds.map(|bounds| bounds.domain);
    let bounds = bounds.map(|bounds| match &grains {
        Some(grains) => bounds::Bounds {
            domain: whole::whole(bounds.domain, grains, bounds.height, time.skin),
            ..bounds
        },
        None => bounds,
    });

    // Where something above is wrong, numbers that do no harm stand in for it, so that the
    // rest is still checked.
    let mass: f64 = grains.as_ref().map_or(1.0, |g| g.mass.iter().sum());
    let count = grains.as_ref().map_or(1.0, |g| g.len() as f64);
    let volume = grains
        .as_ref()
        .map_or(1.0, |g| (0..g.len()).map(|k| g.volume(k)).sum());
    let diameter = grains.as_ref().map_or(1.0, largest_diameter);
    let law = contact::read(&root, mass / count);
    let loose = match &origin {
        Some(Source::Loose { fraction, .. }) => Some(*fraction),
        _ => None,
    };
    let area = bounds.map_or(1.0, |b| b.domain.area());
    let context = phase::Context {
        area,
        mass,
        room: match (&grains, bounds) {
            (Some(grains), Some(_)) => Room::of(grains, area, loose),
            _ => Room::ENDLESS,
        },
        density: mass / volume,
        diameter,
        law: law.unwrap_or(HARMLESS),
        gravity: bounds.map_or(glam::DVec3::ZERO, |b| b.gravity),
    };
    let mean_diameter = grains.as_ref().map_or(1.0, |g| 2.0 * g.mean_radius());
    let start = match (&origin, grains, bounds, &stated) {
        (Some(origin), Some(grains), Some(bounds), Some(stated))
            if check_width(reader, stated, diameter) =>
        {
            let placed = origin.place(grains, &bounds.domain, bounds.height, seed);
            placed
                .map_err(|message| reader.wrong(&["box", "size"], message))
                .ok()
        }
        _ => None,
    };
    let wet = root.has("water");
    let water = pores::Begun::of(&root);
    // Where the water is wrong, phases may still speak of it.
    let edges = match &water {
        Some(water) => Some(water.edges()),
        None => wet.then(pores::Edges::tight),
    };
    let phases = phase::read(&root, &context, edges.as_ref());
    let around = bounds
        .filter(|_| origin.is_some())
        .map(|bounds| pores::Around {
            size: bounds.domain.size,
            periodic: bounds.domain.periodic,
            diameter: mean_diameter,
            height: match &start {
                Some(start) => protocol::height_when_wet(&phases, start, area),
                // Something is wrong, and only that is told.
                None => volume / (protocol::SETTLED * area),
            },
            cells: past.water.as_ref().map(|water| water.cells),
        });
    let water = water.and_then(|water| water.finish(around.as_ref()));
    let [top, bottom] = walls(&root);
    let rough = [top, bottom].map(|surface| surface == Surface::Full);
    let output = output::read(&root, &phases, mean_diameter, rough, wet);
    let (origin, bounds, start) = (origin?, bounds?, start?);
    let (output, _) = (output?, law?);
    if wet && water.is_none() {
        return None;
    }
    if phases.is_empty() {
        return None;
    }
    let mut scene = Scene {
        title: title.unwrap_or_default().into(),
        question: question.map(Into::into),
        source: source.map(Into::into),
        seed,
        domain: bounds.domain,
        top,
        bottom,
        start,
        past,
        step: f64::NAN, // until `settle`
        skin: time.skin,
        water,
        phases,
        output,
        text: String::new(), // until all is chosen
    };
    if bounds.height.is_none() && !matches!(origin, Source::State(_)) {
        let third = [
            Step::Key("box".into()),
            Step::Key("size".into()),
            Step::Item(2),
        ];
        let height = -scene.start.walls[protocol::TOP].offset;
        reader.choose(&third, units::LENGTH.write(height));
    }
    time::settle(&mut scene, time.step)
        .map_err(|message| reader.wrong(&["time", "step"], message))
        .ok()?;
    output::check(&mut scene, reader);
    plausible::check(&scene, reader);
    if let Some(water) = &scene.water {
        pores::check(&scene, water, reader);
    }
    // The first bed is there already.
    let first = &scene.phases[0];
    let reference = scene.past.reference_of(first);
    if first.shear.is_some()
        && !reader.has_problems()
        && let Err(error) = protocol::prepare(&scene, first, scene.start.clone(), reference)
    {
        let layer = [
            Step::Key("phase".into()),
            Step::Item(0),
            Step::Key("layer".into()),
        ];
        reader.note(&layer, error.to_string());
    }
    if time.step.is_none() {
        let step = [Step::Key("time".into()), Step::Key("step".into())];
        reader.choose(&step, units::TIME.write(scene.step));
    }
    if !reader.has_problems() {
        scene.text = reader.resolved();
    }
    Some(scene)
}

const HARMLESS: ContactLaw = ContactLaw::Linear(Linear {
    normal_stiffness: 1.0,
    normal_damping: 0.0,
    tension: Tension::Clip,
    sliding: None,
    rolling: None,
    twisting: None,
});

fn largest_diameter(grains: &dem::Grains) -> f64 {
    2.0 * grains.radius.iter().copied().fold(0.0, f64::max)
}

fn walls(root: &Table) -> [Surface; 2] {
    let words = [
        ("frictionless", Surface::Frictionless),
        ("full", Surface::Full),
    ];
    let example = "[wall.top] with surface = \"full\"";
    let Some(walls) = root.table_or_empty("wall", example) else {
        return [Surface::default(); 2];
    };
    ["top", "bottom"].map(|key| {
        let wall = walls.table_or_empty(key, example);
        let surface = wall.map(|wall| wall.choice_or("surface", &words, Surface::default()));
        surface.unwrap_or_default()
    })
}

/// Across a periodic side a grain must not meet two images of the same neighbour.
fn check_width(reader: &Reader, domain: &Domain, diameter: f64) -> bool {
    let narrow = (0..2).find_map(|side| {
        let least = if domain.periodic[side] { 2.5 } else { 1.0 } * diameter;
        (domain.size[side] < least).then_some((side, least))
    });
    if let Some((side, least)) = narrow {
        let (size, along) = (domain.size[side], ["x", "y"][side]);
        let message = format!(
            "is {size} m along {along}, too narrow for grains of {diameter} m; write {least:.4} m \
             or more, or smaller grains"
        );
        reader.wrong(&["box", "size"], message);
    }
    narrow.is_none()
}
