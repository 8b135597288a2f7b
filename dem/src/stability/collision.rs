//! Collisions of the linear law: how long they last, how fast grains part, and what a finite
//! time step makes of it.
//!
//! Source: Schwager and Pöschel (2007), Granul. Matter 9, 465, for the clipped force.
//! Proof: tests/verification/restitution.rs

use std::f64::consts::PI;

/// Damping ratio ζ = γ / (2 √(m k)) [-].
fn damping_ratio(stiffness: f64, damping: f64, m: f64) -> f64 {
    damping / (2.0 * (m * stiffness).sqrt())
}

/// Duration [s] of a collision of two grains of effective mass `m` = m_i m_j / (m_i + m_j)
/// [kg] (a wall: m_i), from touching to zero overlap under the unclipped force:
/// π √(m/k) / √(1 - ζ²). Infinite from critical damping on, where the overlap never ends.
pub fn contact_time(stiffness: f64, damping: f64, m: f64) -> f64 {
    let zeta = damping_ratio(stiffness, damping, m);
    if zeta >= 1.0 {
        return f64::INFINITY;
    }
    PI * (m / stiffness).sqrt() / (1.0 - zeta * zeta).sqrt()
}

/// Number of time steps in one [`contact_time`].
pub fn steps_per_contact(stiffness: f64, damping: f64, m: f64, step: f64) -> f64 {
    contact_time(stiffness, damping, m) / step
}

/// Coefficient of restitution of the linear law for effective mass `m` [kg].
///
/// `clipped`: the force is cut at zero, e = exp(-2 ζ arccos ζ / √(1 - ζ²)), with arcosh and
/// √(ζ² - 1) beyond critical damping (Schwager and Pöschel 2007). Otherwise it may pull,
/// e = exp(-π ζ / √(1 - ζ²)), and zero from critical damping on.
pub fn restitution(stiffness: f64, damping: f64, m: f64, clipped: bool) -> f64 {
    restitution_of_ratio(damping_ratio(stiffness, damping, m), clipped)
}

fn restitution_of_ratio(zeta: f64, clipped: bool) -> f64 {
    let root = (1.0 - zeta * zeta).abs().sqrt();
    match clipped {
        false if zeta >= 1.0 => 0.0,
        false => (-PI * zeta / root).exp(),
        true if zeta < 1.0 => (-2.0 * zeta * zeta.acos() / root).exp(),
        true if zeta > 1.0 => (-2.0 * zeta * zeta.acosh() / root).exp(),
        true => (-2.0_f64).exp(),
    }
}

/// Damping γ_n [N s/m] that gives `restitution`, the inverse of [`restitution`].
///
/// # Panics
/// Unless 0 < `restitution` ≤ 1: no damping gives more, and none gives zero.
pub fn damping_for(restitution: f64, stiffness: f64, m: f64, clipped: bool) -> f64 {
    assert!(
        restitution > 0.0 && restitution <= 1.0,
        "a restitution is above 0 and at most 1, not {restitution}"
    );
    let zeta = if clipped {
        clipped_ratio(restitution)
    } else {
        let ln = restitution.ln();
        -ln / (PI * PI + ln * ln).sqrt()
    };
    zeta * 2.0 * (m * stiffness).sqrt()
}

