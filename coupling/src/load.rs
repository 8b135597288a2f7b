//! How much of the skeleton a grain is: w = F/(F + f mean F), with F the load that it carries.
//!
//! F is the sum of the normal forces on a grain, averaged over about a millisecond; f = 1. The
//! weight is smooth: stiff packings have many grains that touch without carrying. A grain's
//! buoyant weight is added to F, so that in a suspension, where nobody carries, all count.
//!
//! The choice of f is a choice of the model. At k_n = 1e7 N/m it hardly matters from 0.5 on: pressure
//! in consolidation varies by 0.1 % up to 4, the strength of a bed that drains partly by 1 %. Where
//! water is as soft as the skeleton (k_n = 1e9 N/m) pressure leaks away past loosely held grains: of
//! six beds 4.3 % of it until T = 0.4 with 0.5, root of the mean square, 2.5 % with 1 and with 2, but
//! with 2 the mean of them is 0.9 % too high, with 1 0.5 % too low (`coupling/studies/loose.csv`).
//!
//! Grains that count little are dragged to the mean (`faces.rs`) by what Darcy's law says of a grain
//! alone. That is a device: it holds weakly held grains, which the water would else push out
//! of the way of its own pressure. Where the water is much stiffer than the skeleton, storage S times
//! stiffness M ≪ 1, none is pushed far, and without drag pressure in consolidation is the same to 0.3 %
//! (k_n = 1e7 N/m); but in shear drag costs strength, as φ²(μγ̇/k)d², which is nothing in nature, where a
//! bed is thousands of grains high, and a tenth of the strength in one of 13. So grains get (S M/0.2)² of
//! it, and all of it from S M = 0.2 on or where M is not known (`coupling/README.md`).

use crate::Model;

/// S M from which on loose grains get all of their drag.
const TOWED: f64 = 0.2;

impl Model {
    /// Part of their drag that loose grains get in a bed of this porosity.
    pub(crate) fn towed(&self, porosity: f64) -> f64 {
        let Some(stiffness) = self.stiffness else {
            return 1.0;
        };
        let softness = porosity * self.fluid.compressibility * stiffness;
        (softness / TOWED).powi(2).min(1.0)
    }
}

/// Loads of grains, averaged in time; by identity.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Loads {
    /// Mean load [N]; empty before the first reading.
    pub mean: Vec<f64>,
    /// Time of the last reading [s].
    pub read_at: f64,
}

impl Loads {
    /// Take in the loads `now` of the grains `id` at `time` [s], averaging over `memory` [s].
    pub fn read(&mut self, id: &[u32], now: &[f64], time: f64, memory: f64) {
        let first = self.mean.is_empty();
        self.mean.resize(id.len(), 0.0);
        let passed = time - self.read_at;
        let share = if first {
            1.0
        } else {
            passed / (passed + memory)
        };
        for (&id, load) in id.iter().zip(now) {
            let mean = &mut self.mean[id as usize];
            *mean += share * (load - *mean);
        }
        self.read_at = time;
    }

    /// Mean over all grains [N].
    pub fn over_all(&self) -> f64 {
        self.mean.iter().sum::<f64>() / self.mean.len().max(1) as f64
    }

    /// Share of the grains that carry less than a hundredth of the mean.
    pub fn rattlers(&self) -> f64 {
        let least = 0.01 * self.over_all();
        let loose = self.mean.iter().filter(|&&load| load <= least).count();
        loose as f64 / self.mean.len().max(1) as f64
    }

    /// Weight of grain `id` with buoyant weight `weight` [N]; `half` is the load that counts half
    /// [N]. Positive.
    pub fn weight(&self, id: u32, weight: f64, half: f64) -> f64 {
        let load = self.mean[id as usize] + weight;
        match load + half > 0.0 {
            true => (load / (load + half)).max(LEAST),
            false => 1.0,
        }
    }
}

/// The least weight: among grains that carry nothing each counts the same.
const LEAST: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_count_by_the_load_that_they_carry() {
        let mut loads = Loads::default();
        loads.read(&[1, 0, 2], &[4.0, 0.0, 2.0], 0.0, 1e-3);
        assert_eq!(loads.mean, [0.0, 4.0, 2.0]);
        assert_eq!(loads.over_all(), 2.0);
        assert_eq!(loads.weight(1, 0.0, 1.0), 0.8);
        assert_eq!(loads.weight(0, 0.0, 1.0), LEAST);
        assert_eq!(loads.rattlers(), 1.0 / 3.0);
        // Half of the way in a time as long as the memory.
        loads.read(&[1, 0, 2], &[0.0, 0.0, 2.0], 1e-3, 1e-3);
        assert_eq!(loads.mean, [0.0, 2.0, 2.0]);
        // Where nobody carries, all count.
        let none = Loads {
            mean: vec![0.0; 2],
            read_at: 0.0,
        };
        assert_eq!(none.weight(0, 0.0, 0.0), 1.0);
        assert_eq!(none.weight(1, 0.1, 0.0), 1.0);
    }
}
