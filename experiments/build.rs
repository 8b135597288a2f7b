//! Tells the program which commit it was built from.

use std::process::Command;

fn main() {
    // Cargo runs this again after a commit or a checkout, which write the log of HEAD, and
    // after a change of the sources, which may make them differ from the commit.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
    for sources in ["src", "../dem/src", "../lbm/src"] {
        println!("cargo::rerun-if-changed={sources}");
    }
    let commit = git(&[
        "describe",
        "--always",
        "--dirty=+",
        "--abbrev=12",
        "--exclude=*",
    ]);
    let commit = commit.as_deref().unwrap_or("unknown");
    println!("cargo::rustc-env=ESKER_COMMIT={commit}");
}

/// What git answers; `None` without git or outside a repository.
fn git(arguments: &[&str]) -> Option<String> {
    let answer = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(answer.stdout).ok()?;
    answer.status.success().then(|| text.trim().to_string())
}
