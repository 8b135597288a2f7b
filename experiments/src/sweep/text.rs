//! The scenes of single runs, made from the resolved text of a whole one.

use crate::scene::units::TIME;
use toml_edit::{DocumentMut, InlineTable, Item, Table, Value, value};

/// The scene of phase number `phase` alone; `state`: the file that it starts from, if it is not the
/// first one.
pub fn of_phase(resolved: &str, phase: usize, state: Option<&str>) -> String {
    let mut scene: DocumentMut = parsed(resolved);
    let mut number = 0..;
    let mut keep = || number.next() == Some(phase);
    match &mut scene["phase"] {
        Item::ArrayOfTables(list) => list.retain(|_| keep()),
        Item::Value(Value::Array(list)) => list.retain(|_| keep()),
        _ => unreachable!("the scene was read, so it has phases"),
    }
    if let Some(state) = state {
        start_from(&mut scene, state);
    }
    scene.to_string()
}

/// The scene of one phase that goes on from its own middle.
pub fn going_on(one_phase: &str, state: &str) -> String {
    let mut scene = parsed(one_phase);
    start_from(&mut scene, state);
    match &mut scene["phase"] {
        Item::ArrayOfTables(list) => {
            let phase = list.get_mut(0).expect("it has one phase");
            phase.insert("start", value("keep"));
        }
        Item::Value(Value::Array(list)) => {
            let phase = list.get_mut(0).and_then(Value::as_inline_table_mut);
            phase
                .expect("it has one phase")
                .insert("start", "keep".into());
        }
        _ => unreachable!("the scene was read, so it has phases"),
    }
    scene.to_string()
}

/// The scene of water alone that goes on for the time that is `left` [s].
pub fn water_going_on(text: &str, state: &str, left: f64) -> String {
    let mut scene = parsed(text);
    let mut start = InlineTable::new();
    start.insert("state", state.into());
    let water = scene["water"].as_table_like_mut();
    water
        .expect("the scene was read")
        .insert("start", value(start));
    let end = scene["end"]
        .as_table_like_mut()
        .expect("the scene was read");
    let key = match end.contains_key("max_duration") {
        true => "max_duration",
        false => "duration",
    };
    end.insert(key, value(TIME.write(left)));
    scene.to_string()
}

fn parsed(text: &str) -> DocumentMut {
    text.parse().expect("the text was read as a scene before")
}

/// Grains from `state`, which knows its box.
fn start_from(scene: &mut DocumentMut, state: &str) {
    let mut grains = Table::new();
    grains.insert("state", value(state));
    scene.insert("grains", Item::Table(grains));
    if let Some(bounds) = scene.get_mut("box").and_then(Item::as_table_like_mut) {
        bounds.remove("size");
    }
}
