//! The same bed, sheared in the same way by LAMMPS.

use super::Length;
use super::case::Bed;
use super::numbers::Numbers;
use super::packing::Packing;
use super::report::Sample;
use anyhow::{Context, Result, ensure};
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Neighbour skins that are tried (m).
const SKINS: [f64; 4] = [1e-4, 2e-4, 5e-4, 1e-3];

/// How LAMMPS computes contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    /// `gran/hooke/history`: its fastest law with tangential history.
    HookeHistory,
    /// `granular`: damping in N s/m as in the poster.
    Granular,
}

/// One law of LAMMPS on one packing, with the skin that is best for both.
pub struct Lammps {
    numbers: Numbers,
    style: Style,
    ranks: usize,
    grains: usize,
    height: f64,
    layer: f64,
    skin: f64,
    folder: TempDir,
}

/// Is LAMMPS here, and a way to start several ranks if `parallel`?
pub fn check_installed(parallel: bool) -> Result<()> {
    let programs: &[&str] = if parallel {
        &["lmp", "mpirun"]
    } else {
        &["lmp"]
    };
    for program in programs {
        let found = Command::new(program)
            .arg(if *program == "lmp" { "-h" } else { "--version" })
            .stdin(Stdio::null())
            .output();
        found.with_context(|| {
            format!(
                "--with-lammps: cannot start `{program}`; on Debian and Ubuntu: \
                 apt install lammps openmpi-bin"
            )
        })?;
    }
    Ok(())
}

impl Lammps {
    /// Both laws on `bed`, each with the best of a few skins.
    pub fn all(bed: &Bed, ranks: usize, length: Length) -> Result<Vec<Self>> {
        let Bed { packing, numbers } = bed;
        let tuned = [Style::HookeHistory, Style::Granular].map(|style| {
            let folder = TempDir::with_prefix("esker-bench-")?;
            std::fs::write(
                folder.path().join("bed.data"),
                data(packing, numbers.density)?,
            )?;
            let mut peer = Self {
                numbers: *numbers,
                style,
                ranks,
                grains: packing.len(),
                height: packing.height,
                layer: packing.layer,
                skin: SKINS[0],
                folder,
            };
            let mut best = (0.0, peer.skin);
            for skin in SKINS {
                peer.skin = skin;
                let speed = peer.run(length)?.grain_steps_per_s;
                if speed > best.0 {
                    best = (speed, skin);
                }
            }
            peer.skin = best.1;
            Ok(peer)
        });
        tuned.into_iter().collect()
    }

    /// Name in tables and files.
    pub fn name(&self) -> String {
        let style = match self.style {
            Style::HookeHistory => "gran/hooke/history",
            Style::Granular => "granular",
        };
        format!("{style}, skin {:e} m", self.skin)
    }

    /// One measurement.
    pub fn run(&self, length: Length) -> Result<Sample> {
        let folder = self.folder.path();
        std::fs::write(folder.join("in.shear"), self.input(length)?)?;
        let mut command = if self.ranks == 1 {
            Command::new("lmp")
        } else {
            let mut mpi = Command::new("mpirun");
            mpi.args(["-np", &self.ranks.to_string(), "lmp"]);
            // Open MPI refuses root, and more ranks than cores, unless told otherwise.
            mpi.envs([
                ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
                ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
                ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
            ]);
            mpi
        };
        let output = command
            .args(["-in", "in.shear", "-log", "log", "-screen", "none"])
            .current_dir(folder)
            .stdin(Stdio::null())
            .output()?;
        ensure!(
            output.status.success(),
            "LAMMPS stopped: {}",
            complaint(folder, &output.stderr)
        );
        let log = std::fs::read_to_string(folder.join("log"))?;
        read(&log, self.grains, self.ranks, length)
            .context("cannot find the timing in the log of LAMMPS")
    }

