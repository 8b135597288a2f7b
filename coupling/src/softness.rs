//! Water that is softer than water.
//!
//! Softer water lets fluid steps be rarer, and does no harm while it is still hard against the
//! skeleton: of a load it takes B = 1/(1 + S M) at once, whatever S is, as long as S M is small.
//! What it takes less than real water would is missing from then on, in every pressure. In beds of
//! k_n = 1e7 N/m, S M = 0.04, ten times softer water takes a quarter less and a hundred times softer
//! three quarters; in those of 1e9, S M = 1.6, ten times softer takes 15 % of what it should
//! (`coupling/studies`). So a tenth less is warned of, and half is refused.

use crate::{Error, Model};
use lbm::Fluid;

/// Parts of real water's share of a load below which softer water is warned of, and refused.
const WARNED: f64 = 0.9;
const REFUSED: f64 = 0.5;

/// What softer water does to a bed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Softness {
    /// How many times softer than water near freezing.
    times: f64,
    /// Skempton's B with it and with real water.
    shares: [f64; 2],
    /// The times that would be warned of.
    fitting: f64,
}

impl Softness {
    /// Of the water in a bed of this porosity; none where it is at least as hard as water, or the
    /// stiffness of the skeleton is not known.
    pub fn of(model: &Model, porosity: f64) -> Option<Self> {
        let real = porosity * Fluid::COLD_WATER.compressibility * model.stiffness?;
        let times = model.fluid.compressibility / Fluid::COLD_WATER.compressibility;
        let share = |ratio: f64| 1.0 / (1.0 + ratio);
        (times > 1.0).then_some(Self {
            times,
            shares: [share(times * real), share(real)],
            fitting: ((1.0 + real) / WARNED - 1.0) / real,
        })
    }

    /// Refuse water that changes the answer in such a bed.
    pub fn judge(model: &Model, porosity: f64) -> Result<(), Error> {
        match Self::of(model, porosity) {
            Some(found) if found.shares[0] < REFUSED * found.shares[1] => {
                Err(Error::Invalid(format!(
                    "{}: half of it and more would be missing; soften at most {:.1} times, or, \
                     where only steady flow matters, leave the stiffness unknown",
                    found.describe(),
                    found.fitting
                )))
            }
            _ => Ok(()),
        }
    }

    /// A warning, if there is need.
    pub fn warning(&self) -> Option<String> {
        (self.shares[0] < WARNED * self.shares[1]).then(|| {
            let what = "every pressure is too low by that, and settles later";
            format!("{}: {what}", self.describe())
        })
    }

    fn describe(&self) -> String {
        let [with, without] = self.shares.map(|share| 100.0 * share);
        format!(
            "water {:.1} times softer than water takes {with:.1} % of a load at once instead of \
             {without:.1} %",
            self.times
        )
    }
}
