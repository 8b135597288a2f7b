//! The tree of a TOML text, each node with its line.

use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// A value and the line (from 1) of its key, or of itself within a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Its line in the text.
    pub line: usize,
}

/// A TOML value. Entries of tables are in the order of the text.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "each name says what it is")]
pub enum Value {
    Table(Vec<(String, Node)>),
    List(Vec<Node>),
    Text(String),
    Integer(i64),
    Float(f64),
    Flag(bool),
    Date,
}

/// One step from a table or a list to what is in it.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// To the value of this key.
    Key(String),
    /// To this element, from 0.
    Item(usize),
}

impl Value {
    /// What it is, for error messages.
    pub fn describe(&self) -> String {
        match self {
            Self::Table(_) => "a table".into(),
            Self::List(_) => "a list".into(),
            Self::Text(text) => format!("the text {text:?}"),
            Self::Integer(n) => format!("the number {n}"),
            Self::Float(x) => format!("the number {x}"),
            Self::Flag(flag) => format!("the word {flag}"),
            Self::Date => "a date".into(),
        }
    }
}

impl Node {
    /// The node one step down.
    pub fn down(&self, step: &Step) -> Option<&Self> {
        match (&self.value, step) {
            (Value::Table(entries), Step::Key(key)) => {
                entries.iter().find(|(name, _)| name == key).map(|(_, n)| n)
            }
            (Value::List(items), Step::Item(k)) => items.get(*k),
            _ => None,
        }
    }

    /// The text of `key`, if this is a table that has it.
    pub fn text_of(&self, key: &str) -> Option<&str> {
        match &self.down(&Step::Key(key.into()))?.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// The tree of `text`, as far as it can be understood, and its mistakes of syntax:
/// line and message.
pub fn parse(text: &str) -> (Node, Vec<(usize, String)>) {
    let (table, errors) = DeTable::parse_recoverable(text);
    let root = Node {
        value: table_value(text, table.get_ref()),
        line: 1,
    };
    // One slip makes the reader stumble over what follows: the first of a line tells it.
    let mut slips: Vec<(usize, String)> = errors
        .iter()
        .map(|error| {
            let at = error.span().map_or(1, |span| line(text, &span));
            (at, error.message().to_string())
        })
        .collect();
    slips.sort_by_key(|slip| slip.0);
    slips.dedup_by_key(|slip| slip.0);
    (root, slips)
}

fn line(text: &str, span: &Range<usize>) -> usize {
    let before = &text.as_bytes()[..span.start.min(text.len())];
    1 + before.iter().filter(|&&c| c == b'\n').count()
}

fn table_value(text: &str, table: &DeTable) -> Value {
    let mut entries: Vec<(usize, String, Node)> = table
        .iter()
        .map(|(key, value)| {
            let node = Node {
                value: value_of(text, value.get_ref()),
                line: line(text, &key.span()),
            };
            (key.span().start, key.get_ref().to_string(), node)
        })
        .collect();
    entries.sort_by_key(|(start, _, _)| *start);
    Value::Table(entries.into_iter().map(|(_, k, n)| (k, n)).collect())
}

fn value_of(text: &str, value: &DeValue) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        // A number beyond 64 bits becomes a float, whose size is then refused by name.
        DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).map_or_else(
            |_| Value::Float(n.as_str().parse().unwrap_or(f64::INFINITY)),
            Value::Integer,
        ),
        DeValue::Float(x) => Value::Float(x.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(items) => Value::List(
            items
                .iter()
                .map(|item| Node {
                    value: value_of(text, item.get_ref()),
                    line: line(text, &item.span()),
                })
                .collect(),
        ),
        DeValue::Table(table) => table_value(text, table),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_know_their_lines() {
        let (root, slips) = parse("a = 1\n[t]\nb = [\n 1,\n 2]\n[[p]]\nc = 'x'\n[[p]]\nc = 'y'\n");
        assert!(slips.is_empty());
        let at = |steps: &[Step]| {
            let found = steps.iter().try_fold(&root, |node, step| node.down(step));
            found.unwrap().line
        };
        let key = |k: &str| Step::Key(k.into());
        assert_eq!(at(&[key("a")]), 1);
        assert_eq!(at(&[key("t")]), 2);
        assert_eq!(at(&[key("t"), key("b"), Step::Item(1)]), 5);
        assert_eq!(at(&[key("p"), Step::Item(1)]), 8);
        assert_eq!(at(&[key("p"), Step::Item(1), key("c")]), 9);
    }

    #[test]
    fn all_slips_are_found() {
        let (_, slips) = parse("a = \nb = 1\nb = 2\nc = \"x\n");
        let lines: Vec<usize> = slips.iter().map(|slip| slip.0).collect();
        assert_eq!(lines, [1, 3, 4]);
    }
}
