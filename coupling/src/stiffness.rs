//! Stiffness of the skeleton, measured.

use crate::Error;
use dem::measure::{bed_height, top_wall};
use dem::{Model, Solver, State, WallMotion};

/// Stiffness M = Δσ H/Δh of a dry bed under its top wall's mean stress [Pa], from `increment`
/// more of it [Pa] that comes gradually in half of `time` [s] and is held for the other. Creep of
/// the bed is taken off: the heights compared are those of two runs of one length. A load that
/// comes at once sends waves through the bed that overshoot, and what slides then stays: 6 % less
/// M at k_n = 1e9 N/m, however much the wall is damped. So half of `time` should be many passages
/// of sound. The wall is damped too: on its own it stops in a fortieth of the time.
///
/// # Errors
/// [`Error`] for a bed without a top wall under stress, or whose numbers run away.
pub fn skeleton_stiffness(
    model: &Model,
    state: &State,
    increment: f64,
    time: f64,
) -> Result<f64, Error> {
    let Some(top) = top_wall(model) else {
        return Err(Error::Invalid("the bed has no top wall".into()));
    };
    let WallMotion::Stress(load) = model.walls[top].motion else {
        return Err(Error::Invalid("no stress pushes the top wall".into()));
    };
    let height = bed_height(model, state);
    // A sine's quarter in half of the time, then at rest.
    let half = (0.5 * time / model.step).round().max(1.0) as u64;
    let quarter = half as f64 * model.step;
    let held = |stress: f64, damping: f64| -> Result<f64, Error> {
        let mut state = state.clone();
        state.time = 0.0;
        for (mean, amplitude) in [(load.mean, stress), (load.mean + stress, 0.0)] {
            let mut model = model.clone();
            model.walls[top].motion = WallMotion::Stress(dem::StressLoad {
                mean,
                amplitude,
                frequency: 0.25 / quarter,
                damping,
                ..load
            });
            let mut solver = Solver::new(model, state, 1)?;
            solver.advance(half)?;
            state = solver.snapshot().state;
        }
        Ok(bed_height(model, &state))
    };
    let damping = load.damping.max(40.0 * load.mass / time);
    let settled = held(0.0, damping)? - held(increment, damping)?;
    Ok(increment * height / settled)
}
