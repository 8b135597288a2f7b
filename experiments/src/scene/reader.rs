//! Reads tables key by key. Every problem is noted and reading goes on, so that a file's
//! problems are told all at once.

mod range;
mod table;
mod values;

pub use range::Range;
pub use table::Table;

use super::choices::{self, Choice};
use super::document::Document;
use super::problem::{Problem, Problems};
use super::tree::Step;
use std::cell::RefCell;

/// A document being read, what is wrong with it so far, and what was chosen where it says
/// nothing.
#[derive(Debug)]
pub struct Reader<'a> {
    document: &'a Document,
    problems: RefCell<Vec<Problem>>,
    choices: RefCell<Vec<Choice>>,
}

impl<'a> Reader<'a> {
    /// Begin with `document`.
    pub fn new(document: &'a Document) -> Self {
        Self {
            document,
            problems: RefCell::default(),
            choices: RefCell::default(),
        }
    }

    /// The table of the whole document.
    pub fn root(&'a self) -> Table<'a> {
        Table::new(self, Vec::new(), &self.document.root)
    }

    /// The document.
    pub fn document(&self) -> &'a Document {
        self.document
    }

    /// Does the scene say something at `path`?
    pub fn says(&self, path: &[Step]) -> bool {
        let root = Some(&self.document.root);
        path.iter()
            .fold(root, |node, step| node.and_then(|node| node.down(step)))
            .is_some()
    }

    /// The text with all that was chosen in it; only for a document without problems.
    pub fn resolved(&self) -> String {
        choices::resolve(&self.document.text, &self.choices.borrow())
    }

    /// Note `value` as what the resolved text says at `path`.
    pub fn choose(&self, path: &[Step], value: impl Into<toml_edit::Value>) {
        let (path, value) = (path.to_vec(), Some(value.into()));
        self.choices.borrow_mut().push(Choice { path, value });
    }

    /// Has anything been wrong so far?
    pub fn has_problems(&self) -> bool {
        !self.problems.borrow().is_empty()
    }

    /// What was read, if nothing was wrong.
    ///
    /// # Errors
    /// All problems, in the order of the lines.
    ///
    /// # Panics
    /// If nothing was read and yet no problem noted.
    pub fn finish<T>(self, read: Option<T>) -> Result<T, Problems> {
        let mut problems = self.problems.into_inner();
        problems.sort_by_key(|problem| problem.line);
        match read {
            Some(read) if problems.is_empty() => Ok(read),
            None if problems.is_empty() => {
                unreachable!("whatever cannot be read is noted as a problem")
            }
            _ => Err(Problems(problems)),
        }
    }

    /// Note a problem with the key at `path`.
    pub fn wrong(&self, path: &[&str], message: String) {
        let steps: Vec<Step> = path.iter().map(|key| Step::Key((*key).into())).collect();
        self.note(&steps, message);
    }

    /// The same, through lists too.
    pub fn note(&self, path: &[Step], message: String) {
        let problem = self.document.problem(path, message);
        self.problems.borrow_mut().push(problem);
    }

    /// The same, of what several parts of a scene share.
    pub fn note_once(&self, path: &[Step], message: String) {
        let problem = self.document.problem(path, message);
        let mut problems = self.problems.borrow_mut();
        if !problems.contains(&problem) {
            problems.push(problem);
        }
    }
}
