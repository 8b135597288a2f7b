//! A scene's text: the file, what `--set` changed in it, and where everything stands.

use super::problem::{Problem, Problems};
use super::tree::{self, Node, Step};
use crate::ready;
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use tempfile::TempDir;
use toml_edit::{DocumentMut, Item, TableLike};

/// A TOML text with its origin.
#[derive(Clone, Debug)]
pub struct Document {
    /// Name of the file in messages.
    name: String,
    /// Folder from which the scene's other files are found.
    pub folder: PathBuf,
    /// The text with all `--set` in it.
    pub text: String,
    /// Tree of that text.
    pub root: Node,
    /// Tree of the file as it stands on disk, for its lines.
    file: Node,
    /// Paths that `--set` gave.
    sets: Vec<Vec<Step>>,
    /// Where files that are part of the program are put to be read.
    scratch: Arc<OnceLock<TempDir>>,
}

impl Document {
    /// Read `text`, the content of the file `name`, and change it by `sets`, each of the
    /// form `PATH=VALUE`.
    ///
    /// # Errors
    /// All mistakes of syntax, or else all `sets` that cannot be done.
    pub fn new(name: &str, folder: &Path, text: &str, sets: &[String]) -> Result<Self, Problems> {
        let (file, slips) = tree::parse(text);
        if !slips.is_empty() {
            let problem = |(line, message): (usize, String)| Problem {
                place: format!("{name}:{line}"),
                line,
                path: String::new(),
                message: format!("not TOML: {message}"),
            };
            return Err(Problems(slips.into_iter().map(problem).collect()));
        }
        let mut document = Self {
            name: name.into(),
            folder: folder.into(),
            text: text.into(),
            root: file.clone(),
            file,
            sets: Vec::new(),
            scratch: Arc::default(),
        };
        document.apply(sets)?;
        Ok(document)
    }

    /// The file that the scene calls `text`, and a name of it that holds from any folder.
    ///
    /// # Errors
    /// A file of a ready-made experiment that is not there, or cannot be put on the disk.
    pub fn locate(&self, text: &str) -> anyhow::Result<(PathBuf, String)> {
        let from_here = self.folder.join(text);
        let own = [Path::new(text), &from_here]
            .into_iter()
            .find_map(|path| path.to_str()?.strip_prefix(ready::PREFIX));
        let Some(own) = own else {
            let full = std::path::absolute(&from_here)?;
            let said = full.to_str().context("its path is not Unicode")?;
            return Ok((from_here, said.into()));
        };
        let bytes = ready::file(own)?;
        if self.scratch.get().is_none() {
            let _ = self.scratch.set(tempfile::tempdir()?);
        }
        let folder = self.scratch.get().context("no folder for it")?.path();
        let path = folder.join(own.replace('/', "-"));
        std::fs::write(&path, bytes)?;
        Ok((path, format!("{}{own}", ready::PREFIX)))
    }

    fn apply(&mut self, sets: &[String]) -> Result<(), Problems> {
        if sets.is_empty() {
            return Ok(());
        }
        let mut edited: DocumentMut = self.text.parse().expect("the text was parsed before");
        let mut problems = Vec::new();
        for argument in sets {
            match set(edited.as_table_mut(), argument) {
                Ok(steps) => self.sets.push(steps),
                Err(message) => problems.push(Problem {
                    place: format!("--set {argument}"),
                    line: 0,
                    path: String::new(),
                    message,
                }),
            }
        }
        if !problems.is_empty() {
            return Err(Problems(problems));
        }
        self.text = edited.to_string();
        self.root = tree::parse(&self.text).0;
        Ok(())
    }

    /// A problem with what is at `path`.
    pub fn problem(&self, path: &[Step], message: String) -> Problem {
        let spelled = self.spell(path);
        // What a key lacks is said at its table.
        let mut node = &self.file;
        let mut in_file = true;
        for step in path {
            match node.down(step) {
                Some(below) => node = below,
                None => in_file = false,
            }
        }
        let set_here = |set: &Vec<Step>| path.starts_with(set) || !in_file && set.starts_with(path);
        if self.sets.iter().any(set_here) {
            return Problem {
                place: "--set".into(),
                line: 0,
                path: spelled,
                message,
            };
        }
        Problem {
            place: format!("{}:{}", self.name, node.line),
            line: node.line,
            path: spelled,
            message,
        }
    }

    /// A path as users write it: `phase.shear.top`. List items go by their `name`, or by
    /// their number from 1.
    fn spell(&self, path: &[Step]) -> String {
        let mut words: Vec<String> = Vec::new();
        let mut node = Some(&self.root);
        for step in path {
            node = node.and_then(|node| node.down(step));
            words.push(match step {
                Step::Key(key) => key.clone(),
                Step::Item(k) => node
                    .and_then(|node| node.text_of("name"))
                    .map_or_else(|| (k + 1).to_string(), String::from),
            });
        }
        words.join(".")
    }
}