    /// The script: planes held, layers held and driven, linear profile, as in `case.rs`.
    fn input(&self, length: Length) -> Result<String> {
        let (height, layer) = (self.height, self.layer);
        let Numbers {
            law,
            sliding,
            step,
            strain_rate,
            density,
        } = self.numbers;
        let (k_n, damping_n) = (law.normal_stiffness, law.normal_damping);
        let (k_t, damping_t, mu) = (sliding.stiffness, sliding.damping, sliding.friction_static);
        let law = match self.style {
            Style::HookeHistory => {
                // Its damping is a rate, times the effective mass: m/2 of two mean grains, m at
                // a plane. Its friction has one coefficient.
                let mass = density * 4.0 / 3.0 * std::f64::consts::PI * 0.01_f64.powi(3);
                let [pair_n, pair_t] = [damping_n, damping_t].map(|c| c / (0.5 * mass));
                let wall = damping_n / mass;
                format!(
                    "pair_style gran/hooke/history {k_n:e} {k_t:e} {pair_n} {pair_t} {mu} 1\n\
                     pair_coeff * *\n\
                     fix wall all wall/gran hooke/history {k_n:e} 0.0 {wall} 0.0 0.0 0 \
                     zplane 0.0 {height}\n"
                )
            }
            Style::Granular => format!(
                "pair_style granular\n\
                 pair_coeff * * hooke {k_n:e} {damping_n} damping velocity \
                 tangential linear_history {k_t:e} {ratio} {mu}\n\
                 fix wall all wall/gran granular hooke {k_n:e} {damping_n} damping velocity \
                 tangential linear_nohistory 0.0 0.0 zplane 0.0 {height}\n",
                // It wants the tangential dashpot in units of the normal one.
                ratio = damping_t / damping_n
            ),
        };
        let (skin, speed) = (self.skin, strain_rate * height);
        let Length { warm_up, steps } = length;
        let mut text = String::new();
        write!(
            text,
            "units si\n\
             atom_style sphere\n\
             boundary p p f\n\
             newton off\n\
             comm_modify vel yes\n\
             processors * * 1\n\
             read_data bed.data\n\
             neighbor {skin} bin\n\
             neigh_modify delay 0 every 1 check yes\n\
             {law}\
             region bottom block INF INF INF INF INF {layer}\n\
             region top block INF INF INF INF {top} INF\n\
             group bottom region bottom\n\
             group top region top\n\
             fix motion all nve/sphere\n\
             fix held bottom setforce 0 0 NULL\n\
             fix driven top setforce 0 0 NULL\n\
             velocity all ramp vx 0 {speed} z 0.0 {height} units box\n\
             velocity top set {speed} 0 NULL\n\
             velocity bottom set 0 0 NULL\n\
             compute contacts all contact/atom\n\
             compute mean all reduce ave c_contacts\n\
             timestep {step}\n\
             thermo 1000000\n\
             run {warm_up}\n\
             run {steps}\n\
             thermo_style custom step c_mean\n\
             run 0\n\
             print \"coordination $(c_mean)\"\n",
            top = height - layer
        )?;
        Ok(text)
    }
}

/// The packing as a data file.
fn data(packing: &Packing, density: f64) -> Result<String> {
    let [lx, ly] = packing.size;
    let mut text = String::new();
    write!(
        text,
        "a dense bed\n\n{} atoms\n1 atom types\n\n\
         0 {lx} xlo xhi\n0 {ly} ylo yhi\n-0.01 {zhi} zlo zhi\n\nAtoms\n\n",
        packing.len(),
        zhi = packing.height + 0.01
    )?;
    for (k, (p, radius)) in packing.position.iter().zip(&packing.radius).enumerate() {
        let (id, diameter) = (k + 1, 2.0 * radius);
        writeln!(text, "{id} 1 {diameter} {density} {} {} {}", p.x, p.y, p.z)?;
    }
    Ok(text)
}

/// Timing and memory of the second run in the log; `None` if something is missing there.
fn read(log: &str, grains: usize, ranks: usize, length: Length) -> Option<Sample> {
    let numbers = |start: &str, nth: usize| -> Option<Vec<f64>> {
        let line = log.lines().filter_map(|l| l.strip_prefix(start)).nth(nth)?;
        Some(line.split_whitespace().flat_map(str::parse).collect())
    };
    let seconds = *numbers("Loop time of", 1)?.first()?;
    let coordination_number = *numbers("coordination", 0)?.first()?;
    let [_min, megabytes, _max] = numbers("Per MPI rank memory allocation", 1)?[..] else {
        return None;
    };
    let grains = grains as f64;
    Some(Sample {
        grain_steps_per_s: grains * length.steps as f64 / seconds,
        coordination_number: Some(coordination_number),
        bytes_per_grain: megabytes * 1024.0 * 1024.0 * ranks as f64 / grains,
    })
}

/// What LAMMPS or MPI said when it failed.
fn complaint(folder: &Path, stderr: &[u8]) -> String {
    let log = std::fs::read_to_string(folder.join("log")).unwrap_or_default();
    let error = log.lines().find(|line| line.starts_with("ERROR"));
    error.map_or_else(
        || String::from_utf8_lossy(stderr).trim().to_owned(),
        str::to_owned,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_log_is_read_from_its_second_run() {
        let log = "\
            Per MPI rank memory allocation (min/avg/max) = 1 | 1 | 1 Mbytes\n\
            Loop time of 9 on 2 procs for 300 steps with 1000 atoms\n\
            Per MPI rank memory allocation (min/avg/max) = 1.5 | 2 | 2.5 Mbytes\n\
            Loop time of 0.5 on 2 procs for 6000 steps with 1000 atoms\n\
            Per MPI rank memory allocation (min/avg/max) = 3 | 3 | 3 Mbytes\n\
            coordination 4.09\n";
        let length = Length {
            warm_up: 300,
            steps: 6000,
        };
        let sample = read(log, 1000, 2, length).unwrap();
        assert_eq!(sample.grain_steps_per_s, 12e6);
        assert_eq!(sample.coordination_number, Some(4.09));
        assert_eq!(sample.bytes_per_grain, 4.0 * 1024.0 * 1024.0 / 1000.0);
        assert!(read("ERROR: Unknown pair style", 1000, 2, length).is_none());
    }
}
