//! One table of a scene: what is there, what is not known, what was chosen.

use super::Reader;
use crate::scene::choices::Choice;
use crate::scene::tree::{Node, Step, Value};
use std::cell::RefCell;

/// One table. When it is dropped, keys that nobody asked for are noted as unknown.
#[derive(Debug)]
pub struct Table<'a> {
    pub(super) reader: &'a Reader<'a>,
    pub(super) path: Vec<Step>,
    entries: &'a [(String, Node)],
    known: RefCell<Vec<&'static str>>,
}

impl Drop for Table<'_> {
    fn drop(&mut self) {
        let known = self.known.borrow();
        for (key, _) in self.entries {
            if !known.contains(&key.as_str()) {
                self.wrong(key, format!("is not known; {}", suggestion(key, &known)));
            }
        }
    }
}

/// The known key nearest to `key`, or all of them.
fn suggestion(key: &str, known: &[&str]) -> String {
    let nearest = known
        .iter()
        .map(|name| (strsim::jaro_winkler(key, name), name))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((alike, name)) if alike > 0.8 => format!("did you mean `{name}`?"),
        _ => format!("here may stand: {}", known.join(", ")),
    }
}

impl<'a> Table<'a> {
    pub(super) fn new(reader: &'a Reader<'a>, path: Vec<Step>, node: &'a Node) -> Self {
        let entries = match &node.value {
            Value::Table(entries) => entries.as_slice(),
            _ => &[],
        };
        Self {
            reader,
            path,
            entries,
            known: RefCell::default(),
        }
    }

    /// Note a problem with `key`.
    pub fn wrong(&self, key: &str, message: String) {
        self.reader.note(&self.path_of(key), message);
    }

    /// Note a problem with this table as a whole.
    pub fn wrong_here(&self, message: String) {
        self.reader.note(&self.path, message);
    }

    /// Note that `key` must be there; `example` is a whole entry.
    pub fn missing(&self, key: &'static str, example: &str) {
        if !self.has(key) {
            self.wrong(key, format!("is missing; write e.g. {example}"));
        }
    }

    /// Is there a value for `key`? It becomes known by the question.
    pub fn has(&self, key: &'static str) -> bool {
        self.node(key).is_some()
    }

    /// Those of `keys` that are there; all become known.
    pub fn present(&self, keys: &[&'static str]) -> Vec<&'static str> {
        keys.iter().copied().filter(|key| self.has(key)).collect()
    }

    /// Note every one of `keys` that is there as out of place, because of `why`.
    pub fn refuse(&self, keys: &[&'static str], why: &str) {
        for key in self.present(keys) {
            self.wrong(key, format!("{why}; remove it"));
        }
    }

    pub(super) fn node(&self, key: &'static str) -> Option<&'a Node> {
        let mut known = self.known.borrow_mut();
        if !known.contains(&key) {
            known.push(key);
        }
        let found = self.entries.iter().find(|(name, _)| name == key);
        found.map(|(_, node)| node)
    }

    /// Is `key` the word `word`?
    pub fn is_word(&self, key: &'static str, word: &str) -> bool {
        matches!(self.node(key), Some(Node { value: Value::Text(text), .. }) if text == word)
    }

    /// Is `key` a table?
    pub fn is_table(&self, key: &'static str) -> bool {
        matches!(
            self.node(key),
            Some(Node {
                value: Value::Table(_),
                ..
            })
        )
    }

    /// Is `key` a list?
    pub fn is_list(&self, key: &'static str) -> bool {
        matches!(
            self.node(key),
            Some(Node {
                value: Value::List(_),
                ..
            })
        )
    }

    /// Note `value` as what the resolved text says at `key`, which is silent or is replaced.
    pub fn choose(&self, key: &'static str, value: impl Into<toml_edit::Value>) {
        self.reader.choose(&self.path_of(key), value);
    }

    /// Note that the resolved text does without `key`.
    pub fn leave_out(&self, key: &'static str) {
        let (path, value) = (self.path_of(key), None);
        self.reader
            .choices
            .borrow_mut()
            .push(Choice { path, value });
    }

    pub(super) fn path_of(&self, key: &str) -> Vec<Step> {
        [&self.path[..], &[Step::Key(key.into())]].concat()
    }

    /// The table of `key`, or an empty one where there is none: what is chosen in it makes it.
    pub fn table_or_empty(&self, key: &'static str, example: &str) -> Option<Self> {
        if self.has(key) {
            return self.table(key, example);
        }
        Some(Self {
            reader: self.reader,
            path: self.path_of(key),
            entries: &[],
            known: RefCell::default(),
        })
    }

    /// The table of `key`; `example` is a whole entry.
    pub fn table(&self, key: &'static str, example: &str) -> Option<Self> {
        let node = self.node(key)?;
        if !matches!(node.value, Value::Table(_)) {
            let found = node.value.describe();
            self.wrong(
                key,
                format!("is {found}, expected a table; write e.g. {example}"),
            );
            return None;
        }
        let path = [&self.path[..], &[Step::Key(key.into())]].concat();
        Some(Self::new(self.reader, path, node))
    }

    /// All tables of the list `key`; `example` says how one begins.
    pub fn tables(&self, key: &'static str, example: &str) -> Vec<Self> {
        let items = self.list(key, example).unwrap_or_default();
        let each = items.iter().enumerate().filter_map(|(k, node)| {
            let path = [&self.path[..], &[Step::Key(key.into()), Step::Item(k)]].concat();
            if matches!(node.value, Value::Table(_)) {
                return Some(Self::new(self.reader, path, node));
            }
            let found = node.value.describe();
            let message = format!("is {found}, expected a table; write e.g. {example}");
            self.reader.note(&path, message);
            None
        });
        each.collect()
    }
}