/// Damping ratio whose clipped restitution is `target`, by bisection: it falls all the way.
fn clipped_ratio(target: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while restitution_of_ratio(high, true) > target {
        (low, high) = (high, 2.0 * high);
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if restitution_of_ratio(middle, true) > target {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Restitution as the time step leaves it, over the moments at which grains may meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Smallest [-].
    pub min: f64,
    /// Mean over all moments, each as likely [-].
    pub mean: f64,
    /// Largest [-].
    pub max: f64,
}

/// Restitution of single collisions stepped as the solver steps them, for grains that meet
/// at [`PHASES`] moments spread over a time step `step` [s].
///
/// The contact begins and ends on whole steps, so that few steps per contact scatter it.
/// A collision that has not ended after a hundred undamped ones counts as zero.
pub fn restitution_scatter(
    stiffness: f64,
    damping: f64,
    m: f64,
    clipped: bool,
    step: f64,
) -> Scatter {
    let each = (0..PHASES).map(|k| {
        let phase = (f64::from(k) + 0.5) / f64::from(PHASES);
        stepped_restitution(stiffness / m, damping / m, clipped, step, phase)
    });
    let start = Scatter {
        min: f64::INFINITY,
        mean: 0.0,
        max: f64::NEG_INFINITY,
    };
    each.fold(start, |s, e| Scatter {
        min: s.min.min(e),
        mean: s.mean + e / f64::from(PHASES),
        max: s.max.max(e),
    })
}

/// Moments within a step at which [`restitution_scatter`] lets grains meet.
pub const PHASES: u32 = 200;

/// One collision at unit speed that begins `phase` of a step before the first force;
/// `stiffness` and `damping` are per effective mass.
fn stepped_restitution(stiffness: f64, damping: f64, clipped: bool, step: f64, phase: f64) -> f64 {
    let longest = 100.0 * PI / stiffness.sqrt();
    let (mut overlap, mut approach) = (phase * step, 1.0);
    let mut time = 0.0;
    while overlap > 0.0 {
        let push = stiffness * overlap + damping * approach;
        approach -= step * if clipped { push.max(0.0) } else { push };
        overlap += step * approach;
        time += step;
        if time > longest {
            return 0.0;
        }
    }
    -approach
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Values of a direct integration with steps of 1e-5 √(m/k).
    #[test]
    fn restitution_agrees_with_direct_integration() {
        let table = [
            (0.05, 0.8588, 0.8545),
            (0.2, 0.5717, 0.5266),
            (0.5, 0.2984, 0.1630),
            (0.65, 0.2284, 0.0681),
        ];
        for (zeta, clipped, kept) in table {
            assert_relative_eq!(
                restitution(1.0, 2.0 * zeta, 1.0, true),
                clipped,
                epsilon = 5e-5
            );
            assert_relative_eq!(
                restitution(1.0, 2.0 * zeta, 1.0, false),
                kept,
                epsilon = 5e-5
            );
        }
    }

    #[test]
    fn clipped_restitution_is_smooth_through_critical_damping() {
        for zeta in [1.0 - 1e-6, 1.0, 1.0 + 1e-6] {
            assert_relative_eq!(
                restitution_of_ratio(zeta, true),
                (-2.0_f64).exp(),
                max_relative = 1e-5
            );
        }
        // 1/(4 ζ²) far beyond it
        assert_relative_eq!(
            restitution_of_ratio(1e3, true),
            0.25e-6,
            max_relative = 1e-5
        );
    }

    #[test]
    fn damping_for_is_the_inverse_of_restitution() {
        for e in [1.0, 0.9, 0.5, 0.1, 0.01] {
            for clipped in [true, false] {
                let damping = damping_for(e, 1e9, 7e-3, clipped);
                assert_relative_eq!(restitution(1e9, damping, 7e-3, clipped), e, epsilon = 1e-12);
            }
        }
    }

    /// LAMMPS' scatter at 13.2 steps per contact and at ten and a hundred times as many.
    #[test]
    fn few_steps_per_contact_scatter_the_restitution() {
        let m = 0.5 * 3600.0 * 4.0 / 3.0 * PI * 1e-6;
        assert_relative_eq!(
            steps_per_contact(1e9, 780.0, m, 6.6e-7),
            13.2,
            epsilon = 0.05
        );
        let coarse = restitution_scatter(1e9, 780.0, m, false, 6.6e-7);
        assert_relative_eq!(coarse.min, 0.629, epsilon = 1e-3);
        assert_relative_eq!(coarse.mean, 0.633, epsilon = 1e-3);
        assert_relative_eq!(coarse.max, 0.677, epsilon = 1e-3);
        let fine = restitution_scatter(1e9, 780.0, m, false, 6.6e-8);
        assert_relative_eq!(fine.min, 0.6358, epsilon = 1e-4);
        assert_relative_eq!(fine.max, 0.6402, epsilon = 1e-4);
        let exact = restitution(1e9, 780.0, m, false);
        let finest = restitution_scatter(1e9, 780.0, m, false, 6.6e-10);
        assert_relative_eq!(finest.mean, exact, epsilon = 1e-4);
    }

    #[test]
    fn an_overdamped_collision_that_may_pull_does_not_end() {
        assert_eq!(contact_time(1.0, 3.0, 1.0), f64::INFINITY);
        assert_eq!(restitution(1.0, 3.0, 1.0, false), 0.0);
        let scatter = restitution_scatter(1.0, 3.0, 1.0, false, 0.01);
        assert_eq!((scatter.min, scatter.max), (0.0, 0.0));
    }
}
