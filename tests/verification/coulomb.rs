//! Every contact of a dense shear respects Coulomb's limit, with the coefficient of its state.

use dem::contact::Sliding;
use dem::{ContactLaw, State};
use glam::DVec3;
use tests::bed::Bed;
use tests::{solver, steps_to};

const MU_S: f64 = 0.6;
const MU_D: f64 = 0.4;

/// Counts of contacts: all, sliding, and sticking beyond the dynamic limit.
#[derive(Default)]
struct Seen {
    all: usize,
    sliding: usize,
    beyond_dynamic: usize,
}

fn check(state: &State, seen: &mut Seen) {
    for contact in &state.contacts {
        let normal: DVec3 = contact.branch.normalize();
        let push = contact.force.dot(normal).max(0.0);
        let tangential = (contact.force - contact.force.dot(normal) * normal).length();
        let sliding = contact.history.sliding;
        let limit = if sliding { MU_D } else { MU_S } * push;
        // The force is summed and split again: its own round-off is all there may be.
        let round_off = 1e-14 * contact.force.length() + 1e-18;
        assert!(
            tangential <= limit + round_off,
            "{:?} on {:?}: {tangential:e} N beyond {limit:e} N",
            contact.i,
            contact.j
        );
        seen.all += 1;
        seen.sliding += usize::from(sliding);
        seen.beyond_dynamic += usize::from(tangential > 1.01 * MU_D * push);
    }
}

#[test]
fn no_contact_of_a_dense_shear_carries_more_than_its_limit() {
    let (mut model, start) = Bed::new(300, 6.0, 0.5, 3).sheared(0.01);
    if let ContactLaw::Linear(law) = &mut model.law {
        law.sliding = law.sliding.map(|sliding| Sliding {
            friction_static: MU_S,
            friction_dynamic: MU_D,
            damping: 0.2 * law.normal_damping,
            ..sliding
        });
    }
    let mut solver = solver(&model, &start);
    let mut seen = Seen::default();
    for _ in 0..50 {
        solver.advance(steps_to(0.5, &model)).unwrap();
        check(&solver.snapshot().state, &mut seen);
    }
    // Neither state is empty, and sticking contacts use the room that only μ_s leaves them.
    assert!(seen.all > 10_000, "{} contacts", seen.all);
    assert!(
        seen.sliding > seen.all / 50,
        "{} of {} slide",
        seen.sliding,
        seen.all
    );
    assert!(
        seen.beyond_dynamic > seen.all / 100,
        "{} of {}",
        seen.beyond_dynamic,
        seen.all
    );
}
