//! The plan of a sweep, `sweep.json` in its folder, beside the scene of each run.

use super::design::Design;
use super::tree::{Run, Tree};
use crate::scene::{AnyScene, Document, Problem, Problems};
use anyhow::{Context, Result, anyhow, bail, ensure};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// What is to be run, and for which point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Title of the scene.
    pub title: String,
    /// The scene with what `--set` changed in it and before what is varied.
    pub scene: String,
    /// The points.
    pub design: Design,
    /// Names of the phases; none for water alone.
    pub phases: Vec<String>,
    /// All runs, each after the one that it starts from.
    pub runs: Vec<Run>,
    /// The last run of each point.
    pub ends: Vec<usize>,
}

/// The text of a scene before it is read.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name of the file in messages.
    pub name: String,
    /// From where it finds its other files.
    pub folder: PathBuf,
    /// The text.
    pub text: String,
    /// What `--set` changes in it.
    pub sets: Vec<String>,
}

/// Name of the plan's file.
const PLAN: &str = "sweep.json";

impl Plan {
    /// Read and check the scene of every point of `design`. Returns the scenes of the runs too.
    ///
    /// # Errors
    /// All that is wrong with the first points that are wrong.
    pub fn new(source: &Source, design: Design) -> Result<(Self, Vec<String>)> {
        let mut tree = Tree::default();
        for point in 0..design.count() {
            let scene = read(source, &design, point)?;
            tree.add(&scene)?;
        }
        let base = Document::new(&source.name, &source.folder, &source.text, &source.sets)?;
        let plan = Self {
            title: crate::scene::title(&base).unwrap_or_default().into(),
            scene: base.text,
            design,
            phases: tree.phases,
            runs: tree.runs,
            ends: tree.ends,
        };
        Ok((plan, tree.texts))
    }

    /// Put the plan and the scene of each run into `folder`. A folder that holds the same plan
    /// stays as it is; `force` takes away what another sweep left.
    ///
    /// # Errors
    /// Another sweep in the folder, or files that cannot be written.
    pub fn store(&self, texts: &[String], folder: &Path, force: bool) -> Result<()> {
        let path = folder.join(PLAN);
        if path.exists() {
            let same = Self::load(folder).is_ok_and(|there| there == *self);
            if same && !force {
                return Ok(());
            }
            ensure!(
                force,
                "{} holds another sweep (another scene or other values); choose another folder \
                 with --out, or replace it with --force",
                folder.display()
            );
            Self::load(folder)?.remove(folder)?;
        }
        let cannot = || format!("cannot write to {}", folder.display());
        for (run, text) in self.runs.iter().zip(texts) {
            let folder = folder.join(&run.name);
            fs::create_dir_all(&folder).with_context(cannot)?;
            fs::write(folder.join("scene.toml"), text).with_context(cannot)?;
        }
        // Last, so that a plan is whole where it is there.
        let partial = folder.join("sweep.json.partial");
        fs::write(&partial, serde_json::to_string_pretty(self)?).with_context(cannot)?;
        fs::rename(&partial, &path).with_context(cannot)
    }

    /// The plan in `folder`.
    ///
    /// # Errors
    /// A folder without a plan.
    pub fn load(folder: &Path) -> Result<Self> {
        let path = folder.join(PLAN);
        let text = fs::read_to_string(&path).with_context(|| {
            let folder = folder.display();
            format!("{folder} holds no sweep to go on with; name a scene, and what to --vary")
        })?;
        serde_json::from_str(&text).with_context(|| format!("cannot read {}", path.display()))
    }

    /// Take away the results of this plan, and nothing else.
    fn remove(&self, folder: &Path) -> Result<()> {
        // First, so that what is left is no sweep.
        fs::remove_file(folder.join(PLAN))?;
        for run in &self.runs {
            let own = folder.join(&run.name);
            if own.exists() {
                fs::remove_dir_all(&own)
                    .with_context(|| format!("cannot remove {}", own.display()))?;
            }
        }
        for name in [super::FILE, super::POINTS] {
            if folder.join(name).exists() {
                fs::remove_file(folder.join(name))?;
            }
        }
        Ok(())
    }

    /// The run called `name`.
    ///
    /// # Errors
    /// A name that is not there, with the nearest that is.
    pub fn find(&self, name: &str) -> Result<usize> {
        let names = self.runs.iter().map(|run| run.name.as_str());
        if let Some(k) = names.clone().position(|own| own == name) {
            return Ok(k);
        }
        let near = names.max_by(|a, b| {
            let alike = |own| strsim::jaro_winkler(own, name);
            alike(a).total_cmp(&alike(b))
        });
        bail!(
            "the sweep has no run {name:?}; did you mean {}?",
            near.unwrap_or_default()
        )
    }

    /// The runs of a point, from the first to the last.
    pub fn chain(&self, point: usize) -> Vec<usize> {
        let mut chain: Vec<usize> =
            std::iter::successors(Some(self.ends[point]), |&run| self.runs[run].from).collect();
        chain.reverse();
        chain
    }

    /// A point in words: its number, from 0, and its values.
    pub fn describe(&self, point: usize) -> String {
        let values = self.design.values(point);
        let each = self.design.axes.iter().zip(values);
        let each: Vec<_> = each
            .map(|(axis, value)| format!("{} = {value}", axis.paths[0]))
            .collect();
        format!("point {point}: {}", each.join(", "))
    }
}

/// The scene of a point.
fn read(source: &Source, design: &Design, point: usize) -> Result<AnyScene> {
    let own = design.sets(point);
    let sets = [source.sets.as_slice(), &own].concat();
    let document = Document::new(&source.name, &source.folder, &source.text, &sets);
    let read = document.and_then(|document| AnyScene::read(&document));
    read.map_err(|problems| refused(problems, &own, point, design.grid))
}

/// What is wrong with a point; what it varies is called by its name and value.
fn refused(problems: Problems, own: &[String], point: usize, grid: bool) -> anyhow::Error {
    // The values of other designs stand in no argument.
    let place_of = if grid { "--vary" } else { "the point's" };
    let named = |problem: Problem| {
        let (place, path) = (&problem.place, &problem.path);
        // Either the path could not be set, or what is there is wrong.
        let of_path = |set: &&String| {
            let varied = set.split('=').next().unwrap_or_default().trim();
            let below = |a: &str, b: &str| {
                a.strip_prefix(b)
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            };
            !path.is_empty() && (below(path, varied) || below(varied, path))
        };
        let set = match place.strip_prefix("--set ") {
            Some(argument) => own.iter().find(|set| *set == argument),
            None if place == "--set" => own.iter().find(of_path),
            None => None,
        };
        match set {
            Some(set) => Problem {
                place: format!("{place_of} {set}"),
                ..problem
            },
            None => problem,
        }
    };
    let problems = Problems(problems.0.into_iter().map(named).collect());
    let n = problems.0.len();
    let things = if n == 1 { "thing is" } else { "things are" };
    let own = own.join(", ");
    anyhow!("nothing was run: {n} {things} wrong with point {point} ({own})\n{problems}")
}
