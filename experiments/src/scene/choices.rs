//! What was chosen where a scene says nothing, and the text that says it all.

use super::tree::Step;
use toml_edit::{DocumentMut, InlineTable, Item, TableLike, Value};

/// One thing that the resolved text says otherwise than the scene.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Where it stands.
    pub path: Vec<Step>,
    /// What is to stand there; none: nothing any more.
    pub value: Option<Value>,
}

/// `text`, a scene that was read without problems, with all `choices` in it. Keys that come
/// anew carry the comment `chosen`, where a comment may stand.
pub fn resolve(text: &str, choices: &[Choice]) -> String {
    let mut document: DocumentMut = text.parse().expect("the text was parsed before");
    for Choice { path, value } in choices {
        let (Step::Key(first), rest) = path.split_first().expect("a path has steps") else {
            unreachable!("a document is a table");
        };
        let root = document.as_table_mut();
        if rest.is_empty() {
            put(root, first, value.clone(), true);
        } else {
            let below = root.entry(first).or_insert_with(toml_edit::table);
            descend(below, rest, value.clone());
        }
    }
    document.to_string()
}

fn descend(item: &mut Item, path: &[Step], value: Option<Value>) {
    match (item, path) {
        (Item::Value(inner), _) => descend_value(inner, path, value),
        (Item::ArrayOfTables(list), [Step::Item(k), rest @ ..]) => {
            let table = list.get_mut(*k).expect("the scene was read from this text");
            descend_table(table, rest, value);
        }
        (Item::Table(table), path) => descend_table(table, path, value),
        _ => unreachable!("the scene was read from this text"),
    }
}

fn descend_table(table: &mut toml_edit::Table, path: &[Step], value: Option<Value>) {
    match path {
        [Step::Key(key)] => put(table, key, value, true),
        [Step::Key(key), rest @ ..] => {
            let new = || Item::Value(InlineTable::new().into());
            descend(table.entry(key).or_insert_with(new), rest, value);
        }
        _ => unreachable!("a table has keys"),
    }
}

fn descend_value(inner: &mut Value, path: &[Step], value: Option<Value>) {
    match (inner, path) {
        (Value::InlineTable(table), [Step::Key(key)]) => {
            make_room_behind(table);
            put(table, key, value, false);
        }
        (Value::InlineTable(table), [Step::Key(key), rest @ ..]) => {
            if !table.contains_key(key) {
                make_room_behind(table);
            }
            let below = table.entry(key).or_insert(InlineTable::new().into());
            descend_value(below, rest, value);
        }
        (Value::Array(list), [Step::Item(k), rest @ ..]) => match list.get_mut(*k) {
            Some(item) => descend_value(item, rest, value),
            None => list.extend(value),
        },
        _ => unreachable!("the scene was read from this text"),
    }
}

/// The blank before a closing brace belongs to the last value, which will be the last no more.
fn make_room_behind(table: &mut InlineTable) {
    if let Some((_, last)) = table.iter_mut().last()
        && last.decor().suffix().and_then(|raw| raw.as_str()) == Some(" ")
    {
        last.decor_mut().set_suffix("");
    }
}

/// Put `value` at `key` of a table, in place of what is there, or take that away.
fn put(table: &mut dyn TableLike, key: &str, value: Option<Value>, comments: bool) {
    let Some(mut value) = value else {
        table.remove(key);
        return;
    };
    match table.get(key).and_then(Item::as_value) {
        Some(old) => *value.decor_mut() = old.decor().clone(),
        None if comments => value.decor_mut().set_suffix("  # chosen"),
        None => {}
    }
    table.insert(key, Item::Value(value));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choice(path: &[&str], value: impl Into<Value>) -> Choice {
        let step = |word: &&str| {
            word.parse()
                .map_or_else(|_| Step::Key((*word).into()), Step::Item)
        };
        Choice {
            path: path.iter().map(step).collect(),
            value: Some(value.into()),
        }
    }

    #[test]
    fn choices_stand_where_the_scene_was_silent() {
        let text = "a = [1] # one\n[t]\nx = { y = 2 }\n[[p]]\nname = \"q\"\n[[p]]\nz = { u = 1 }\n";
        let mut choices = vec![
            choice(&["seed"], 1),
            choice(&["a", "1"], 5),
            choice(&["t", "x", "w", "v"], "3 m"),
            choice(&["p", "0", "s", "k"], true),
            choice(&["p", "1", "z", "v"], 4),
            choice(&["new", "in", "one"], 0.5),
        ];
        choices.push(Choice {
            value: None,
            ..choice(&["p", "1", "z", "u"], 0)
        });
        let expected = "\
            a = [1, 5] # one\n\
            seed = 1  # chosen\n\
            [t]\n\
            x = { y = 2, w = { v = \"3 m\" } }\n\
            [[p]]\n\
            name = \"q\"\n\
            s = { k = true }\n\
            [[p]]\n\
            z = { v = 4 }\n\
            \n\
            [new]\n\
            in = { one = 0.5 }\n";
        assert_eq!(resolve(text, &choices), expected);
    }

    #[test]
    fn lists_of_inline_tables_are_lists_too() {
        let choices = [choice(&["p", "1", "z"], 4)];
        let resolved = resolve("p = [{ a = 1 }, { a = 2 }]\n", &choices);
        assert_eq!(resolved, "p = [{ a = 1 }, { a = 2, z = 4 }]\n");
    }
}
