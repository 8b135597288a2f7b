//! Scenes of water alone: `[water]` without `[grains]`.

use super::output::Output;
use super::{AXES, End, Water, end, output};
use crate::scene::document::Document;
use crate::scene::problem::Problems;
use crate::scene::reader::{Range, Reader, Table};
use crate::scene::units::LENGTH;

/// A checked scene of water alone, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterScene {
    /// One line that says what it is.
    pub title: String,
    /// What it asks.
    pub question: Option<String>,
    /// Where its numbers come from.
    pub source: Option<String>,
    /// The water.
    pub water: Water,
    /// When it ends.
    pub end: End,
    /// The files.
    pub output: Output,
    /// The text it was read from, with all `--set` in it and all that was chosen where it says
    /// nothing: a scene too, which gives the same run to the bit.
    pub text: String,
}

impl WaterScene {
    /// Read and check a scene.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn read(document: &Document) -> Result<Self, Problems> {
        let reader = Reader::new(document);
        let scene = read(&reader);
        reader.finish(scene)
    }

    /// Steps until the end, at most; what round-off adds to a whole number is no step.
    pub fn steps(&self) -> u64 {
        let steps = self.end.duration / self.water.scaling.step;
        (steps * (1.0 - 1e-12)).ceil().max(1.0) as u64
    }
}

fn read(reader: &Reader) -> Option<WaterScene> {
    let root = reader.root();
    root.missing("title", "title = \"Flow between plates\"");
    let title = root.text("title");
    let question = root.text("question");
    let source = root.text("source");
    // What is read below must be known, though what is above it may be wrong.
    root.present(&["box", "water", "end", "output"]);
    let bounds = bounds(&root);
    let water = match bounds {
        Some((size, walled)) => super::read(&root, reader, size, walled),
        None => None,
    };
    let end = end::read(&root, water.as_ref().map(|water| &water.model));
    if let (Some(water), Some(end)) = (&water, end) {
        countable(reader, end, water.scaling.step);
    }
    let output = output::read(&root, reader, water.as_ref(), end)?;
    let (water, end) = (water?, end?);
    let mut scene = WaterScene {
        title: title.unwrap_or_default().into(),
        question: question.map(Into::into),
        source: source.map(Into::into),
        water,
        end,
        output,
        text: String::new(), // until all is chosen
    };
    if !reader.has_problems() {
        scene.text = reader.resolved();
    }
    Some(scene)
}

/// Beyond what a year of computing makes.
const MOST_STEPS: f64 = 1e15;

/// A run has no more steps than can be made.
fn countable(reader: &Reader, end: End, step: f64) {
    let key = match end.steady {
        Some(_) => "max_duration",
        None => "duration",
    };
    let steps = end.duration / step;
    if steps > MOST_STEPS {
        let what = format!("is {steps:.1e} steps of {step:.3e} s, more than {MOST_STEPS:.0e}");
        reader.wrong(&["end", key], format!("{what}; write less"));
    }
}

/// Size of the box [m], and which axes have walls at their ends.
fn bounds(root: &Table) -> Option<([f64; 3], [bool; 3])> {
    let example = "[box] with size = [\"1 cm\", \"1 cm\", \"2 cm\"] (x, y, z)";
    root.missing("box", example);
    let table = root.table("box", example)?;
    let why = "does nothing to water alone, whose pressure counts from that at rest; what drives a \
               flow is water.acceleration";
    table.refuse(&["gravity", "tilt"], why);
    table.missing("size", "size = [\"1 cm\", \"1 cm\", \"2 cm\"]");
    let size = table.quantities("size", &LENGTH, Range::Positive);
    let sides = table.table_or_empty("sides", "sides = { x = \"periodic\", z = \"walls\" }")?;
    let words = [("periodic", false), ("walls", true)];
    let mut walled = [false, false, true];
    for (walled, axis) in walled.iter_mut().zip(AXES) {
        *walled = sides.choice_or(axis, &words, *walled);
    }
    let size = size?;
    let count = size.len();
    let wrong = |_| {
        table.wrong(
            "size",
            format!("has {count} lengths; write three (x, y, z)"),
        )
    };
    Some((size.try_into().map_err(wrong).ok()?, walled))
}
