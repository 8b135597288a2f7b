//! What keys of a table say: quantities, numbers, words, lists.

use super::{Range, Table};
use crate::scene::tree::{Node, Step, Value};
use crate::scene::units::Kind;
use std::path::PathBuf;

impl<'a> Table<'a> {
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

    pub(super) fn list(&self, key: &'static str, example: &str) -> Option<&'a [Node]> {
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
