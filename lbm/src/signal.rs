//! Numbers that vary in time.

/// A number as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// Always the same.
    Steady(f64),
    /// mean + amplitude · sin(2π frequency t + phase)
    Sinusoidal {
        /// Mean.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Phase [rad].
        phase: f64,
    },
    /// Straight lines between points (time [s], value), and the end values beyond them.
    Table(Vec<[f64; 2]>),
}

impl Signal {
    /// The value at time `t` [s].
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Self::Steady(value) => *value,
            Self::Sinusoidal {
                mean,
                amplitude,
                frequency,
                phase,
            } => mean + amplitude * (std::f64::consts::TAU * frequency * t + phase).sin(),
            Self::Table(points) => {
                let next = points.partition_point(|point| point[0] <= t);
                if next == 0 {
                    return points[0][1];
                }
                let [t0, a] = points[next - 1];
                match points.get(next) {
                    None => a,
                    Some([t1, b]) => a + (b - a) * (t - t0) / (t1 - t0),
                }
            }
        }
    }

    /// The shortest time in which it varies [s]: a period, or the distance of two points.
    pub(crate) fn shortest_time(&self) -> f64 {
        match self {
            Self::Steady(_) => f64::INFINITY,
            Self::Sinusoidal { frequency, .. } => 1.0 / frequency.abs(),
            Self::Table(points) => points
                .windows(2)
                .map(|pair| pair[1][0] - pair[0][0])
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// What is wrong with it, if anything.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let fine = match self {
            Self::Steady(value) => value.is_finite(),
            Self::Sinusoidal {
                mean,
                amplitude,
                frequency,
                phase,
            } => [mean, amplitude, frequency, phase]
                .iter()
                .all(|x| x.is_finite()),
            Self::Table(points) if points.is_empty() => return Some("the table is empty"),
            Self::Table(points) => {
                if points.windows(2).any(|pair| pair[1][0] <= pair[0][0]) {
                    return Some("times of the table must increase");
                }
                points.as_flattened().iter().all(|x| x.is_finite())
            }
        };
        (!fine).then_some("its numbers must be finite")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_points_and_steady_beyond() {
        let table = Signal::Table(vec![[1.0, 10.0], [2.0, 20.0], [4.0, 0.0]]);
        let values = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0].map(|t| table.at(t));
        assert_eq!(values, [10.0, 10.0, 15.0, 20.0, 10.0, 0.0, 0.0]);
    }
}
