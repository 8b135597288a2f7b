//! Reads tables key by key. Every problem is noted and reading goes on, so that a file's
//! problems are told all at once.

use super::choices::{self, Choice};
use super::document::Document;
use super::problem::{Problem, Problems};
use super::tree::{Node, Step, Value};
use super::units::Kind;
use std::cell::RefCell;
use std::path::PathBuf;

/// A document being read, what is wrong with it so far, and what was chosen where it says
/// nothing.
#[derive(Debug)]
pub struct Reader<'a> {
    document: &'a Document,
    problems: RefCell<Vec<Problem>>,
    choices: RefCell<Vec<Choice>>,
}

/// Which numbers are possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Every finite number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// Above the first, at most the second.
    Above(f64, f64),
    /// From the first to the second, in SI units: beyond them there is no such thing.
    Within(f64, f64),
}

impl Range {
    fn broken_by(self, x: f64) -> Option<String> {
        if !x.is_finite() {
            return Some("must be a finite number".into());
        }
        let fine = match self {
            Self::Any => true,
            Self::Positive => x > 0.0,
            Self::NotNegative => x >= 0.0,
            Self::Above(low, high) => x > low && x <= high,
            Self::Within(low, high) => (low..=high).contains(&x),
        };
        (!fine).then(|| match self {
            Self::Any => unreachable!("every finite number is fine"),
            Self::Positive => "must be above zero".into(),
            Self::NotNegative => "must not be negative".into(),
            Self::Above(low, high) => format!("must be above {low} and at most {high}"),
            Self::Within(low, high) => format!("must be from {low:e} to {high:e}"),
        })
    }
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
}

