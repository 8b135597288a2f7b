//! What decides the bits of each phase of a scene, as numbers: phases with the same numbers, from
//! the start to here, are the same run.

use crate::protocol::Past;
use crate::scene::{Phase, Scene};
use dem::State;
use std::fmt::{self, Debug, Write};
use std::hash::{DefaultHasher, Hasher};

/// A number for each phase of a resolved scene, without what came before it: what is not named here
/// changes no bit of a run.
pub fn stages(scene: &Scene) -> Vec<u64> {
    let Scene {
        title: _,
        question: _,
        source: _,
        // It and the past are in the start.
        seed: _,
        domain,
        top,
        bottom,
        start: _,
        past: _,
        step,
        skin,
        water,
        phases,
        output,
        text: _,
    } = scene;
    let ledger = output.needs_ledger();
    let common = fingerprint(&(domain, top, bottom, step, skin, ledger));
    let stage = |phase: &Phase| {
        // Dry phases know nothing of the water.
        let water = phase.water.as_ref().and(water.as_ref());
        fingerprint(&(common, phase, water))
    };
    phases.iter().map(stage).collect()
}

/// The start of a scene: its grains, and what came before.
#[derive(Debug)]
pub struct Start {
    state: State,
    past: Past,
    number: u64,
}

impl Start {
    /// The number of the start of `scene`, which takes long to make for many grains; `last`: the
    /// start of the scene before, which most often is the same.
    pub fn number(scene: &Scene, last: &mut Option<Self>) -> u64 {
        let (state, past) = (&scene.start, &scene.past);
        match last {
            Some(known) if known.state == *state && known.past == *past => known.number,
            _ => {
                let number = fingerprint(&(state, past));
                let (state, past) = (state.clone(), past.clone());
                *last = Some(Self {
                    state,
                    past,
                    number,
                });
                number
            }
        }
    }
}

/// A number for all that is in `value`: its text holds every field, and floats to the last bit.
pub fn fingerprint(value: &impl Debug) -> u64 {
    struct Sink(DefaultHasher);
    impl Write for Sink {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.write(text.as_bytes());
            Ok(())
        }
    }
    let mut sink = Sink(DefaultHasher::new());
    write!(sink, "{value:?}").expect("the sink takes everything");
    sink.0.finish()
}
