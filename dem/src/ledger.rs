//! Where the energy of a bed is: pure functions of description, grains and contacts.

use crate::{Contact, ContactLaw, Grains, Horizontal, Ledger, Model};
use glam::DVec3;

impl Ledger {
    /// Energies and work of gravity of this instant; the sums over time stay zero.
    pub(crate) fn of_instant(model: &Model, grains: &Grains, contacts: &[Contact]) -> Self {
        let mut ledger = Self {
            kinetic: grains.kinetic_energy(),
            rotational: grains.rotational_energy(),
            ..Self::default()
        };
        for contact in contacts {
            ledger.elastic_normal +=
                0.5 * model.law.normal_stiffness() * contact.overlap * contact.overlap;
            let [sliding, rolling] = spring_energies(&model.law, contact);
            ledger.elastic_tangential += sliding;
            ledger.elastic_rolling += rolling;
        }
        let work = |k: usize| {
            // The drive alone moves its grains along x, and answers for their weight.
            let way = match grains.constraint[k].horizontal {
                Horizontal::Driven => grains.displacement[k] * DVec3::Z,
                Horizontal::Free | Horizontal::Held => grains.displacement[k],
            };
            grains.mass[k] * model.gravity.dot(way)
        };
        ledger.work_gravity = (0..grains.len()).map(work).sum();
        ledger
    }
}

/// Energy in the tangential spring of a contact, and in its rolling and twisting springs [J].
fn spring_energies(law: &ContactLaw, contact: &Contact) -> [f64; 2] {
    let history = &contact.history;
    let sliding = 0.5 * law.tangential_stiffness() * history.spring.length_squared();
    let ContactLaw::Linear(linear) = law else {
        return [sliding, 0.0];
    };
    let stiffness = |turning: Option<crate::contact::Turning>| turning.map_or(0.0, |t| t.stiffness);
    let rolling = stiffness(linear.rolling) * history.rolling_spring.length_squared();
    let twisting = stiffness(linear.twisting) * history.twisting_spring * history.twisting_spring;
    [sliding, 0.5 * (rolling + twisting)]
}
