//! Do the pages for people name files and folders that exist?

use std::path::Path;

const PAGES: [&str; 2] = ["README.md", "CONTRIBUTING.md"];
/// Folders that builds and runs make; git ignores them.
const MADE: [&str; 2] = ["target", "results"];

#[test]
fn paths_that_the_pages_name_exist() {
    for page in PAGES {
        let paths = named_paths(&read(page));
        assert!(paths.len() > 5, "{page}: found only {paths:?}");
        for path in paths {
            assert!(root().join(&path).exists(), "{page} names {path}");
        }
    }
}

#[test]
fn readme_maps_every_folder() {
    let paths = named_paths(&read("README.md"));
    for entry in root().read_dir().unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let hidden = name.starts_with('.');
        if entry.path().is_dir() && !hidden && !MADE.contains(&name.as_str()) {
            assert!(paths.contains(&format!("{name}/")), "README: no {name}/");
        }
    }
}

/// Code spans that look like paths of the repository, and targets of relative links.
fn named_paths(text: &str) -> Vec<String> {
    let spans = text.split('`').skip(1).step_by(2);
    let links = text.split("](").skip(1).filter_map(|s| s.split(')').next());
    spans
        .filter(|span| span.contains('/') && !MADE.iter().any(|made| span.starts_with(made)))
        .filter(|span| {
            span.chars()
                .all(|c| c.is_alphanumeric() || "/._-".contains(c))
        })
        .chain(links.filter(|link| !link.contains(':')))
        .map(str::to_owned)
        .collect()
}

fn read(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).unwrap()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}