/// Do one `PATH=VALUE` and return the path as steps.
fn set(root: &mut dyn TableLike, argument: &str) -> Result<Vec<Step>, String> {
    let form = "write e.g. --set time.step=\"1 us\" or --set phase.shear.friction=0.3";
    let (path, value) = argument
        .split_once('=')
        .ok_or_else(|| format!("has no value; {form}"))?;
    let words: Vec<&str> = path.split('.').map(str::trim).collect();
    if words.iter().any(|word| word.is_empty()) {
        return Err(format!("has no path; {form}"));
    }
    let value = value_of(value.trim());
    let mut steps = Vec::new();
    place(root, &words, value, &mut steps)?;
    Ok(steps)
}

/// A value of TOML, or else text: a shell has often taken its quotes away.
fn value_of(text: &str) -> Item {
    text.parse::<toml_edit::Value>()
        .map_or_else(|_| toml_edit::value(text), Item::Value)
}

fn place(
    table: &mut dyn TableLike,
    words: &[&str],
    value: Item,
    steps: &mut Vec<Step>,
) -> Result<(), String> {
    let (word, rest) = words.split_first().expect("a path has words");
    steps.push(Step::Key((*word).to_string()));
    if rest.is_empty() {
        // Keeps the comment behind the value that goes.
        let behind = table
            .get(word)
            .and_then(Item::as_value)
            .map(|old| old.decor().clone());
        let mut value = value;
        if let (Some(behind), Some(new)) = (behind, value.as_value_mut()) {
            *new.decor_mut() = behind;
        }
        table.insert(word, value);
        return Ok(());
    }
    let below = table.entry(word).or_insert_with(toml_edit::table);
    if let Some(list) = below.as_array_of_tables_mut() {
        let (item, rest) = rest.split_first().expect("checked above");
        let named = |(k, t): (usize, &toml_edit::Table)| {
            let name = t.get("name").and_then(Item::as_str);
            let number = (k + 1).to_string();
            (name == Some(item) || (name.is_none() && number == *item)).then_some(k)
        };
        let k = list
            .iter()
            .enumerate()
            .find_map(named)
            .ok_or_else(|| no_such(word, item, list))?;
        steps.push(Step::Item(k));
        if rest.is_empty() {
            return Err(format!(
                "names a whole {word}; add a key, e.g. {word}.{item}.friction"
            ));
        }
        let table = list.get_mut(k).expect("found above");
        return place(table, rest, value, steps);
    }
    match below.as_table_like_mut() {
        Some(table) => place(table, rest, value, steps),
        None => Err(format!("{word} is a value and has nothing below it")),
    }
}

fn no_such(word: &str, item: &str, list: &toml_edit::ArrayOfTables) -> String {
    let names: Vec<String> = list
        .iter()
        .enumerate()
        .map(|(k, t)| {
            let name = t.get("name").and_then(Item::as_str);
            name.map_or_else(|| (k + 1).to_string(), String::from)
        })
        .collect();
    format!(
        "there is no {word} {item:?}; there are: {}",
        names.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "a = 1 # one\n[t]\nx = { y = \"2 m\" }\n[[phase]]\nname = \"shear\"\nz = 3\n";

    fn with(sets: &[&str]) -> Result<Document, Problems> {
        let sets: Vec<String> = sets.iter().map(|s| (*s).into()).collect();
        Document::new("scene.toml", Path::new("."), TEXT, &sets)
    }

    #[test]
    fn values_are_set_in_tables_inline_tables_and_phases() {
        let document = with(&["a=5", "t.x.y=50 kPa", "phase.shear.z=0.5", "u.v=true"]).unwrap();
        let text = &document.text;
        assert!(text.contains("a = 5 # one"), "{text}");
        assert!(text.contains("x = { y = \"50 kPa\" }"), "{text}");
        assert!(text.contains("z = 0.5"), "{text}");
        assert!(text.contains("[u]\nv = true"), "{text}");
    }

    #[test]
    fn lines_stay_those_of_the_file_and_set_values_say_so() {
        let document = with(&["t.first=5", "t.x.y=1"]).unwrap();
        let key = |k: &str| Step::Key(k.into());
        let z = [key("phase"), Step::Item(0), key("z")];
        let problem = document.problem(&z, "wrong".into());
        assert_eq!(problem.to_string(), "scene.toml:6: phase.shear.z: wrong");
        let y = [key("t"), key("x"), key("y")];
        let problem = document.problem(&y, "wrong".into());
        assert_eq!(problem.to_string(), "--set: t.x.y: wrong");
    }

    #[test]
    fn sets_that_cannot_be_done_are_all_reported() {
        let error = with(&["a", "a.b=1", "phase.flow.z=1", "=2"]).unwrap_err();
        assert_eq!(error.0.len(), 4, "{error}");
        let text = error.to_string();
        assert!(
            text.contains("there is no phase \"flow\"; there are: shear"),
            "{text}"
        );
        assert!(
            text.contains("a is a value and has nothing below it"),
            "{text}"
        );
    }
}