/// One table. When it is dropped, keys that nobody asked for are noted as unknown.
#[derive(Debug)]
pub struct Table<'a> {
    reader: &'a Reader<'a>,
    path: Vec<Step>,
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
    fn new(reader: &'a Reader<'a>, path: Vec<Step>, node: &'a Node) -> Self {
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

    fn node(&self, key: &'static str) -> Option<&'a Node> {
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

    /// Text of `key`.
    pub fn text(&self, key: &'static str) -> Option<&'a str> {
        match &self.node(key)?.value {
            Value::Text(text) => Some(text),
            other => {
                let found = other.describe();
                self.wrong(key, format!("is {found}; write text, e.g. {key} = \"...\""));
                None
            }
        }
    }

    /// The file that `key` names, from the folder of the scene; the resolved text, which may be
    /// read from another folder, says where it is.
    pub fn path(&self, key: &'static str) -> Option<PathBuf> {
        let located = self.reader.document().locate(self.text(key)?);
        let (path, said) = located
            .map_err(|error| self.wrong(key, format!("cannot be read: {error:#}")))
            .ok()?;
        self.choose(key, said);
        Some(path)
    }

    /// Quantity of `key` in SI units.
    pub fn quantity(&self, key: &'static str, kind: &Kind, range: Range) -> Option<f64> {
        let node = self.node(key)?;
        let read = quantity(&node.value, kind, range);
        read.map_err(|what| {
            self.wrong(
                key,
                format!("{what}; write e.g. {key} = {:?}", kind.example),
            )
        })
        .ok()
    }

    /// A list of quantities; each element that is wrong is noted.
    pub fn quantities(&self, key: &'static str, kind: &Kind, range: Range) -> Option<Vec<f64>> {
        let items = self.list(
            key,
            &format!("{key} = [{:?}, {:?}]", kind.example, kind.example),
        )?;
        let each = items.iter().enumerate().map(|(k, item)| {
            quantity(&item.value, kind, range)
                .map_err(|what| {
                    let path = [&self.path[..], &[Step::Key(key.into()), Step::Item(k)]].concat();
                    let message = format!("{what}; write e.g. {:?}", kind.example);
                    self.reader.note(&path, message);
                })
                .ok()
        });
        each.collect::<Vec<_>>().into_iter().collect()
    }

    /// Quantity of `key` in SI units, or `default` [SI], which is then chosen.
    pub fn quantity_or(&self, key: &'static str, kind: &Kind, range: Range, default: f64) -> f64 {
        if !self.has(key) {
            self.choose(key, kind.write(default));
        }
        self.quantity(key, kind, range).unwrap_or(default)
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

    fn path_of(&self, key: &str) -> Vec<Step> {
        [&self.path[..], &[Step::Key(key.into())]].concat()
    }

    /// Plain number of `key`; `example` is one that fits.
    pub fn number(&self, key: &'static str, range: Range, example: &str) -> Option<f64> {
        let read = match &self.node(key)?.value {
            Value::Float(x) => Ok(*x),
            Value::Integer(n) => Ok(*n as f64),
            other => Err(format!("is {}, expected a plain number", other.describe())),
        };
        let read = read.and_then(|x| {
            let broken = range.broken_by(x);
            broken.map_or(Ok(x), |why| Err(format!("is {x}, {why}")))
        });
        read.map_err(|what| self.wrong(key, format!("{what}; write e.g. {key} = {example}")))
            .ok()
    }

    /// A list of plain numbers.
    pub fn numbers(&self, key: &'static str, range: Range, example: &str) -> Option<Vec<f64>> {
        let items = self.list(key, example)?;
        let each = items.iter().map(|item| match item.value {
            Value::Float(x) if range.broken_by(x).is_none() => Some(x),
            Value::Integer(n) if range.broken_by(n as f64).is_none() => Some(n as f64),
            _ => None,
        });
        let all: Option<Vec<f64>> = each.collect();
        if all.is_none() {
            self.wrong(
                key,
                format!("has an entry that cannot be; write e.g. {example}"),
            );
        }
        all
    }

    /// A whole number of at least `least`.
    pub fn integer(&self, key: &'static str, least: i64, example: &str) -> Option<i64> {
        let what = match &self.node(key)?.value {
            Value::Integer(n) if *n >= least => return Some(*n),
            Value::Integer(n) => format!("is {n}, must be {least} or more"),
            other => format!("is {}, expected a whole number", other.describe()),
        };
        self.wrong(key, format!("{what}; write e.g. {key} = {example}"));
        None
    }

    /// One of `words`, with its meaning.
    pub fn choice<T: Copy>(&self, key: &'static str, words: &[(&str, T)]) -> Option<T> {
        let node = self.node(key)?;
        if let Value::Text(text) = &node.value
            && let Some((_, meaning)) = words.iter().find(|(word, _)| word == text)
        {
            return Some(*meaning);
        }
        let all: Vec<String> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
        let all = all.join(" or ");
        let found = node.value.describe();
        self.wrong(key, format!("is {found}; write {key} = {all}"));
        None
    }

    /// One of `words`, or `default`, which is then chosen.
    pub fn choice_or<T: Copy + PartialEq>(
        &self,
        key: &'static str,
        words: &[(&str, T)],
        default: T,
    ) -> T {
        if !self.has(key) {
            let (word, _) = words
                .iter()
                .find(|(_, meaning)| *meaning == default)
                .expect("a default has a word");
            self.choose(key, *word);
        }
        self.choice(key, words).unwrap_or(default)
    }

    /// True or false, or `default`, which is then chosen.
    pub fn flag_or(&self, key: &'static str, default: bool) -> bool {
        match self.node(key).map(|node| &node.value) {
            None => self.choose(key, default),
            Some(Value::Flag(flag)) => return *flag,
            Some(other) => {
                let found = other.describe();
                self.wrong(key, format!("is {found}; write {key} = true or false"));
            }
        }
        default
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

    /// A list of texts.
    pub fn texts(&self, key: &'static str, example: &str) -> Option<Vec<&'a str>> {
        let items = self.list(key, example)?;
        let each = items.iter().map(|item| match &item.value {
            Value::Text(text) => Some(text.as_str()),
            _ => None,
        });
        let all: Option<Vec<&str>> = each.collect();
        if all.is_none() {
            self.wrong(
                key,
                format!("holds something else than text; write e.g. {example}"),
            );
        }
        all
    }

    fn list(&self, key: &'static str, example: &str) -> Option<&'a [Node]> {
        match &self.node(key)?.value {
            Value::List(items) => Some(items),
            other => {
                let found = other.describe();
                self.wrong(
                    key,
                    format!("is {found}, expected a list; write e.g. {example}"),
                );
                None
            }
        }
    }
}

fn quantity(value: &Value, kind: &Kind, range: Range) -> Result<f64, String> {
    let text = match value {
        Value::Text(text) => text,
        Value::Float(_) | Value::Integer(_) => {
            return Err(format!("is {} without a unit", value.describe()));
        }
        other => return Err(format!("is {}, expected {}", other.describe(), kind.what)),
    };
    let x = kind.read(text)?;
    match range.broken_by(x) {
        Some(why) if matches!(range, Range::Within(..)) => {
            Err(format!("is {text:?}, {why} {}", kind.unit))
        }
        Some(why) => Err(format!("is {text:?}, {why}")),
        None => Ok(x),
    }
}
