//! Every scene in `bad/` carries what is wrong with it: a comment `#^ PATH: MESSAGE` below
//! the line in question. A file must give exactly these problems, all at once.

use experiments::scene::{AnyScene, Document};
use std::fs;
use std::path::Path;

/// Line and text of each expected problem.
fn expected(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut line = 0;
    for (k, content) in text.lines().enumerate() {
        match content.trim_start().strip_prefix("#^") {
            Some(problem) => found.push((line, problem.trim().to_string())),
            None => line = k + 1,
        }
    }
    found
}

fn actual(name: &str, folder: &Path, text: &str) -> Vec<(usize, String)> {
    let scene = Document::new(name, folder, text, &[]).and_then(|d| AnyScene::read(&d));
    let problems = scene.err().map(|problems| problems.0).unwrap_or_default();
    let each = problems.iter().map(|problem| {
        let place = format!("{name}:{}: ", problem.line);
        let text = problem.to_string();
        let rest = text.strip_prefix(&place).expect("the place is file:line");
        (problem.line, rest.to_string())
    });
    each.collect()
}

#[test]
fn wrong_scenes_are_refused_with_all_their_problems() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/bad");
    let mut files: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    assert!(files.len() >= 10, "where are the wrong scenes?");
    let mut wrong = String::new();
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap();
        let text = fs::read_to_string(&file).unwrap();
        let (mut expected, mut actual) = (expected(&text), actual(name, &folder, &text));
        assert!(!expected.is_empty(), "{name} expects nothing");
        expected.sort();
        actual.sort();
        for (line, text) in actual.iter().filter(|p| !expected.contains(p)) {
            wrong += &format!("{name}:{line}: not expected\n#^ {text}\n");
        }
        for (line, text) in expected.iter().filter(|p| !actual.contains(p)) {
            wrong += &format!("{name}:{line}: did not come\n#^ {text}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
