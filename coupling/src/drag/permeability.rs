//! Permeability of a bed from its porosity.

/// A law of permeability k(φ), and its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Permeability {
    /// k = prefactor · φ³/(1 - φ)² [m²], or a constant.
    law: Law,
    /// Least and greatest permeability [m²]; what the scene states, else none.
    bounds: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    Constant(f64),
    Porosity(f64),
}

impl Permeability {
    /// The same everywhere [m²].
    pub fn constant(permeability: f64) -> Self {
        Self::of(Law::Constant(permeability))
    }

    /// k = k_c φ³/(1 - φ)², with a free prefactor k_c [m²]: fine sediment between the grains.
    /// Source: Damsgaard et al. (2015), The Cryosphere 9, 2183.
    pub fn prefactor(prefactor: f64) -> Self {
        Self::of(Law::Porosity(prefactor))
    }

    /// Kozeny and Carman for grains of this diameter [m]: k_c = d²/180.
    /// Source: Carman (1937), Trans. Inst. Chem. Eng. 15, 150.
    pub fn kozeny_carman(diameter: f64) -> Self {
        Self::prefactor(diameter * diameter / 180.0)
    }

    /// The same, never less or more than these [m²].
    pub fn within(self, bounds: [f64; 2]) -> Self {
        Self { bounds, ..self }
    }

    fn of(law: Law) -> Self {
        Self {
            law,
            bounds: [0.0, f64::INFINITY],
        }
    }

    /// k [m²] at a porosity.
    pub fn at(&self, porosity: f64) -> f64 {
        let k = match self.law {
            Law::Constant(k) => k,
            Law::Porosity(k_c) => k_c * porosity.powi(3) / (1.0 - porosity).powi(2),
        };
        k.clamp(self.bounds[0], self.bounds[1])
    }

    /// Its number, the law it belongs to, and its bounds: for kernels.
    pub(super) fn law(&self) -> super::Law {
        match self.law {
            Law::Constant(k) => super::Law::Constant([k, self.bounds[0], self.bounds[1]]),
            Law::Porosity(k_c) => super::Law::Porosity([k_c, self.bounds[0], self.bounds[1]]),
        }
    }

    /// What is wrong with its numbers, if anything.
    pub(crate) fn fault(&self) -> Option<String> {
        let (Law::Constant(k) | Law::Porosity(k)) = self.law;
        if !(k > 0.0 && k.is_finite()) {
            return Some(format!("permeability {k} m² must be positive"));
        }
        let [low, high] = self.bounds;
        (!(low >= 0.0 && low <= high))
            .then(|| format!("bounds {low} to {high} m² of the permeability: the lower one first"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permeability_follows_porosity_within_its_bounds() {
        let law = Permeability::kozeny_carman(0.02);
        // Grains of 2 cm at a porosity of 0.4: 4.0e-7 m².
        assert!((law.at(0.4) / 3.951e-7 - 1.0).abs() < 1e-3);
        let law = law.within([1e-8, 1e-7]);
        assert_eq!((law.at(0.4), law.at(0.05)), (1e-7, 1e-8));
        assert_eq!(Permeability::constant(3e-12).at(0.9), 3e-12);
        assert!(Permeability::constant(0.0).fault().is_some());
        assert!(law.within([2.0, 1.0]).fault().is_some());
    }
}
