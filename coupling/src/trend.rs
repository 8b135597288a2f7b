//! Pressure ahead of time: a force that is held from one exchange to the next should be that of the
//! middle of the kicks which it makes.
//!
//! Kicks with the pressure of an exchange at step j are those of the steps j + 1 to j + m: their
//! middle is τ = (m - 1)/2 steps after the positions of j. A pressure that is held without looking
//! ahead lags behind the volume and feeds waves: with a wave that turns by h = ω m dt between two
//! exchanges the amplitude grows by about h²/8 in each; extrapolated with the last slope by h⁴/80;
//! with the change of slope too it falls, by h⁴/16 where h is small, and does so up to h = 1.1
//! (m = 8; 1.7 at m = 2). For one step, m = 1, nothing is added, and the force is that of leapfrog.

/// How pressure went in a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Trend {
    /// At the last exchange [Pa].
    pub before: f64,
    /// From the one before until then [Pa/s].
    slope: f64,
    /// What is added since the last exchange [Pa].
    pub rise: f64,
}

/// Times that all cells have in common [s].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    /// Since the last exchange, and from the one before until that; zero where there was none.
    pub passed: [f64; 2],
    /// From now to the middle of the kicks to come.
    pub ahead: f64,
}

impl Trend {
    /// The pressure to hold from now on, where it is `now`.
    pub fn ahead(&mut self, now: f64, times: &Times) -> f64 {
        let [passed, before] = times.passed;
        let slope = (now - self.before) / passed;
        let bend = match before > 0.0 {
            true => 2.0 * (slope - self.slope) / (passed + before),
            false => 0.0,
        };
        let ahead = times.ahead;
        self.rise = ahead * (slope + 0.5 * bend * (passed + ahead));
        self.before = now;
        self.slope = slope;
        now + self.rise
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pressure_that_bends_steadily_is_met_whatever_the_times() {
        let pressure = |t: f64| 3.0 + 2.0 * t - 0.7 * t * t;
        let mut trend = Trend {
            before: pressure(0.0),
            ..Trend::default()
        };
        let (mut time, mut before) = (0.0, 0.0);
        for (k, passed) in [1.0, 3.0, 0.5, 4.0].into_iter().enumerate() {
            time += passed;
            let ahead = 0.25 * (k + 1) as f64;
            let times = Times {
                passed: [passed, before],
                ahead,
            };
            let found = trend.ahead(pressure(time), &times);
            before = passed;
            // Of the first interval only the slope is known.
            if k > 0 {
                let exact = pressure(time + ahead);
                assert!((found - exact).abs() < 1e-12, "{found} is not {exact}");
            }
        }
    }

    /// A mass on a spring whose force is held for m steps.
    fn grows(every: u32, turn: f64) -> f64 {
        let stiffness = (turn / every as f64).powi(2);
        let (mut place, mut velocity) = (1.0, 0.0);
        let mut trend = Trend {
            before: -stiffness * place,
            ..Trend::default()
        };
        let mut most = [0.0f64; 2];
        let turns = 4000;
        for k in 0..turns {
            let times = Times {
                passed: [every as f64, if k == 1 { 0.0 } else { every as f64 }],
                ahead: 0.5 * (every - 1) as f64,
            };
            let force = match k {
                0 => trend.before,
                _ => trend.ahead(-stiffness * place, &times),
            };
            for _ in 0..every {
                velocity += force;
                place += velocity;
            }
            if !place.is_finite() {
                return f64::INFINITY;
            }
            let half = usize::from(k >= turns / 2);
            most[half] = most[half].max(place.abs());
        }
        most[1] / most[0]
    }

    #[test]
    fn held_forces_calm_waves_and_do_not_feed_them() {
        for every in [2, 4, 8] {
            assert!(grows(every, 0.1) > 0.8, "slow waves hardly change");
            for turn in [0.3, 0.6, 1.0] {
                let grown = grows(every, turn);
                assert!(grown < 0.5, "{every} steps, {turn}: {grown}");
            }
            assert!(grows(every, 2.0) > 1.0, "the bound is there");
        }
    }
}
