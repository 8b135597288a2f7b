//! The statistics of `validation/plane_shear.rs`, on the GPU: bulk friction and solid fraction of 1000
//! sheared spheres, in the same bands.
//!
//! In software a run takes minutes, so it is asked for:
//! `cargo test --release -p tests --test gpu -- --ignored --nocapture shear_as`
//!
//! Measured on lavapipe (four to five minutes each at I = 0.01, fifteen at 0.003):
//!
//! | friction of grains | I     | seed | τ/σ           | solid fraction  |
//! |--------------------|-------|------|---------------|-----------------|
//! | 0.3                | 0.01  | 1    | 0.351 ± 0.006 | 0.5955 ± 0.0003 |
//! | 0.3                | 0.01  | 2    | 0.347 ± 0.007 | 0.5930 ± 0.0013 |
//! | 0.5                | 0.01  | 1    | 0.361 ± 0.009 | 0.5835 ± 0.0006 |
//! | 0.5                | 0.003 | 1    | 0.355 ± 0.005 | 0.5900 ± 0.0010 |

use crate::lab::Suite;
use dem::gpu;
use shaders::Device;
use tests::bed::Bed;
use tests::packing::solid_fraction;
use tests::steps_to;

pub fn list(suite: &mut Suite) {
    suite.long("grains_of_friction_0_3_shear_as_independent_runs_do", |d| {
        compare(d, MU_0_3, 0.01, 1);
    });
    suite.long("grains_of_friction_0_5_shear_as_independent_runs_do", |d| {
        compare(d, MU_0_5, 0.01, 1);
    });
    suite.long("and_those_of_friction_0_3_from_another_seed", |d| {
        compare(d, MU_0_3, 0.01, 2);
    });
    suite.long("and_those_of_friction_0_5_at_a_third_of_the_rate", |d| {
        compare(d, MU_0_5, 0.003, 1);
    });
}

/// Friction of the grains; bulk friction and solid fraction of independent runs.
type Reference = (f64, [f64; 2]);
const MU_0_3: Reference = (0.3, [0.34, 0.596]);
const MU_0_5: Reference = (0.5, [0.355, 0.588]);

/// Half the width of the bands of friction and fraction, for three strains.
const BANDS: [f64; 2] = [0.03, 0.01];

/// As the CPU's: to a strain of one, then means over a further one in ten blocks. The scatter of the
/// shorter mean adds in squares, three standard errors of its own.
fn compare(device: &Device, (mu, expected): Reference, inertial: f64, seed: u64) {
    let (model, start) = Bed::new(1000, 8.0, mu, seed).sheared(inertial);
    let mut solver = gpu::Solver::new(device, model, start).unwrap();
    let model = solver.model().clone();
    solver.advance(steps_to(1.0 / inertial, &model)).unwrap();
    let (blocks, readings) = (10, 5);
    let steps = steps_to(1.0 / inertial / f64::from(blocks * readings), &model);
    let mut found = [vec![], vec![]];
    for _ in 0..blocks {
        let before = solver.snapshot().unwrap().sums;
        let mut filled = 0.0;
        for _ in 0..readings {
            solver.advance(steps).unwrap();
            let now = solver.snapshot().unwrap().state;
            let top = -now.walls[1].offset;
            filled += solid_fraction(&now.grains, &model.domain, 4.0, top - 4.0);
        }
        let after = solver.snapshot().unwrap().sums;
        let shear = -(after.driven_force - before.driven_force);
        found[0].push(shear / (after.wall_force[1] - before.wall_force[1]));
        found[1].push(filled / f64::from(readings));
    }
    for (k, what) in ["friction", "fraction"].iter().enumerate() {
        let n = found[k].len() as f64;
        let mean = found[k].iter().sum::<f64>() / n;
        let variance = found[k].iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let error = (variance / n).sqrt();
        let band = BANDS[k].hypot(3.0 * error);
        println!(
            "mu {mu} I {inertial} seed {seed}: {what} {mean:.4} ± {error:.4}, independent {} ± {band:.4}",
            expected[k]
        );
        assert!((mean - expected[k]).abs() <= band, "{what} {mean}");
    }
}
