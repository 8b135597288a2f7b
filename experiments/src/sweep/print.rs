//! The runs as commands for other programs to start.

use super::plan::Plan;
use std::fmt::Write;
use std::path::Path;

/// The command of each run, phase by phase: those of one phase may run at the same time, and need
/// those of the phase before. The last one collects.
pub fn commands(plan: &Plan, folder: &Path, threads: usize) -> String {
    let out = quoted(folder);
    let mut text = String::new();
    for (phase, names) in by_phase(plan).iter().enumerate() {
        let when = if phase > 0 {
            ", once those above are done"
        } else {
            ""
        };
        let _ = writeln!(text, "# {} at the same time{when}", names.len());
        for name in names {
            let _ = writeln!(
                text,
                "esker sweep --out {out} --only {name} --threads {threads}"
            );
        }
    }
    let _ = writeln!(text, "# at last\nesker sweep --out {out} --collect");
    text
}

/// A shell script that hands one array of jobs for each phase to Slurm, and collects at last.
///
/// An array waits for the one before it to end, with failures or without: what failed is told by
/// the job that collects.
pub fn slurm(plan: &Plan, folder: &Path, threads: usize) -> String {
    let out = quoted(folder);
    let mut text = String::from(
        "#!/bin/bash\n\
         # Hands the sweep to Slurm: bash THIS_FILE [OPTIONS OF sbatch, such as --time=2:00:00]\n\
         # One array of jobs a phase. To go on after a time limit or a failure, run it again: what\n\
         # is done ends at once.\n\
         set -euo pipefail\n\
         after=\n\
         submit() { sbatch --parsable ${after:+--dependency=afterany:$after} \"$@\"; }\n",
    );
    for names in by_phase(plan) {
        let (most, list) = (names.len() - 1, names.join(" "));
        let _ = write!(
            text,
            "after=$(submit --job-name=esker --array=0-{most} --cpus-per-task={threads} \"$@\" <<'JOB'\n\
             #!/bin/bash\n\
             names=({list})\n\
             esker sweep --out {out} --only \"${{names[$SLURM_ARRAY_TASK_ID]}}\" --threads {threads}\n\
             JOB\n\
             )\n"
        );
    }
    let _ = write!(
        text,
        "submit --job-name=esker \"$@\" <<'JOB'\n\
         #!/bin/bash\n\
         esker sweep --out {out} --collect\n\
         JOB\n"
    );
    text
}

/// Names of the runs of each phase that has some.
fn by_phase(plan: &Plan) -> Vec<Vec<&str>> {
    let count = plan.phases.len().max(1);
    let of = |phase| {
        let runs = plan.runs.iter().filter(move |run| run.phase == phase);
        runs.map(|run| run.name.as_str()).collect()
    };
    (0..count).map(of).collect()
}

/// A path as a shell reads it.
fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    match text.chars().all(plain) {
        true => text,
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}
