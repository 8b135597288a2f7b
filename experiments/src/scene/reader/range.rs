//! Which numbers are possible.

/// Which numbers are possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Every finite number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// Above the first, at most the second.
    Above(f64, f64),
    /// From the first to the second, in SI units: beyond them there is no such thing.
    Within(f64, f64),
}

impl Range {
    pub(super) fn broken_by(self, x: f64) -> Option<String> {
        if !x.is_finite() {
            return Some("must be a finite number".into());
        }
        let fine = match self {
            Self::Any => true,
            Self::Positive => x > 0.0,
            Self::NotNegative => x >= 0.0,
            Self::Above(low, high) => x > low && x <= high,
            Self::Within(low, high) => (low..=high).contains(&x),
        };
        (!fine).then(|| match self {
            Self::Any => unreachable!("every finite number is fine"),
            Self::Positive => "must be above zero".into(),
            Self::NotNegative => "must not be negative".into(),
            Self::Above(low, high) => format!("must be above {low} and at most {high}"),
            Self::Within(low, high) => format!("must be from {low:e} to {high:e}"),
        })
    }
}
